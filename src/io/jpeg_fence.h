// A fence before stb_image's JPEG decoder, which writes beyond its arrays where a Huffman table names more than 256
// symbols (stb_image 2.27, stbi__build_huffman). Remove it with the last supported system that has that version.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "lumel/result.h"

namespace lumel {

// An error where some Huffman table of the JPEG file is larger than JPEG allows, or a segment leaves the file.
Status check_jpeg_tables(std::span<const std::byte> jpeg, const std::string& where);

}  // namespace lumel
