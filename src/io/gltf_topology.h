// Triangles of a glTF primitive as a plain list, whatever its mode.
#pragma once

#include <span>

#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

enum class PrimitiveMode : std::uint8_t {
    points,
    lines,
    line_loop,
    line_strip,
    triangles,
    triangle_strip,
    triangle_fan
};

[[nodiscard]] inline bool has_triangles(PrimitiveMode mode) { return mode >= PrimitiveMode::triangles; }

// `indices` in the order of the file. Strips keep the winding of their first triangle; triangles of strips and fans
// that name a vertex twice only stitch and are dropped. An error where a list is no multiple of three.
Result<std::vector<Triangle>> make_triangles(PrimitiveMode mode, std::span<const std::uint32_t> indices,
                                             const std::string& where);

}  // namespace lumel
