// Sizes that who writes the output obeys and who predicts its memory counts with.
#pragma once

#include <algorithm>
#include <cstdint>

namespace lumel {

// Rows of an OpenEXR file that are compressed together, by one thread: fewer at a time would leave threads idle.
inline constexpr std::uint32_t kExrRowsPerChunk = 16;

// Previews of pages are at most this wide and high, and of so many bytes a pixel while the bake goes on: irradiance,
// sample count, covered or not.
inline constexpr std::uint32_t kPreviewEdge = 1024;
inline constexpr std::uint32_t kPreviewPixelBytes = 4 * sizeof(float) + sizeof(std::uint8_t);

// So many texels in either direction become one pixel of a preview.
constexpr std::uint32_t preview_block(std::uint32_t width, std::uint32_t height, std::uint32_t max_edge) {
    return (std::max(width, height) + max_edge - 1) / max_edge;
}

}  // namespace lumel
