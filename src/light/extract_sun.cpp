// Takes the sun's disc out of a sky map: a light of half a degree is better sampled as a directional light than as
// pixels.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "light/light_sample.h"
#include "light/sky_map.h"
#include "math/constants.h"
#include "math/trig.h"

namespace lumel {
namespace {

constexpr float kMinContrast = 100.0f;             // of the brightest pixel to the mean of the map
constexpr float kShareOfPeak = 0.02f;              // pixels of the disc, its blurred edge included, have at least this
constexpr float kTimesMean = 8.0f;                 // and this
constexpr float kMaxRadius = 2.5f * kPi / 180.0f;  // the sun has 0.27 degrees; lenses and coarse maps widen it

struct Pixels {
    const SkyMap& map;

    [[nodiscard]] std::size_t count() const { return map.radiance.size(); }
    [[nodiscard]] float strength_at(std::size_t pixel) const { return strength(map.radiance[pixel]); }
    [[nodiscard]] Vec3 direction(std::size_t pixel) const {
        const std::size_t column = pixel % map.width, row = pixel / map.width;
        const auto x = static_cast<float>(column), y = static_cast<float>(row);
        return sky_direction((x + 0.5f) / static_cast<float>(map.width), (y + 0.5f) / static_cast<float>(map.height));
    }
    // The eight around a pixel (a row beyond a pole is the row itself); columns wrap.
    [[nodiscard]] std::array<std::size_t, 8> neighbours(std::size_t pixel) const {
        const std::size_t w = map.width, h = map.height, x = pixel % w, y = pixel / w;
        const std::size_t left = x == 0 ? w - 1 : x - 1, right = x + 1 == w ? 0 : x + 1;
        const std::size_t above = (y == 0 ? 0 : y - 1) * w, here = y * w, below = std::min(y + 1, h - 1) * w;
        return {above + left, above + x,    above + right, here + left,
                here + right, below + left, below + x,     below + right};
    }
};

std::size_t brightest(const Pixels& pixels) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < pixels.count(); ++i)
        if (pixels.strength_at(i) > pixels.strength_at(best)) best = i;
    return best;
}

// Pixels of at least `threshold` connected to the seed, and those that touch them.
struct Region {
    std::vector<std::size_t> inside, around;
};

Region grow(const Pixels& pixels, std::size_t seed, float threshold) {
    Region region{{seed}, {}};
    std::vector<std::uint8_t> seen(pixels.count());
    seen[seed] = 1;
    for (std::size_t next = 0; next < region.inside.size(); ++next)
        for (const std::size_t i : pixels.neighbours(region.inside[next])) {
            if (seen[i]) continue;
            seen[i] = 1;
            (pixels.strength_at(i) >= threshold ? region.inside : region.around).push_back(i);
        }
    return region;
}

struct SolidAngles {
    explicit SolidAngles(const SkyMap& map) : sines(row_edge_sines(map.height)), width(map.width) {}
    [[nodiscard]] double operator()(std::size_t pixel) const {
        const std::size_t row = pixel / width;
        return (sines[row] - sines[row + 1]) * (2.0 * std::numbers::pi) / width;
    }
    std::vector<double> sines;
    std::uint32_t width;
};

Vec3 mean_radiance(const Pixels& pixels, const std::vector<std::size_t>& set, const SolidAngles& solid_angle) {
    std::array<double, 3> sum{};
    double total = 0.0;
    for (const std::size_t i : set) {
        const Vec3 c = pixels.map.radiance[i];
        const double w = solid_angle(i);
        sum[0] += w * c.x, sum[1] += w * c.y, sum[2] += w * c.z;
        total += w;
    }
    if (total == 0.0) return {};
    return {static_cast<float>(sum[0] / total), static_cast<float>(sum[1] / total), static_cast<float>(sum[2] / total)};
}

// The disc of radiance above its surroundings as a directional light.
Light make_sun(const Pixels& pixels, const Region& region, Vec3 background, const SolidAngles& solid_angle) {
    std::array<double, 3> irradiance{}, direction{};
    double weight = 0.0, peak = 0.0;
    for (const std::size_t i : region.inside) {
        const double w = solid_angle(i);
        const Vec3 excess = max(pixels.map.radiance[i] - background, Vec3{}), d = pixels.direction(i);
        const double s = strength(excess);
        for (std::size_t k = 0; k < 3; ++k) irradiance[k] += w * excess[k], direction[k] += w * s * d[k];
        weight += w * s;
        peak = std::max(peak, s);
    }
    const auto vector = [](const std::array<double, 3>& v) {
        return Vec3{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    };
    // A uniform disc of the peak's radiance: pixels that the edge cuts, or blur dims, count by their share.
    const double disc = weight / peak;
    Light sun;
    sun.name = "sun of the sky map";
    sun.shape = LightShape::sun;
    sun.direction = -normalize(vector(direction));
    sun.intensity = vector(irradiance);
    sun.angular_diameter = static_cast<float>(2.0 * arccosine(1.0 - disc / (2.0 * std::numbers::pi)));
    return sun;
}

bool is_compact(const Pixels& pixels, const Region& region, Vec3 center) {
    const double limit = sincos_radians(kMaxRadius).cosine;
    return std::all_of(region.inside.begin(), region.inside.end(),
                       [&](std::size_t i) { return dot(pixels.direction(i), center) >= limit; });
}

Error no_sun(const char* why) {
    return {ErrorCode::unsupported, std::string("no sun found in the sky map: ") + why, {}, {}};
}

}  // namespace

Result<ExtractedSun> extract_sun(const SkyMap& map) {
    const Pixels pixels{map};
    const SolidAngles solid_angle(map);
    const std::array<double, 3> total = integrate(map);
    const auto mean = static_cast<float>((total[0] + total[1] + total[2]) / (12.0 * kPi));
    const std::size_t peak = brightest(pixels);
    const float peak_strength = pixels.strength_at(peak);
    if (!(peak_strength > kMinContrast * mean)) return no_sun("its brightest pixel does not stand out");

    const Region region = grow(pixels, peak, std::max(kShareOfPeak * peak_strength, kTimesMean * mean));
    const Vec3 background = mean_radiance(pixels, region.around, solid_angle);
    ExtractedSun result{map, make_sun(pixels, region, background, solid_angle)};
    if (!is_compact(pixels, region, -result.sun.direction)) return no_sun("its brightest part is too wide for a disc");
    for (const std::size_t i : region.inside) result.sky.radiance[i] = min(map.radiance[i], background);
    return result;
}

}  // namespace lumel
