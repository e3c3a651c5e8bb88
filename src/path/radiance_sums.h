// The master: what the path tracer leaves of each texel. Every encoding is solved from it without tracing again.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lumel/vec.h"

namespace lumel {

inline constexpr std::size_t kShCoefficients = 9;  // L2

// Basis S of docs/conventions.md, world frame. One normaliser for both members.
struct LayerMoments {
    std::array<Vec3, kShCoefficients> sh{};  // integral of L(w) Y_i(w) over the sampled hemisphere
    Vec3 irradiance{};                       // I = E/pi about the vertex normal, sampled on its own (not from sh)
};

// Light at its first hit on the texel, split by where it came from; `indirect` is all after a bounce.
enum class Layer : std::uint8_t { direct, sky, indirect };
inline constexpr std::size_t kLayerCount = 3;
inline constexpr std::array<const char*, kLayerCount> kLayerNames{"direct", "sky", "indirect"};

// Per texel, SoA; index = texel of the TexelBuffer. All are means over `count` samples.
struct RadianceSums {
    std::vector<std::array<LayerMoments, kLayerCount>> layers;
    // Of the mean of the total irradiance per channel. As traced: as if samples were independent, an upper estimate;
    // pool_variance() makes it one that holds.
    std::vector<Vec3> variance;
    std::vector<Vec3> half_difference;  // of the means of even and odd samples, which are spread evenly each for itself
    std::vector<float> sky_visibility;  // cosine-weighted share of directions that reach the sky, 0..1
    std::vector<float> ambient_occlusion;  // cosine-weighted share free within --ao-distance, 0..1 (1 = open)
    std::vector<Vec3> bent_normal;     // mean free direction, cosine-weighted, not normalised: |.| <= 1 but for noise
    std::vector<std::uint32_t> count;  // samples: all are in the means
    // Those whose first ray met no back of a single-sided surface; guided, as estimated.
    std::vector<std::uint32_t> open;
    void resize(std::size_t texels);
    void reserve(std::size_t texels);
    void clear(std::size_t texel);
    [[nodiscard]] std::size_t size() const { return count.size(); }
    // A texel is invalid when more than half of its first rays met backs of single-sided surfaces, or none was traced.
    [[nodiscard]] bool valid(std::size_t texel) const { return count[texel] > 0 && 2 * open[texel] >= count[texel]; }
};

}  // namespace lumel
