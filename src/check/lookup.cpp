#include "check/lookup.h"

#include <algorithm>
#include <cmath>

namespace lumel {

double luminance_at(const CheckedPage& page, Vec2 texels) {
    const double x = std::clamp(double{texels.x} - 0.5, 0.0, page.width - 1.0);
    const double y = std::clamp(double{texels.y} - 0.5, 0.0, page.height - 1.0);
    const auto x0 = static_cast<std::uint32_t>(x), y0 = static_cast<std::uint32_t>(y);
    double sum = 0.0;
    for (std::uint32_t j = 0; j < 2; ++j)
        for (std::uint32_t i = 0; i < 2; ++i) {
            const double share = (i == 0 ? 1.0 - (x - x0) : x - x0) * (j == 0 ? 1.0 - (y - y0) : y - y0);
            if (share == 0.0) continue;  // texels that have none may hold anything
            const float* rgb = page.light.at(std::min(x0 + i, page.width - 1), std::min(y0 + j, page.height - 1));
            sum += share * static_cast<double>(luminance({rgb[0], rgb[1], rgb[2]}));
        }
    return sum;
}

double mean_light(const CheckedBake& bake) {
    double sum = 0.0, count = 0.0;
    for (const CheckedPage& page : bake.pages)
        for (std::size_t i = 0; i < page.state.size(); ++i) {
            if (page.state[i] != TexelState::baked) continue;
            const float* rgb = &page.light.data[i * page.light.channels];
            const double light = static_cast<double>(luminance({rgb[0], rgb[1], rgb[2]}));
            if (!std::isfinite(light)) continue;
            sum += light;
            ++count;
        }
    return count > 0.0 ? sum / count : 0.0;
}

}  // namespace lumel
