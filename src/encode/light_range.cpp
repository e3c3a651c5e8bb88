#include "encode/light_range.h"

#include <algorithm>
#include <cmath>

namespace lumel {

LightRange light_range(std::span<const Numbers> texels, std::size_t first, std::size_t count) {
    LightRange out;
    double sum = 0.0;
    for (const Numbers& numbers : texels)
        for (std::size_t i = first; i < first + count; ++i) {
            const float size = std::fabs(numbers[i]);
            out.largest = std::max(out.largest, size);
            sum += static_cast<double>(size);
        }
    if (!texels.empty() && count > 0) out.mean = sum / static_cast<double>(texels.size() * count);
    return out;
}

}  // namespace lumel
