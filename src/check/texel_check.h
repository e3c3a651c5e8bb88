// What is wrong with single texels of a bake, and with where surfaces lie on its pages.
#pragma once

#include <cstdint>
#include <vector>

#include "check/checked_bake.h"
#include "lumel/context.h"
#include "lumel/result.h"

namespace lumel {

struct TexelCheckOptions {
    double noisy = 0.1;    // standard error over the light from which a texel counts as unconverged
    double outlier = 5.0;  // times denser or coarser than the median density, from which a surface counts as outlier
};

// A texel, or where a triangle lies.
struct TexelDefect {
    std::uint32_t page = 0, x = 0, y = 0;
};

// How many, and where some of them are: at most 100.
struct Defects {
    static constexpr std::size_t kMostPlaces = 100;
    std::uint64_t count = 0;
    std::vector<TexelDefect> places;

    void add(TexelDefect place) {
        if (count++ < kMostPlaces) places.push_back(place);
    }
};

struct TexelCheck {
    std::uint64_t baked = 0, filled = 0;  // texels; filled ones had no valid sample
    Defects not_finite;                   // texels that hold light, but no number
    Defects black;      // texels far darker than every neighbour: none holds a hundredth of the least of at least five
    Defects uncovered;  // triangles with lookups that read an empty texel
    Defects overlaps;   // pairs of triangles on one place of a page
    Defects unconverged;          // baked texels whose error is above the option's
    double outlier_share = 0.0;   // of the surface's area, too dense or too coarse
    double median_density = 0.0;  // texels per metre, over the area
    Defects outliers;             // triangles
};

// Density is judged only where it shows: of surfaces that have, or at the median density would have, 16 texels.
// Stage "texels". Error: cancelled.
Result<TexelCheck> check_texels(const CheckedBake& bake, const TexelCheckOptions& options, Context& context);

}  // namespace lumel
