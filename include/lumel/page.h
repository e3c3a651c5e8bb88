// A baked page as plain pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lumel/options.h"
#include "lumel/vec.h"

namespace lumel {

// Coverage decides whether a texel is baked, never its colour.
enum class Coverage : std::uint8_t { none = 0, dilated = 1, filled = 2, baked = 3 };

struct PagePixels {
    std::uint32_t page = 0, mip = 0;  // mip 0: the page itself
    std::uint32_t width = 0, height = 0;
    // Row 0 at the top. I = E/pi, linear RGB, Rec. 709 primaries, about the vertex normal; black where nothing is.
    std::vector<Vec3> irradiance;
    std::vector<Coverage> coverage;

    // Of texel (x, y), whose centre is at (x + 0.5, y + 0.5) texels: index into both.
    [[nodiscard]] std::size_t index(std::uint32_t x, std::uint32_t y) const { return std::size_t{y} * width + x; }
};

struct Lightmap;  // post/lightmap.h: opaque to users of the package

// The pixels of a page that a BakeSink was given, of the layers that `include` sums.
PagePixels read_pixels(const Lightmap& lightmap, const Include& include);

}  // namespace lumel
