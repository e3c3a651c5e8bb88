// A finished bake as a viewer sees it: surfaces with lightmap UVs, and the pages as they were written.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"
#include "lumel/scene.h"

namespace lumel {

// What the master says of a texel, by number. Hidden is told by its count: gathered, but nothing that anybody sees, as
// inside a solid, nor has it a neighbour to be filled from.
enum class TexelState : std::uint8_t { empty = 0, dilated = 1, filled = 2, baked = 3, hidden = 4 };

struct CheckedPage {
    std::uint32_t width = 0, height = 0;
    Image light;                    // I = E/pi: R, G, B as decoded for the runtime
    std::vector<TexelState> state;  // per texel
    Image variance;                 // of the mean of I: R, G, B
};

// A triangle as it is drawn, in world space.
struct CheckedTriangle {
    std::array<Vec3, 3> position, normal;  // metres; unit vertex normals
    std::array<Vec2, 3> uv;                // of the lightmap, 0..1
    std::uint32_t page = 0, instance = 0;
};

struct CheckedBake {
    std::vector<CheckedTriangle> triangles;  // the lightmapped ones
    std::vector<std::string> instances;      // their names
    std::vector<CheckedPage> pages;

    [[nodiscard]] Vec2 texels(const CheckedTriangle& t, std::uint32_t corner) const {
        return {t.uv[corner].x * static_cast<float>(pages[t.page].width),
                t.uv[corner].y * static_cast<float>(pages[t.page].height)};
    }
};

// Mean luminance of the baked texels that are finite. 0: there are none.
double mean_light(const CheckedBake& bake);

}  // namespace lumel
