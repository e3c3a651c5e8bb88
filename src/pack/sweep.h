// The published packer, kept as a plain twin for tests and as the peer in the benchmark.
//
// Based on: O'Donnell, "Precomputed Global Illumination in Frostbite" (2018), after Boulton, "Static lighting tricks in
// Halo 4" (2013): charts from large to small by width + height, each swept over the rows of the page's bit mask, from
// the row where the last chart of the same size was found. Different here: positions whose first texel is taken are
// skipped a run at a time, and charts of one width + height go by their height.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lumel/context.h"
#include "pack/mask.h"
#include "pack/page_work.h"

namespace lumel {

// The texels of a page that are taken. Rows are added as they are needed.
class PageBits {
public:
    explicit PageBits(std::uint32_t width) : width_(width), words_per_row_((width + 63) / 64 + 1) {}

    [[nodiscard]] std::uint32_t width() const { return width_; }

    struct Spot {
        bool found = false;
        std::uint32_t x = 0, y = 0;
    };
    // First free position of the mask by rows, from `start_row`, all its rows below `height`.
    Spot find(const ChartMask& mask, std::uint32_t start_row, std::uint32_t height);
    void set(const ChartMask& mask, std::uint32_t x, std::uint32_t y);

private:
    void grow(std::uint32_t rows);
    [[nodiscard]] bool fits(const ChartMask& mask, std::uint32_t x, std::uint32_t y) const;
    [[nodiscard]] std::uint32_t skip_taken(std::uint32_t x, std::uint32_t y) const;

    std::uint32_t width_, words_per_row_, rows_ = 0;
    std::vector<std::uint64_t> bits_;
};

// One page as high as it takes. Precondition: no mask is wider.
PageFill sweep_page(std::span<const ChartMask> masks, std::span<const std::uint32_t> mask_of, std::uint32_t width,
                    const Context& context);

}  // namespace lumel
