#include "light/dark_sky.h"

#include <array>
#include <cstdio>

#include "light/sky_map.h"
#include "math/constants.h"

namespace lumel {
namespace {

constexpr double kDark = 1e-3;  // of the suns' illuminance

// Of a plane below it, as if it were even: pi times its mean radiance.
double illuminance_of(const Sky& sky) {
    if (!sky.map) return double{kPi} * double{luminance(sky.color)};
    const std::array<double, 3> sum = integrate(*sky.map);
    constexpr double kSphere = 4.0 * double{kPi};
    const auto mean = [&](std::size_t c) { return static_cast<float>(sum[c] / kSphere); };
    return double{kPi} * double{luminance({mean(0), mean(1), mean(2)})};
}

}  // namespace

void warn_of_dark_sky(const Scene& scene, Diagnostics& diagnostics) {
    double suns = 0.0;
    for (const Light& light : scene.lights)
        if (light.shape == LightShape::sun) suns += double{luminance(light.intensity)};
    const double sky = illuminance_of(scene.sky);
    if (!(sky > 0.0) || !(sky <= kDark * suns)) return;
    char where[120];
    std::snprintf(where, sizeof where, "the sky lights a plane with %.3g lux, the sun with %.3g", sky, suns);
    diagnostics.add("dark-sky",
                    "Beside such a sun the sky is black; its numbers are nits: a clear one has some thousands "
                    "(--sky-intensity scales it)",
                    where);
}

}  // namespace lumel
