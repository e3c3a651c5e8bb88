// Charts of random sizes and shapes: rectangles, triangles, Ls and frames, many tiny ones and few large ones.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "pack/mask.h"
#include "support/statistics.h"

namespace lumel::test {

inline ChartMask rectangle_mask(std::uint32_t w, std::uint32_t h) {
    ChartMask mask(w, h);
    for (std::uint32_t y = 0; y < h; ++y) mask.set_span(y, 0, w);
    mask.used = mask.count();
    return mask;
}

inline ChartMask random_mask(Random& random, std::uint32_t largest) {
    // Extents fall off like 1 / size^2.
    const auto extent = [&] {
        const float size = 2.0f / (1.0f - random.unit() * (1.0f - 2.0f / static_cast<float>(largest)));
        return static_cast<std::uint32_t>(size);
    };
    const std::uint32_t w = extent(), h = extent(), kind = random.bits() % 4;
    ChartMask mask(w, h);
    for (std::uint32_t y = 0; y < h; ++y) {
        if (kind == 1) {
            mask.set_span(y, 0, std::max(1u, w - y * w / h));
        } else if (kind == 2 && y >= (h + 1) / 2) {
            mask.set_span(y, 0, (w + 1) / 2);
        } else if (kind == 3 && y > 0 && y + 1 < h && w > 2) {
            mask.set_span(y, 0, 1);
            mask.set_span(y, w - 1, w);
        } else {
            mask.set_span(y, 0, w);
        }
    }
    mask.used = mask.count();
    return mask;
}

inline std::vector<ChartMask> random_masks(std::size_t count, std::uint32_t largest, std::uint64_t seed) {
    Random random(seed);
    std::vector<ChartMask> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(random_mask(random, largest));
    return out;
}

}  // namespace lumel::test
