// What somebody who looks for a defect of a bake looks at: numbers per texel of a page, and how they are shown.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "lumel/vec.h"

namespace lumel {

// How numbers become colours (color_scale.h).
enum class ColorRule : std::uint8_t {
    category,     // channel 0 is the index of a Category
    identity,     // channel 0 is the number of something: a colour each
    share,        // 0 to 1, dark to yellow
    heat,         // 0 to the 99th percentile, dark to yellow
    log_heat,     // of the logarithm: the median in the middle, a factor of 16 from end to end
    reflectance,  // linear RGB in 0..1
    light,        // linear RGB of any size: one exposure, tone-mapped
    around_zero,  // grey or RGB: middle grey is 0, black and white are -/+ the 99th percentile of what there is
    direction,    // X, Y, Z in -1..1 as red, green, blue: middle grey is 0
    place,        // X, Y, Z within the bounds of all of them as red, green, blue
};

struct Category {
    const char* name;
    Vec3 color;  // sRGB-coded 0..1
};

struct TexelLayer {
    std::string name;  // as the command line calls it
    std::string what;
    std::string unit;  // empty: a number without one
    ColorRule rule = ColorRule::share;
    std::vector<std::string> channels{"Y"};  // of its numbers, as an EXR file names them
    std::span<const Category> categories = {};
    // Dilated texels have numbers, too: it is what a renderer looks up. Else lookups take the mean of the texels that
    // have one.
    bool is_looked_up = false;

    // Whether the mean of two of its numbers means something.
    [[nodiscard]] bool blends() const { return rule != ColorRule::category && rule != ColorRule::identity; }
};

// Which texels of a page have numbers.
enum class Presence : std::uint8_t { none, dilated, covered };

struct LayerPage {
    Image values;                    // a channel for each of the layer
    std::vector<Presence> presence;  // per pixel

    LayerPage() = default;
    LayerPage(std::uint32_t width, std::uint32_t height, const TexelLayer& layer)
        : values(width, height, static_cast<std::uint32_t>(layer.channels.size())),
          presence(std::size_t{width} * height, Presence::none) {}
    // Nothing dilated any more.
    void drop_dilated();
};

}  // namespace lumel
