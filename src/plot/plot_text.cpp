#include "plot/plot_text.h"

#include <stb_easy_font.h>

#include <algorithm>

namespace lumel {

std::vector<TextBox> text_boxes(const std::string& words) {
    struct Corner {
        float x, y, z;
        unsigned char color[4];
    };
    constexpr std::size_t kBytesPerCharacter = 1024;  // 270 on average, says the header
    std::vector<Corner> corners(words.size() * kBytesPerCharacter / sizeof(Corner) + 4);
    std::string text = words;  // the header takes it as writable
    const int quads = stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(Corner)));
    std::vector<TextBox> out;
    for (int q = 0; q < quads; ++q) {
        const Corner& low = corners[4 * static_cast<std::size_t>(q)];
        const Corner& high = corners[4 * static_cast<std::size_t>(q) + 2];
        out.push_back({{low.x, low.y}, {high.x, high.y}});
    }
    return out;
}

float text_width(const std::string& words) {
    float width = 0.0f;
    for (const TextBox& box : text_boxes(words)) width = std::max(width, box.high.x);
    return width;
}

}  // namespace lumel
