// From the numbers of a layer to colours: one scale for all of its pages and views, and how a legend reads it.
#pragma once

#include <span>
#include <vector>

#include "inspect/layer.h"

namespace lumel {

class ColorScale {
public:
    // Reads from the numbers of all pages what the layer's rule leaves open.
    ColorScale(const TexelLayer& layer, std::span<const LayerPage> pages);

    // sRGB-coded 0..1, of the layer's channels.
    [[nodiscard]] Vec3 color(std::span<const float> value) const;

    // The ends of the scale; where it is one of light the highest is what a display shows as all but white.
    [[nodiscard]] float low() const { return low_; }
    [[nodiscard]] float high() const { return high_; }
    // The number at t (0..1) of the way from one end to the other.
    [[nodiscard]] float value_at(float t) const;
    // What light is multiplied by before the tone curve; 1 for all else.
    [[nodiscard]] float exposure() const { return exposure_; }
    // ColorRule::place: where the scale begins on each axis. All are as long as from low() to high().
    [[nodiscard]] Vec3 origin() const { return origin_; }

private:
    ColorRule rule_;
    std::span<const Category> categories_;
    float low_ = 0.0f, high_ = 1.0f, exposure_ = 1.0f;
    Vec3 origin_{};
};

}  // namespace lumel
