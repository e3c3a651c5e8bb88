// A fence before stb_image's PNG decoder, which allocates what an IDAT chunk states as its length (up to 1 GB) before
// it looks for so many bytes (stb_image 2.27, stbi__parse_png_file). Remove it with the last supported system that has
// that version.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "lumel/result.h"

namespace lumel {

// An error where a chunk of the PNG file before its end chunk states more bytes than the file has left.
Status check_png_chunks(std::span<const std::byte> png, const std::string& where);

}  // namespace lumel
