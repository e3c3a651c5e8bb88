// Packs chart masks into pages.
//
// Based on: O'Donnell, "Precomputed Global Illumination in Frostbite" (2018), after Boulton, "Static lighting tricks in
// Halo 4" (2013): charts from large to small by width + height, each swept over the rows of the page's bit mask, from
// the row where the last chart of the same size was found. Different here: positions whose first texel is taken are
// skipped a run at a time, and groups (the charts of one instance) stay on one page.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "chart/chart_mask.h"

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
    void clear(const ChartMask& mask, std::uint32_t x, std::uint32_t y);

private:
    void grow(std::uint32_t rows);
    [[nodiscard]] bool fits(const ChartMask& mask, std::uint32_t x, std::uint32_t y) const;
    [[nodiscard]] std::uint32_t skip_taken(std::uint32_t x, std::uint32_t y) const;

    std::uint32_t width_, words_per_row_, rows_ = 0;
    std::vector<std::uint64_t> bits_;
};

struct PackItem {
    std::uint32_t mask = 0;   // index into the masks
    std::uint32_t group = 0;  // items of one group share a page if an empty page can hold them
};

struct PackSpot {
    std::uint32_t page = 0, x = 0, y = 0;
};

struct PackPage {
    std::uint32_t width = 0, height = 0;
    std::uint64_t used = 0;
};

struct Packing {
    std::vector<PackSpot> spots;  // beside the items
    std::vector<PackPage> pages;
    bool complete = false;  // false: cancelled, or what was asked does not fit
};

// As many pages as it takes, none wider or higher than `max_page`; sizes are multiples of 4 where that allows it.
// Precondition: items ordered by group; no mask larger than max_page.
Packing pack(std::span<const ChartMask> masks, std::span<const PackItem> items, std::uint32_t max_page,
             const std::function<bool()>& cancelled);

// All on one page of this size, or not complete.
Packing pack_one_page(std::span<const ChartMask> masks, std::span<const PackItem> items, std::uint32_t width,
                      std::uint32_t height, const std::function<bool()>& cancelled);

}  // namespace lumel
