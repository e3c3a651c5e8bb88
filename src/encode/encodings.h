// The encodings, one file each (irradz.cpp, l1.cpp and h_basis.cpp have families that share what they store).
#pragma once

#include "encode/encoding.h"

namespace lumel {

extern const Encoding kIrradianceEncoding;                    // irradiance.cpp
extern const Encoding kL1Linear, kL1Hazel, kL1Hhd;            // l1.cpp
extern const Encoding kL1LinearFit, kL1HazelFit;              // l1_fit.cpp
extern const Encoding kL1Mono;                                // l1_mono.cpp
extern const Encoding kIrradZAhd, kIrradZHhd, kIrradZAhdRgb,  // irradz.cpp
    kIrradZHhdRgb, kIrradZHhdClosed;
extern const Encoding kHlsh;                   // hlsh.cpp
extern const Encoding kZh3, kZh3Hallucinated;  // zh3.cpp
extern const Encoding kH4, kH6;                // h_basis.cpp
extern const Encoding kL2;                     // l2.cpp
// To compare with.
extern const Encoding kAhd;                 // ahd.cpp
extern const Encoding kAmbientCube;         // ambient_cube.cpp
extern const Encoding kRnm;                 // rnm.cpp
extern const Encoding kSphericalGaussians;  // spherical_gaussians.cpp

}  // namespace lumel
