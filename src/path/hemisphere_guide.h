// Where the light of a few neighbouring texels comes from: a density over the hemisphere of their normals, learned from
// their first paths, that later paths draw their first rays from. A room lit through a window needs it; where light
// comes from everywhere it would only do harm, and is not used.
//
// Based on: Müller et al. 2017, "Practical Path Guiding" (learning from earlier passes; some paths stay
// unguided); Rath et al. 2020, "Variance-Aware Path Guiding" (the root of the second moment, not the mean). Different
// here: bins of the primary sample space of GatherHemisphere, one table per block of texels, used only where one half
// of the samples predicts a gain for the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "lumel/vec.h"

namespace lumel {

// A piecewise constant density over the unit square, relative to uniform: 1 where no guiding happens.
class HemisphereGuide {
public:
    static constexpr std::size_t kRows = 16, kColumns = 32;  // by cosine (GatherHemisphere) and by azimuth
    static constexpr std::size_t kBins = kRows * kColumns;
    // The least density: an eighth of the paths are as they would be without a guide. What is learned may be wrong, and
    // occlusion and sky visibility are measured by the same rays.
    static constexpr float kFloor = 0.125f;

    // `wanted`: at least zero, of any sum above zero.
    explicit HemisphereGuide(const std::array<float, kBins>& wanted);

    struct Draw {
        Vec2 point;     // of the unit square
        float density;  // there; at least kFloor
    };
    // Warps a point of the unit square. Points that are spread evenly stay so, bin by bin.
    [[nodiscard]] Draw draw(Vec2 u) const;
    [[nodiscard]] float density(Vec2 point) const { return density_[bin_of(point)]; }

    static std::size_t bin_of(Vec2 point) {
        const auto row = static_cast<std::size_t>(point.x * static_cast<float>(kRows));
        const auto column = static_cast<std::size_t>(point.y * static_cast<float>(kColumns));
        return (row < kRows ? row : kRows - 1) * kColumns + (column < kColumns ? column : kColumns - 1);
    }

private:
    std::array<float, kBins> density_;
    std::array<float, kRows + 1> row_start_;             // cumulative share of the rows
    std::array<float, kRows*(kColumns + 1)> bin_start_;  // cumulative share of the bins in each row
};

// What paths told of the light along their first rays.
class GuideStatistics {
public:
    // A path of one of two halves whose first ray was drawn at `point` with `density` (of the guide; 1 without one) and
    // brought `radiance` (the share of it that multiple importance sampling leaves to the ray; luminance).
    void add(std::size_t half, Vec2 point, float density, float radiance) {
        const float moment = radiance * radiance / density;
        moments_[half][HemisphereGuide::bin_of(point)] += moment;
        ++counts_[half];
    }

    // None where the samples are too few, or predict too little gain.
    [[nodiscard]] std::optional<HemisphereGuide> learn() const;

    void clear() { *this = {}; }

private:
    using Bins = std::array<float, HemisphereGuide::kBins>;

    std::array<Bins, 2> moments_{};  // sums of radiance^2 / density: of the second moment, were paths not guided
    std::array<std::uint32_t, 2> counts_{};
};

}  // namespace lumel
