// AHD and HHD with an exact irradiance at n_v: I(n)/I_z = w a(n) + (1 - w) max(n.d, 0)/d_z, where a is 1 (AHD: ambient
// light from all around) or (1 + n_z)/2 (HHD: from the hemisphere). The weight in closed form, the direction by search.
// Based on: Roughton 2024, "Hemispherical Lighting Insights" (IrradZ storage, the hemispherical Gram matrix in the
// inner products, golden-section search over the polar angle). Different here: the best azimuth for each polar angle is
// found, too, in the same search: the error falls with <i, lobe>, which is a sum of two harmonics of the azimuth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sh/hemisphere.h"

namespace lumel {

enum class AmbientLobe : std::uint8_t { uniform, hemisphere };  // AHD, HHD

// Encoder and decoder divide by d_z: directions are not lower than this.
inline constexpr float kLowestLobe = 0.05f;

struct LobeFit {
    Vec3 direction{0, 0, 1};
    float ambient_weight = 1.0f;
    float error = 0.0f;  // integral of the squared error over the normals, in units of I_z^2
};

// Ambient light and a lobe in a given direction, to be weighted for any number of targets.
class LobePair {
public:
    LobePair(Vec3 direction, AmbientLobe ambient, const ZonalMatrix& gram);
    // Least squares, limited to [0, 1].
    [[nodiscard]] float ambient_weight(const std::array<float, 9>& target) const;
    [[nodiscard]] const std::array<float, 9>& lobe() const { return lobe_; }
    [[nodiscard]] const std::array<float, 9>& ambient() const { return ambient_; }

private:
    std::array<float, 9> ambient_, lobe_, product_;  // product_ = Gram matrix x (ambient_ - lobe_)
    float lobe_product_ = 0.0f, inverse_ = 0.0f;
};

// `target`: I/I_z as irradiance coefficients of the tangent frame. The weight lies in [0, 1].
LobeFit fit_ambient_weight(const std::array<float, 9>& target, Vec3 direction, AmbientLobe ambient,
                           const ZonalMatrix& gram);

// Several targets at once, which is what makes it fast. `start`: the optimal linear direction of each, whose azimuth
// the search starts from.
void search_lobes(std::span<const std::array<float, 9>> targets, std::span<const Vec3> start, AmbientLobe ambient,
                  const ZonalMatrix& gram, std::span<LobeFit> out);

// Into the upper hemisphere, at least kLowestLobe high, unit length.
Vec3 lifted(Vec3 direction);

// Directions of the upper hemisphere as two numbers in [0, 1].
// Based on: Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors" (hemi-oct).
Vec2 to_hemi_octahedral(Vec3 d);
Vec3 from_hemi_octahedral(Vec2 uv);

}  // namespace lumel
