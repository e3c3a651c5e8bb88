#include "pack/kinds.h"

#include <unordered_map>

#include "base/hash.h"

namespace lumel {
namespace {

struct TexelHash {
    std::size_t operator()(const ChartMask* mask) const {
        std::uint64_t hash = std::uint64_t{mask->width} << 32 | mask->height;
        for (const std::uint64_t word : mask->bits) hash = mix64(hash ^ word);
        return static_cast<std::size_t>(hash);
    }
};

struct TexelsEqual {
    bool operator()(const ChartMask* a, const ChartMask* b) const { return a == b || same_texels(*a, *b); }
};

}  // namespace

Kinds group_equal(std::span<const ChartMask> masks, std::span<const std::uint32_t> mask_of) {
    Kinds out;
    std::unordered_map<const ChartMask*, std::uint32_t, TexelHash, TexelsEqual> known;
    std::vector<std::uint32_t> kind_of;
    kind_of.reserve(mask_of.size());
    for (const std::uint32_t m : mask_of) {
        const auto [it, is_new] = known.emplace(&masks[m], static_cast<std::uint32_t>(out.kinds.size()));
        if (is_new) out.kinds.push_back({&masks[m], 0, 0});
        ++out.kinds[it->second].count;
        kind_of.push_back(it->second);
    }
    std::uint32_t first = 0;
    for (Kind& kind : out.kinds) {
        kind.first = first;
        first += kind.count;
    }
    out.charts.resize(mask_of.size());
    std::vector<std::uint32_t> next(out.kinds.size(), 0);
    for (std::uint32_t i = 0; i < mask_of.size(); ++i) {
        const std::uint32_t kind = kind_of[i];
        out.charts[out.kinds[kind].first + next[kind]++] = i;
    }
    return out;
}

}  // namespace lumel
