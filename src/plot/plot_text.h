// Words as boxes, for plots. Based on: Sean Barrett's stb_easy_font.
#pragma once

#include <string>
#include <vector>

#include "lumel/vec.h"

namespace lumel {

struct TextBox {
    Vec2 low, high;  // in strokes: a capital letter is seven high; y runs down from the top of the line
};

// ASCII only.
std::vector<TextBox> text_boxes(const std::string& words);
float text_width(const std::string& words);

}  // namespace lumel
