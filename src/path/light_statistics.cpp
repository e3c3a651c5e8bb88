#include "path/light_statistics.h"

#include <algorithm>
#include <cmath>

#include "math/discrete.h"

namespace lumel {
namespace {

constexpr double kPriorShare = 0.1;  // of the samples, whatever was learned
// Of the tree's bound for the whole texel, which is less sharp than what it says of the texel's middle, but zero only
// where a light reaches no point of it.
constexpr double kRimShare = 0.2;
constexpr double kPriorSamples = 4.0;  // that the tree's word counts for, of each group

}  // namespace

void LightStatistics::begin(const LightSet& lights, std::span<const ReceiverRegion> texels) {
    const auto groups = lights.groups();
    groups_.assign(groups.size(), {});
    expected_.assign(groups.size() * texels.size(), 0.0f);
    tables_.resize(groups.empty() ? 0 : texels.size());
    sum_ = 0.0;
    samples_ = 0;
    for (std::size_t g = 0; g < groups.size(); ++g) groups_[g].guaranteed = groups[g].guaranteed;
    std::vector<double> importance(groups.size());
    for (std::size_t r = 0; r < tables_.size(); ++r) {
        double total = 0.0;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            importance[g] = lights.importance_of(g, {texels[r].centre, texels[r].axis}) +
                            kRimShare * lights.importance_of(g, texels[r]);
            total += importance[g];
        }
        if (!(total > 0.0) || !std::isfinite(total)) continue;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const double share = importance[g] / total;
            expected_[r * groups.size() + g] = static_cast<float>(share);
            groups_[g].mean_square += share * share / static_cast<double>(texels.size());
        }
    }
    learn();
}

void LightStatistics::add(std::size_t texel, std::uint32_t group, float value) {
    Group& g = groups_[group];
    const double brought = static_cast<double>(value) * probability(tables_[texel].units(group));
    const double by_tree = expected(texel)[group];
    g.squares += brought * brought;
    g.expected += by_tree * by_tree;
    sum_ += static_cast<double>(value);
    ++samples_;
}

void LightStatistics::learn() {
    if (tables_.empty()) return;
    // What all lights together bring: the unit of what the tree expects.
    const double mean = samples_ > 0 ? sum_ / static_cast<double>(samples_) : 1.0;
    std::vector<double> factors(groups_.size(), 1.0);
    for (std::size_t g = 0; g < groups_.size() && mean > 0.0; ++g) {
        const Group& group = groups_[g];
        const double prior = kPriorSamples * group.mean_square;
        if (prior > 0.0) factors[g] = std::sqrt((group.squares + mean * mean * prior) / (group.expected + prior));
    }
    for (std::size_t r = 0; r < tables_.size(); ++r) make_table(r, factors);
}

void LightStatistics::make_table(std::size_t texel, std::span<const double> factors) {
    const float* const by_tree = expected(texel);
    std::vector<std::uint32_t>& ends = tables_[texel].ends;
    ends.clear();
    double all = 0.0, total = 0.0;
    std::uint32_t guaranteed = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        all += static_cast<double>(by_tree[g]);
        total += static_cast<double>(by_tree[g]) * factors[g];
        guaranteed += groups_[g].guaranteed;
    }
    if (!(all > 0.0)) return;
    const double free_units = static_cast<double>(kUnits - guaranteed);
    double share = 0.0;
    std::uint32_t given = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        const double prior = static_cast<double>(by_tree[g]) / all;
        const double learned = total > 0.0 ? static_cast<double>(by_tree[g]) * factors[g] / total : prior;
        share += kPriorShare * prior + (1.0 - kPriorShare) * learned;
        given += groups_[g].guaranteed;
        ends.push_back(static_cast<std::uint32_t>(std::min(1.0, share) * free_units) + given);
    }
    ends.back() = kUnits;
}

}  // namespace lumel
