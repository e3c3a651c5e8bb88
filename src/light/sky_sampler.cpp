#include "light/sky_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "light/light_sample.h"
#include "light/sky_map.h"
#include "math/constants.h"
#include "math/discrete.h"
#include "math/trig.h"

namespace lumel {
namespace {

// Integral of linear interpolation over a pixel: 6/8 of its own value and 1/8 of each neighbour's.
double pixel_integral(double before, double own, double after) { return 0.75 * own + 0.125 * (before + after); }

// The same down the columns: interpolated strengths of one row of the map, before the integration along it.
void integrate_column_wise(const SkyMap& map, std::uint32_t row, std::span<double> out) {
    const auto at = [&](std::uint32_t y, std::uint32_t x) {
        return double{strength(map.radiance[std::size_t{y} * map.width + x])};
    };
    const std::uint32_t above = row == 0 ? 0 : row - 1, below = std::min(row + 1, map.height - 1);
    for (std::uint32_t x = 0; x < map.width; ++x) out[x] = pixel_integral(at(above, x), at(row, x), at(below, x));
}

}  // namespace

SkySampler::SkySampler(const SkyMap& map)
    : width_(map.width), height_(map.height), edge_sines_(row_edge_sines(map.height)) {
    row_ends_.resize(height_);
    pixel_ends_.resize(std::size_t{width_} * height_);
    std::vector<double> rows(height_), columns(width_), pixels(width_);
    for (std::uint32_t y = 0; y < height_; ++y) {
        integrate_column_wise(map, y, columns);
        double sum = 0.0;
        for (std::uint32_t x = 0; x < width_; ++x) {
            pixels[x] =
                pixel_integral(columns[x == 0 ? width_ - 1 : x - 1], columns[x], columns[x + 1 == width_ ? 0 : x + 1]);
            sum += pixels[x];
        }
        share_units(pixels, width_, std::span(pixel_ends_).subspan(std::size_t{y} * width_, width_));
        rows[y] = sum * (edge_sines_[y] - edge_sines_[y + 1]);
    }
    share_units(rows, height_, row_ends_);
}

float SkySampler::pdf_of_pixel(std::size_t row, std::uint32_t row_units, std::uint32_t pixel_units) const {
    const double solid_angle = (edge_sines_[row] - edge_sines_[row + 1]) * 2.0 * kPi / width_;
    return static_cast<float>(double{probability(row_units)} * probability(pixel_units) / solid_angle);
}

SkySampler::Sample SkySampler::sample(Vec2 u) const {
    const Choice row = choose(row_ends_, u.y);
    const Choice pixel = choose(std::span(pixel_ends_).subspan(row.index * width_, width_), u.x);
    const double sine = edge_sines_[row.index] + row.fraction * (edge_sines_[row.index + 1] - edge_sines_[row.index]);
    const double cosine = std::sqrt(std::max(0.0, (1.0 - sine) * (1.0 + sine)));
    const double map_u = (static_cast<double>(pixel.index) + pixel.fraction) / width_;
    const SinCosDouble azimuth = sincos_radians((map_u - 0.5) * (2.0 * std::numbers::pi));
    return {{static_cast<float>(cosine * azimuth.cosine), static_cast<float>(sine),
             static_cast<float>(cosine * azimuth.sine)},
            pdf_of_pixel(row.index, row.units, pixel.units)};
}

float SkySampler::pdf(Vec2 uv) const {
    const auto x = std::min(static_cast<std::uint32_t>(uv.x * static_cast<float>(width_)), width_ - 1);
    const auto y = std::min(static_cast<std::uint32_t>(uv.y * static_cast<float>(height_)), height_ - 1);
    const auto pixels = std::span(pixel_ends_).subspan(std::size_t{y} * width_, width_);
    return pdf_of_pixel(y, units_of(row_ends_, y), units_of(pixels, x));
}

}  // namespace lumel
