// Words in a picture.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace lumel {

// 8-bit RGB, row by row: white words on black, in the lower corner of the part from `left` on. ASCII; what does not fit
// is cut.
void draw_label(std::span<std::uint8_t> rgb, std::uint32_t width, std::uint32_t left, const std::string& words);

}  // namespace lumel
