// What a runtime's lookup takes from which texels: the filters that lightmaps are shown with.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lumel/options.h"
#include "lumel/vec.h"

namespace lumel {

// The shares of up to 4 x 4 texels; those of bilinear lookups are the first 2 x 2. They sum to 1.
struct Lookup {
    std::int32_t x = 0, y = 0;  // of the first texel; beyond the page's sides the runtime clamps
    std::uint32_t size = 0;     // texels across
    std::array<float, 4> across{}, down{};

    // Calls visit(x, y, share) for the texels of a page that have a share.
    template <class Visit>
    void for_each(std::uint32_t width, std::uint32_t height, Visit&& visit) const {
        const auto inside = [](std::int32_t at, std::uint32_t size_of_page) {
            if (at < 0) return 0u;
            const auto unsigned_at = static_cast<std::uint32_t>(at);
            return unsigned_at < size_of_page ? unsigned_at : size_of_page - 1;
        };
        for (std::uint32_t j = 0; j < size; ++j)
            for (std::uint32_t i = 0; i < size; ++i)
                if (const float share = across[i] * down[j]; share > 0.0f)
                    visit(inside(x + static_cast<std::int32_t>(i), width),
                          inside(y + static_cast<std::int32_t>(j), height), share);
    }
};

// Of a place on the page in texels, centres at i + 0.5.
inline Lookup lookup_at(LookupFilter filter, Vec2 texels) {
    const float px = texels.x - 0.5f, py = texels.y - 0.5f;
    const float left = std::floor(px), top = std::floor(py);
    const auto shares = [filter](float f) {
        const float g = 1.0f - f;
        if (filter == LookupFilter::bilinear) return std::array{g, f, 0.0f, 0.0f};
        return std::array{g * g * g / 6.0f, (4.0f - 6.0f * f * f + 3.0f * f * f * f) / 6.0f,
                          (4.0f - 6.0f * g * g + 3.0f * g * g * g) / 6.0f, f * f * f / 6.0f};
    };
    const std::int32_t before = filter == LookupFilter::bilinear ? 0 : 1;
    return {static_cast<std::int32_t>(left) - before, static_cast<std::int32_t>(top) - before,
            filter == LookupFilter::bilinear ? 2u : 4u, shares(px - left), shares(py - top)};
}

}  // namespace lumel
