// A picture to draw on: strokes, boxes, words. RGB, sRGB-coded 0..1; y runs down.
#pragma once

#include <cstdint>
#include <string>

#include "image/image.h"
#include "lumel/vec.h"

namespace lumel {

class Canvas {
public:
    // Of one colour.
    Canvas(std::uint32_t width, std::uint32_t height, Vec3 color);

    // A stroke with round ends; its edge is a pixel wide.
    void line(Vec2 a, Vec2 b, float width, Vec3 color);
    void dot_at(Vec2 p, float radius, Vec3 color) { line(p, p, 2.0f * radius, color); }
    void box(Vec2 low, Vec2 high, Vec3 color);
    // ASCII. `at`: the upper left corner. Upwards: turned by a quarter, from `at` towards smaller y.
    void text(Vec2 at, const std::string& words, Vec3 color, bool upwards = false);
    // Pixels of another picture, its upper left corner at (x, y); what lies beyond the canvas is left out.
    void paste(const Image& image, std::uint32_t x, std::uint32_t y);
    [[nodiscard]] Image finish() && { return std::move(image_); }

private:
    // Blends the colour over the pixels whose centres lie in the box, by coverage(centre).
    template <class Coverage>
    void for_pixels(Vec2 low, Vec2 high, const Coverage& coverage, Vec3 color);

    Image image_;
};

inline constexpr float kTextScale = 2.0f;  // pixels of a stroke of the letters on a canvas

// Pixels that words take on a canvas.
float text_length(const std::string& words);

}  // namespace lumel
