#include "lumel/context.h"

#include <algorithm>
#include <thread>

#include "base/parallel.h"

namespace lumel {

void Diagnostics::add(std::string_view code, std::string_view message, std::string_view where, std::uint64_t count) {
    auto item = std::find_if(items_.begin(), items_.end(), [&](const Diagnostic& d) { return d.code == code; });
    if (item == items_.end())
        item = items_.insert(items_.end(), Diagnostic{std::string(code), std::string(message), 0, {}});
    item->count += count;
    if (!where.empty() && item->examples.size() < kMaxExamples) item->examples.emplace_back(where);
}

std::uint64_t Diagnostics::count(std::string_view code) const {
    for (const Diagnostic& item : items_)
        if (item.code == code) return item.count;
    return 0;
}

Context::Context(unsigned threads)
    : pool_(std::make_unique<ThreadPool>(threads ? threads : std::max(1u, std::thread::hardware_concurrency()))) {}

Context::~Context() = default;

unsigned Context::threads() const { return pool_->size(); }

void Context::report(std::string_view stage, double fraction, std::uint64_t rays) const {
    if (on_progress) on_progress({stage, fraction, rays});
}

}  // namespace lumel
