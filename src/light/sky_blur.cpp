// Low-pass of a sky map by a spherical cap. On the sphere a cap is not separable, but the part of it within one row of
// the map is an interval of longitudes whose width depends on the two rows alone: a running sum serves the whole row.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "light/sky_map.h"
#include "math/trig.h"

namespace lumel {
namespace {

constexpr double kPiDouble = std::numbers::pi;

// Rows of sub-samples of a source row, so that a cap of few rows still has a round edge.
constexpr double kRowsPerCap = 16.0;

struct Cap {
    double half_angle, cosine;
};

// Half width in longitude of the cap about latitude `center` at latitude `at`; negative where the cap does not reach.
double half_width(const Cap& cap, double center, double at) {
    if (std::fabs(center - at) > cap.half_angle) return -1.0;
    const SinCosDouble c = sincos_radians(center), a = sincos_radians(at);
    const double across = c.cosine * a.cosine, wanted = cap.cosine - c.sine * a.sine;
    if (wanted <= -across) return kPiDouble;  // the whole circle of latitude
    return arccosine(std::min(1.0, wanted / across));
}

using Row = std::vector<std::array<double, 3>>;

// out[x] += scale * (sum of the row over the interval of `half` pixels to either side of the centre of x).
void add_window(std::span<const Vec3> row, double half, double scale, Row& out) {
    const auto width = static_cast<std::ptrdiff_t>(row.size());
    const auto wrap = [&](std::ptrdiff_t x) { return static_cast<std::size_t>(((x % width) + width) % width); };
    half = std::min(half, 0.5 * static_cast<double>(width));
    const auto whole = static_cast<std::ptrdiff_t>(std::floor(std::max(0.0, half - 0.5)));  // whole neighbours a side
    const double center_part = std::min(1.0, 2.0 * half);
    const double edge_part = std::max(0.0, half - 0.5 - static_cast<double>(whole));
    for (std::size_t channel = 0; channel < 3; ++channel) {
        double neighbours = 0.0;
        for (std::ptrdiff_t k = 1; k <= whole; ++k)
            neighbours += double{row[wrap(-k)][channel]} + row[wrap(k)][channel];
        std::size_t before = wrap(-whole - 1), first = wrap(-whole), after = wrap(whole + 1);
        double window = row[0][channel] * center_part + neighbours;
        for (std::size_t x = 0; x < row.size(); ++x) {
            out[x][channel] += scale * (window + edge_part * (double{row[before][channel]} + row[after][channel]));
            // One step to the right. A window of less than a pixel has no running sum.
            window = whole == 0 ? row[wrap(static_cast<std::ptrdiff_t>(x) + 1)][channel] * center_part
                                : window + row[after][channel] - row[first][channel];
            const auto step = [&](std::size_t i) { return i + 1 == row.size() ? 0 : i + 1; };
            before = step(before), first = step(first), after = step(after);
        }
    }
}

// Mean over the cap about each pixel of one row.
void blur_row(const SkyMap& map, const Cap& cap, std::uint32_t y, Row& out) {
    const double row_angle = kPiDouble / map.height;
    const auto latitude = [&](double row) { return kPiDouble * 0.5 - row * row_angle; };
    const double center = latitude(y + 0.5);
    const double rows = cap.half_angle / row_angle;
    const int sub_rows = std::clamp(static_cast<int>(std::ceil(kRowsPerCap / rows)), 1, 16);
    const auto first = static_cast<std::uint32_t>(std::max(0.0, std::floor(y + 0.5 - rows)));
    const auto last = static_cast<std::uint32_t>(std::min(map.height - 1.0, std::floor(y + 0.5 + rows)));
    std::fill(out.begin(), out.end(), std::array<double, 3>{});
    double total = 0.0;
    for (std::uint32_t source = first; source <= last; ++source) {
        const auto pixels = std::span(map.radiance).subspan(std::size_t{source} * map.width, map.width);
        for (int sub = 0; sub < sub_rows; ++sub) {
            const double at = latitude(source + (sub + 0.5) / sub_rows);
            const double width = half_width(cap, center, at);
            if (width <= 0.0) continue;
            const double weight = sincos_radians(at).cosine;
            total += weight * width;
            add_window(pixels, width / (2.0 * kPiDouble) * map.width, weight, out);
        }
    }
    // The window summed pixels; its solid angle was measured in radians of longitude to either side.
    const double scale = total > 0.0 ? 1.0 / (total / kPiDouble * map.width) : 0.0;
    for (auto& pixel : out)
        for (double& channel : pixel) channel *= scale;
}

// Half the rows and columns, by solid angle. Both are even.
SkyMap halved(const SkyMap& map) {
    const std::vector<double> sines = row_edge_sines(map.height);
    SkyMap out;
    out.width = map.width / 2;
    out.height = map.height / 2;
    out.radiance.reserve(std::size_t{out.width} * out.height);
    for (std::uint32_t y = 0; y < out.height; ++y) {
        const double whole = sines[2 * y] - sines[2 * y + 2];
        const auto lower = static_cast<float>((sines[2 * y + 1] - sines[2 * y + 2]) / whole);
        const Vec3* const above = &map.radiance[std::size_t{2 * y} * map.width];
        const Vec3* const below = above + map.width;
        for (std::uint32_t x = 0; x < map.width; x += 2)
            out.radiance.push_back((above[x] + above[x + 1]) * (0.5f * (1.0f - lower)) +
                                   (below[x] + below[x + 1]) * (0.5f * lower));
    }
    return out;
}

// What a cap does to more rows than this it does to half as many: the cost of a blur is that of some million pixels at
// most, whatever the map.
constexpr double kMostRows = 32.0;

}  // namespace

SkyMap blur_sky(const SkyMap& map, float half_angle) {
    const double row_angle = kPiDouble / map.height;
    // A cap within one pixel changes nothing.
    if (half_angle < 0.5 * row_angle) return map;
    if (half_angle > kMostRows * row_angle && map.width % 2 == 0 && map.height % 2 == 0)
        return blur_sky(halved(map), half_angle);
    const double angle = std::min(static_cast<double>(half_angle), kPiDouble);
    const Cap cap{angle, sincos_radians(angle).cosine};
    SkyMap blurred = map;
    Row row(map.width);
    for (std::uint32_t y = 0; y < map.height; ++y) {
        blur_row(map, cap, y, row);
        for (std::uint32_t x = 0; x < map.width; ++x) {
            // A running sum may end a rounding error below zero.
            const auto value = [&](std::size_t channel) { return static_cast<float>(std::max(0.0, row[x][channel])); };
            blurred.radiance[std::size_t{y} * map.width + x] = {value(0), value(1), value(2)};
        }
    }
    const std::array<double, 3> before = integrate(map), after = integrate(blurred);
    const auto keep = [&](std::size_t c) { return after[c] > 0.0 ? static_cast<float>(before[c] / after[c]) : 0.0f; };
    const Vec3 scale{keep(0), keep(1), keep(2)};
    for (Vec3& radiance : blurred.radiance) radiance *= scale;
    return blurred;
}

}  // namespace lumel
