// A page whose texels are solved into an encoding.
#pragma once

#include <cstdint>
#include <vector>

#include "encode/encoding.h"

namespace lumel {

// Numbers of the covered texels of a page, as files hold them: world frame where the encoding rotates.
struct EncodedPage {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> texel_at;  // width*height: index of the texel, or kNone
    std::vector<Numbers> numbers;
};

}  // namespace lumel
