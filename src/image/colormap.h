// Colours for numbers: heat maps and identities.
#pragma once

#include <cstdint>

#include "lumel/vec.h"

namespace lumel {

// t in 0..1 (clamped) to an sRGB-coded colour: dark blue, teal, green, yellow. Brightness rises all the way, so that it
// reads in grey and for colour-blind eyes. Our own cubic curve, in the manner of viridis (Smith and van der Walt 2015).
Vec3 heat_color(float t);

// A colour (sRGB-coded) for an identity: hue from a hash, neighbours in number far apart in hue.
Vec3 identity_color(std::uint64_t id);

}  // namespace lumel
