// Directions of a sky map with density proportional to its radiance: a row, a pixel in it, a point in the pixel.
// Based on: Pharr, Jakob, Humphreys, "Physically Based Rendering" 4th ed., 12.5 and A.5. Differs: rows and pixels are
// weighted by the exact integral of the bilinear lookup, so the density is positive wherever the lookup is; within a
// pixel the choice is uniform in solid angle, not in v.
#pragma once

#include <cstdint>
#include <vector>

#include "lumel/scene.h"

namespace lumel {

class SkySampler {
public:
    SkySampler() = default;
    explicit SkySampler(const SkyMap& map);

    struct Sample {
        Vec3 direction;
        float pdf;  // per solid angle
    };
    [[nodiscard]] Sample sample(Vec2 u) const;
    [[nodiscard]] float pdf(Vec2 uv) const;

private:
    [[nodiscard]] float pdf_of_pixel(std::size_t row, std::uint32_t row_units, std::uint32_t pixel_units) const;

    std::uint32_t width_ = 0, height_ = 0;
    std::vector<double> edge_sines_;         // height + 1: direction.y of the rows' edges, from the top
    std::vector<std::uint32_t> row_ends_;    // math/discrete.h
    std::vector<std::uint32_t> pixel_ends_;  // width per row
};

}  // namespace lumel
