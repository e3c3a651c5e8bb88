// The light that a runtime's bilinear lookup shows.
#pragma once

#include "check/checked_bake.h"

namespace lumel {

// Luminance of I at a place of the page in texels, centres at i + 0.5, clamped at the page's sides.
double luminance_at(const CheckedPage& page, Vec2 texels);

}  // namespace lumel
