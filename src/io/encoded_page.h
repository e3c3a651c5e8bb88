// A page solved into an encoding and written as named channels of an EXR.
#pragma once

#include <filesystem>
#include <string>

#include "encode/encoded_page.h"
#include "io/master.h"
#include "lumel/context.h"

namespace lumel {

// The light of a texel in its tangent frame.
TexelLight light_of_texel(const MasterPage& master, std::size_t texel);

// Error: cancelled.
Result<EncodedPage> encode_page(const Encoding& encoding, const MasterPage& master, Context& context);

// Channels are named as the encoding's fields. Half where halves hold the light, else float: returns "half" or "float".
Result<std::string> write_encoded_page(const std::filesystem::path& file, const Encoding& encoding,
                                       const EncodedPage& page, Context& context);

}  // namespace lumel
