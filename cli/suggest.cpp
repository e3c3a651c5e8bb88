#include "suggest.h"

#include <algorithm>
#include <utility>

namespace lumel::cli {
namespace {

// Dynamic programming over the prefixes of both, three rows at a time.
std::size_t slips(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
        before_last = std::exchange(last, row);
    }
    return last[b.size()];
}

}  // namespace

std::string closest_word(const std::string& word, const std::vector<std::string>& known) {
    const auto letters =
        static_cast<std::size_t>(std::count_if(word.begin(), word.end(), [](char letter) { return letter != '-'; }));
    std::size_t fewest = letters / 3 + 1;
    std::string closest;
    for (const std::string& candidate : known)
        if (const std::size_t n = slips(word, candidate); n < fewest) {
            fewest = n;
            closest = candidate;
        }
    if (!closest.empty() || letters == 0) return closest;
    const auto longer = std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.starts_with(word); });
    return longer != known.end() ? *longer : std::string{};
}

}  // namespace lumel::cli
