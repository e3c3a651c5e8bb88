// All of shaders/*.glsl as C++, and the cases that every language runs (cases.glsl). For one file of a program.
#pragma once

#include "shaders/shader_types.h"

namespace lumel::test::glsl {
#include "bicubic.glsl"
#include "bounce.glsl"
#include "chart_transform.glsl"
#include "hemisphere_bases.glsl"
#include "hhd.glsl"
#include "specular.glsl"
#include "spherical_harmonics.glsl"
#include "storage.glsl"
#include "tangent_frame.glsl"
// These need some of the above.
#include "irradz.glsl"
#include "l1.glsl"
#include "probe_hemisphere.glsl"
#include "probe_hhd.glsl"
#include "zh3.glsl"
// These call all of them.
#include "cases.glsl"
}  // namespace lumel::test::glsl
