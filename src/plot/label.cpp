#include "plot/label.h"

#include <algorithm>

#include "base/check.h"
#include "plot/plot_text.h"

namespace lumel {
namespace {

constexpr std::uint32_t kMargin = 3, kLineHeight = 10;

}  // namespace

void draw_label(std::span<std::uint8_t> rgb, std::uint32_t width, std::uint32_t left, const std::string& words) {
    LUMEL_CHECK(width > 0 && rgb.size() % (std::size_t{width} * 3) == 0, width, rgb.size());
    const auto height = static_cast<std::uint32_t>(rgb.size() / (std::size_t{width} * 3));
    const auto fill = [&](std::uint32_t x0, std::uint32_t y0, std::uint32_t x1, std::uint32_t y1, std::uint8_t grey) {
        for (std::uint32_t y = y0; y < std::min(y1, height); ++y)
            for (std::uint32_t x = x0; x < std::min(x1, width); ++x)
                std::fill_n(&rgb[3 * (std::size_t{y} * width + x)], 3, grey);
    };
    const auto pixels = [](float strokes) { return static_cast<std::uint32_t>(strokes + 0.5f); };
    const std::uint32_t box = kLineHeight + 2 * kMargin, top = height > box ? height - box : 0;
    fill(left, top, left + pixels(text_width(words)) + 2 * kMargin, height, 0);
    const std::uint32_t x = left + kMargin, y = top + kMargin;
    for (const TextBox& b : text_boxes(words))
        fill(x + pixels(b.low.x), y + pixels(b.low.y), x + pixels(b.high.x), y + pixels(b.high.y), 255);
}

}  // namespace lumel
