// A float image, channels interleaved, row 0 at the top (v = 0).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lumel {

struct Image {
    std::uint32_t width = 0, height = 0, channels = 0;
    std::vector<float> data;  // width * height * channels

    Image() = default;
    Image(std::uint32_t w, std::uint32_t h, std::uint32_t c)
        : width(w), height(h), channels(c), data(std::size_t{w} * h * c) {}

    [[nodiscard]] float* at(std::uint32_t x, std::uint32_t y) { return &data[(std::size_t{y} * width + x) * channels]; }
    [[nodiscard]] const float* at(std::uint32_t x, std::uint32_t y) const {
        return &data[(std::size_t{y} * width + x) * channels];
    }
};

}  // namespace lumel
