// Pictures and errors for the tests of the block encoders.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "image/image.h"
#include "support/statistics.h"

namespace lumel::bc_test {

// Two planes of light that meet at a slanted edge, as charts and shadows do, and a little noise. Values 0.05 to 8.
inline Image lit_picture(std::uint32_t width, std::uint32_t height, std::uint32_t channels, std::uint64_t seed) {
    test::Random random(seed);
    Image out(width, height, channels);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const bool lit = 3 * x + 2 * y < 2 * width;
            const float slope = static_cast<float>(x + 2 * y) / static_cast<float>(width + 2 * height);
            for (std::uint32_t c = 0; c < channels; ++c) {
                const float tint = 1.0f + 0.3f * static_cast<float>(c) * (lit ? 1.0f : -0.8f);
                const float noise = 1.0f + 0.02f * (random.unit() - 0.5f);
                out.at(x, y)[c] = (lit ? 4.0f + 2.0f * slope : 0.1f + 0.3f * slope) * tint * noise;
            }
        }
    return out;
}

// Scaled to 0..1, as textures of eight bits hold it.
inline Image coded_picture(std::uint32_t width, std::uint32_t height, std::uint32_t channels, std::uint64_t seed) {
    Image out = lit_picture(width, height, channels, seed);
    for (float& value : out.data) value = std::sqrt(value / 16.0f);
    return out;
}

// What encoders make of any floats: NaN is 0, values lie within [low, high].
inline Image sanitised(Image image, float low, float high) {
    for (float& value : image.data)
        value = value > 0.0f ? std::fmin(value, high) : std::fmax(value < 0.0f ? value : 0.0f, low);
    return image;
}

// Some weights of 0, some of 1 and some between.
inline std::vector<float> mixed_weights(std::size_t count, float scale) {
    std::vector<float> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = scale * (i % 7 == 0 ? 0.0f : i % 3 == 0 ? 1.0f : 0.3f);
    return out;
}
// Powers of two, so that only what is beyond float can make a difference: 1e-25 and 1e25, nearly.
inline constexpr float kScales[] = {0x1p-83f, 0x1p83f};

// Root of the weighted mean square of difference(got, wanted), over the channels that both have.
template <class Difference>
double weighted_error(const Image& got, const Image& wanted, const std::vector<float>& weights,
                      Difference&& difference) {
    double sum = 0.0, total = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i)
        for (std::uint32_t c = 0; c < wanted.channels; ++c) {
            const double d = difference(static_cast<double>(got.data[i * got.channels + c]),
                                        static_cast<double>(wanted.data[i * wanted.channels + c]));
            sum += static_cast<double>(weights[i]) * d * d;
            total += static_cast<double>(weights[i]);
        }
    return std::sqrt(sum / total);
}

inline double plain(double a, double b) { return a - b; }
inline double logarithmic(double a, double b) { return std::log(std::fabs(a) + 1e-4) - std::log(std::fabs(b) + 1e-4); }

// Weight 1 on one side of a line through each block, 0 on the other: chart borders everywhere.
inline std::vector<float> chart_weights(std::uint32_t width, std::uint32_t height) {
    std::vector<float> out(std::size_t{width} * height);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) out[y * std::size_t{width} + x] = (x + 2 * y) % 8 < 5 ? 1.0f : 0.0f;
    return out;
}

}  // namespace lumel::bc_test
