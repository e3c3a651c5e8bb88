// Makes both sides of every seam show the same light, by the least change of the texels that lookups on seams read.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart_set.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "post/lightmap.h"
#include "seam/lookup_filter.h"
#include "seam/seam_samples.h"

namespace lumel {

struct SeamOptions {
    LookupFilter filter = LookupFilter::bilinear;  // with which the runtime looks up
    float samples_per_texel = 2.0f;                // of the denser side of a seam
    float hold = 0.003f;            // weight that keeps a baked texel as it is, against 1 of a texel of seam
    float hold_ring = 0.0003f;      // of texels that were not baked: filled, dilated
    std::uint32_t rounds = 3;       // of solving, at most: more than one where texels are at the limit of valid light
    std::uint32_t iterations = 60;  // of conjugate gradients in a round, at most
    float tolerance = 1e-3f;        // of the gradient, relative to the first, at which they stop
};

// Pages come one at a time, in order, and leave: what they show along seams to later pages is remembered, and those
// pages adapt to it. Within a page, both sides move.
class SeamBlender {
public:
    SeamBlender(std::vector<SeamSample> samples, const Atlas& atlas, const SeamOptions& options);

    // Minimises, for each coefficient of each layer of the page, sum over samples of w (b.x - b'.x)^2 + sum over texels
    // of m (x - x0)^2, where b and b' are the filter's shares on both sides. Texels that no such lookup reads stay as
    // they are. All coefficients go through the same equations, so that layers add up as they did, but for the
    // tolerance; where a change would leave a channel of a layer without valid light (I < 0, or |R1| > R0), it is
    // halved until it does not. Any number of threads gives the same bits. Stage "seams". Error: cancelled.
    Status blend(Lightmap& map, Context& context);

private:
    struct Equations;
    [[nodiscard]] Equations equations_of(const Lightmap& map) const;
    bool solve(const Equations& equations, std::span<double> first_sizes, Lightmap& map, Context& context) const;
    void remember(const Lightmap& map);

    std::vector<SeamSample> samples_;        // by the later of their pages
    std::vector<std::size_t> first_sample_;  // of each page, plus one past the end
    std::vector<AtlasPage> pages_;
    SeamOptions options_;
    std::vector<std::uint32_t> crossing_;  // samples between two pages
    std::vector<float> remembered_;        // of each of these, all coefficients of the earlier page's lookup
};

}  // namespace lumel
