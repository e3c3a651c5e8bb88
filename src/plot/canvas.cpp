#include "plot/canvas.h"

#include <algorithm>
#include <cmath>

#include "plot/plot_text.h"

namespace lumel {

Canvas::Canvas(std::uint32_t width, std::uint32_t height, Vec3 color) : image_(width, height, 3) {
    for (std::size_t i = 0; i < image_.data.size(); ++i) image_.data[i] = color[i % 3];
}

template <class Coverage>
void Canvas::for_pixels(Vec2 low, Vec2 high, const Coverage& coverage, Vec3 color) {
    const auto bound = [](float v, std::uint32_t limit) {
        return static_cast<std::uint32_t>(std::clamp(std::ceil(v - 0.5f), 0.0f, static_cast<float>(limit)));
    };
    for (std::uint32_t y = bound(low.y, image_.height); y < bound(high.y, image_.height); ++y)
        for (std::uint32_t x = bound(low.x, image_.width); x < bound(high.x, image_.width); ++x) {
            const float share = coverage({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
            float* pixel = image_.at(x, y);
            for (std::size_t c = 0; c < 3; ++c) pixel[c] += (color[c] - pixel[c]) * share;
        }
}

void Canvas::line(Vec2 a, Vec2 b, float width, Vec3 color) {
    const float reach = 0.5f * width + 1.0f;
    for_pixels(
        {std::min(a.x, b.x) - reach, std::min(a.y, b.y) - reach},
        {std::max(a.x, b.x) + reach, std::max(a.y, b.y) + reach},
        [&](Vec2 p) {
            const Vec2 along = b - a;
            const float squared = dot(along, along);
            const float t = squared > 0.0f ? std::clamp(dot(p - a, along) / squared, 0.0f, 1.0f) : 0.0f;
            const Vec2 off = p - (a + along * t);
            return std::clamp(0.5f * width + 0.5f - std::sqrt(dot(off, off)), 0.0f, 1.0f);
        },
        color);
}

void Canvas::box(Vec2 low, Vec2 high, Vec3 color) {
    for_pixels(
        low, high, [](Vec2) { return 1.0f; }, color);
}

void Canvas::text(Vec2 at, const std::string& words, Vec3 color, bool upwards) {
    for (const TextBox& b : text_boxes(words)) {
        const Vec2 low = b.low * kTextScale, high = b.high * kTextScale;
        if (upwards)
            box({at.x + low.y, at.y - high.x}, {at.x + high.y, at.y - low.x}, color);
        else
            box(at + low, at + high, color);
    }
}

void Canvas::paste(const Image& image, std::uint32_t x, std::uint32_t y) {
    if (x >= image_.width || y >= image_.height) return;
    const std::uint32_t width = std::min(image.width, image_.width - x);
    for (std::uint32_t row = 0; row < std::min(image.height, image_.height - y); ++row)
        std::copy_n(image.at(0, row), std::size_t{3} * width, image_.at(x, y + row));
}

float text_length(const std::string& words) { return kTextScale * text_width(words); }

}  // namespace lumel
