// How far what shaders decode is from what the master knows, for the texels of a page.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encode/encoding.h"

namespace lumel {

// Texels to measure: their light in the tangent frame of each, and which pairs lie side by side on one plane.
struct MeasuredTexels {
    std::vector<TexelLight> light;
    std::vector<Rotation> frame;
    std::vector<std::array<std::uint32_t, 2>> neighbours;  // indices
};

// Relative errors; the mean is that of the irradiance over all texels, normals and channels. Where it is zero they are
// zero too; where an error is no number it is infinite.
struct ReconstructionError {
    double nrmse = 0.0;             // over texels, normals of the hemisphere, channels
    double p99 = 0.0, worst = 0.0;  // of the texels' own: root mean square over its mean (plus a hundredth of all)
    double at_normal = 0.0;         // nrmse at n_v
    double between = 0.0;           // nrmse half way between neighbours, against the mean of both
    double outside = 0.0;           // share of neighbours between which I at n_v leaves their interval by over 1 %
};

// The reference is the irradiance that nine coefficients of light from above the horizon imply (hemisphere_fit.h).
ReconstructionError measure(const Encoding& encoding, Storage storage, const MeasuredTexels& texels);
// The same of numbers as files hold them: in the world frame where the encoding rotates, rounded, one of each texel.
ReconstructionError measure(const Encoding& encoding, std::span<const Numbers> stored, const MeasuredTexels& texels);

// The numbers of texels as files hold them, before they are rounded.
std::vector<Numbers> solve_for_files(const Encoding& encoding, std::span<const TexelLight> light,
                                     std::span<const Rotation> frames);

}  // namespace lumel
