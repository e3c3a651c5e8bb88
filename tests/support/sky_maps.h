// Small sky maps made in code.
#pragma once

#include <cstdint>
#include <vector>

#include "light/sky_map.h"
#include "lumel/scene.h"
#include "support/statistics.h"

namespace lumel::test {

// Radiance a + b d.y in green; half of it in red, twice in blue.
inline SkyMap gradient_sky(std::uint32_t width, std::uint32_t height, float a, float b) {
    SkyMap map{width, height, std::vector<Vec3>(std::size_t{width} * height)};
    for (std::uint32_t y = 0; y < height; ++y) {
        const float sine = sky_direction(0.5f, (static_cast<float>(y) + 0.5f) / static_cast<float>(height)).y;
        for (std::uint32_t x = 0; x < width; ++x)
            map.radiance[std::size_t{y} * width + x] = Vec3{0.5f, 1, 2} * (a + b * sine);
    }
    return map;
}

inline SkyMap one_pixel_sky(std::uint32_t width, std::uint32_t height, std::uint32_t x, std::uint32_t y,
                            Vec3 radiance) {
    SkyMap map{width, height, std::vector<Vec3>(std::size_t{width} * height)};
    map.radiance[std::size_t{y} * width + x] = radiance;
    return map;
}

// Independent pixels of a wide range, a fifth of them black.
inline SkyMap random_sky(std::uint32_t width, std::uint32_t height, std::uint64_t seed) {
    SkyMap map{width, height, std::vector<Vec3>(std::size_t{width} * height)};
    Random random(seed);
    for (Vec3& c : map.radiance) {
        const float u = random.unit(), scale = u < 0.2f ? 0.0f : 1.0f / (1.01f - u);
        c = Vec3{random.unit(), random.unit(), random.unit()} * scale;
    }
    return map;
}

}  // namespace lumel::test
