// Pictures for people: exposure, tone curve and sRGB. Only previews and `lumel render` to PNG go through here; nothing
// that is measured does.
// Based on: Khronos 2024, "PBR Neutral Tone Mapper" (the curve: colours below 0.8 are kept as they are, brighter ones
// roll off towards white). We leave out its offset for the Fresnel reflection, which a Lambertian bake does not have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"
#include "lumel/vec.h"

namespace lumel {

// IEC 61966-2-1, value and code in 0..1; clamps.
float srgb_encode(float linear);
float srgb_decode(float code);
std::uint8_t srgb8(float linear);

// The factor that brings the percentile of luminance to `target`: 1 where everything is black. Texels whose mask is 0
// do not count; an empty mask counts all.
struct AutoExposure {
    double fraction = 0.75;  // of the texels are darker than
    float target = 0.5f;     // this, after exposure
};
float auto_exposure(const Image& rgb, std::span<const std::uint8_t> mask = {}, AutoExposure options = {});

// Linear, already exposed, to 0..1 linear.
Vec3 tone_curve(Vec3 exposed);

// 8-bit RGB, row by row. Channels beyond the third are ignored, one channel is grey.
std::vector<std::uint8_t> tonemap(const Image& image, float exposure);

}  // namespace lumel
