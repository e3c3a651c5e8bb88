// Layers as pictures for people, each with the legend that says what its colours are.
#pragma once

#include <string>

#include "image/image.h"
#include "inspect/color_scale.h"
#include "inspect/layer.h"
#include "inspect/view.h"

namespace lumel {

inline constexpr Vec3 kBackColor{1, 0, 1};               // of backs of single-sided surfaces
inline constexpr Vec3 kEmptyColor{0.07f, 0.07f, 0.09f};  // where no texel has a number
inline constexpr Vec3 kNoLightmapColor{0.36f, 0.36f, 0.40f};
inline constexpr Vec3 kNothingColor{0.80f, 0.87f, 0.93f};
inline constexpr Vec3 kNotFiniteColor{1, 0, 0};

// RGB, sRGB-coded 0..1. `about`: how it was looked up, for the legend. Pages of 256 texels or
// less are magnified by a whole number.
Image draw_page(const TexelLayer& layer, const LayerPage& page, const ColorScale& scale, const std::string& about);
Image draw_view(const TexelLayer& layer, const LayerView& view, const ColorScale& scale, const std::string& about);

}  // namespace lumel
