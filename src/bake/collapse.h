// After a bake: charts whose light hardly varies become as small as can be, and all are packed anew. The others keep
// their texels to the bit; they move by whole texels.
// Based on: O'Donnell, "Precomputed Global Illumination in Frostbite" (2018), which credits Mitton: charts of one
// colour need no more than the smallest size.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart_set.h"
#include "encode/irradiance.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "post/lightmap.h"

namespace lumel {

struct CollapseRule {
    double share = 0.01;  // of a chart's mean (and a hundredth of that of all pages): how far its light may spread, RMS
    LayerWeights layers{1, 1, 1};
    bool has_noise = true;  // Lightmap's variance is that of what the texels hold: not where they were smoothed
};

// Of each placement: does its light spread by no more than the rule's share? Looked at are irradiance, per channel; the
// same on the surface as scene.glb shows it; and together the coefficients of the radiance beyond the constant one,
// against that. What the stored variance explains
// does not count, but its own uncertainty does (two deviations): a chart of few and noisy texels is not called even. No
// texel may be off by more than four times the share and four deviations. Charts of the smallest size stay.
std::vector<bool> even_charts(std::span<const Lightmap> pages, const Atlas& atlas, const CollapseRule& rule);

// The boxes of all placements, 2 x 2 texels for those that collapse: ChartOptions::sizes.
std::vector<std::array<std::uint32_t, 2>> collapsed_sizes(const Atlas& atlas, const std::vector<bool>& collapse);

// Brings what was baked into another layout, in which charts have their box or collapsed.
class LayoutChange {
public:
    // Borrows all for its lifetime. `from`: the pages of `then`, in order.
    LayoutChange(const Scene& scene, const ChartSet& charts, const Atlas& then, std::span<const Lightmap> from,
                 const Atlas& now, const std::vector<bool>& collapsed);

    // A page of `now`. Texels of charts that stay hold what they held, dilated ones that their lookups read among them;
    // all texels of a collapsed chart its mean. `rings` rings are dilated around. Error: cancelled.
    [[nodiscard]] Result<Lightmap> page(std::uint32_t page, std::uint32_t rings, Context& context) const;

private:
    const Scene& scene_;
    const ChartSet& charts_;
    const Atlas& then_;
    std::span<const Lightmap> from_;
    const Atlas& now_;
    const std::vector<bool>& collapsed_;
    std::vector<std::vector<std::uint32_t>> texels_of_;  // per placement: its texels on its page of `then`
};

}  // namespace lumel
