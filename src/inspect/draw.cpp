#include "inspect/draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "plot/canvas.h"

namespace lumel {
namespace {

constexpr std::uint32_t kSmallestWidth = 1024;  // which the words of a legend need
constexpr std::uint32_t kMagnifiedEdge = 512;   // of small pages, pixels
constexpr float kMargin = 12, kRowHeight = 26;  // pixels
constexpr float kBarHeight = 18, kSwatch = 16;
constexpr Vec3 kPaper{0.97f, 0.97f, 0.97f}, kInk{0.12f, 0.12f, 0.14f};
constexpr int kTicks = 5;
// Of colours that are seen at a grazing angle: kinds of texels alone do not show where one surface ends.
constexpr float kGrazing = 0.55f;

std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

struct Swatch {
    std::string name;
    Vec3 color;
};

// Swatches in rows of a given width.
std::vector<std::vector<Swatch>> rows_of(const std::vector<Swatch>& swatches, float width) {
    std::vector<std::vector<Swatch>> rows;
    float x = width;
    for (const Swatch& swatch : swatches) {
        const float needed = kSwatch + 8 + text_length(swatch.name) + 20;
        if (rows.empty() || x + needed > width) {
            rows.emplace_back();
            x = 0.0f;
        }
        rows.back().push_back(swatch);
        x += needed;
    }
    return rows;
}

bool has_bar(ColorRule rule) { return rule != ColorRule::category && rule != ColorRule::identity; }

// What the red, green and blue of a scale of vectors are.
std::string channels_text(const TexelLayer& layer, const ColorScale& scale) {
    if (layer.channels.size() != 3) return {};
    if (layer.rule == ColorRule::place) {
        const Vec3 o = scale.origin();
        return "red X, green Y, blue Z from (" + number_text(o.x) + ", " + number_text(o.y) + ", " + number_text(o.z) +
               ") on";
    }
    if (layer.channels[0] == "X") return "red X, green Y, blue Z";
    return {};
}

void draw_bar(Canvas& canvas, const TexelLayer& layer, const ColorScale& scale, Vec2 at, float width) {
    for (float x = 0; x < width; x += 1) {
        const float t = (x + 0.5f) / width;
        Vec3 value{scale.value_at(t), scale.value_at(t), scale.value_at(t)};
        if (layer.rule == ColorRule::place) value += scale.origin();
        const std::array<float, 3> channels{value.x, value.y, value.z};
        canvas.box({at.x + x, at.y}, {at.x + x + 1, at.y + kBarHeight}, scale.color(channels));
    }
    for (int k = 0; k < kTicks; ++k) {
        const float t = static_cast<float>(k) / static_cast<float>(kTicks - 1);
        std::string label = number_text(static_cast<double>(scale.value_at(t)));
        if (k == kTicks - 1 && !layer.unit.empty() && layer.unit != "1") label += " " + layer.unit;
        const float x = at.x + t * width, length = text_length(label);
        canvas.line({x, at.y + kBarHeight}, {x, at.y + kBarHeight + 5}, 1.0f, kInk);
        canvas.text({std::clamp(x - 0.5f * length, at.x, at.x + width - length), at.y + kBarHeight + 8}, label, kInk);
    }
}

// The picture with a legend below it.
Image with_legend(const Image& picture, const TexelLayer& layer, const ColorScale& scale, const std::string& about,
                  const std::vector<Swatch>& swatches) {
    const std::uint32_t width = std::max(picture.width, kSmallestWidth);
    const float inner = static_cast<float>(width) - 2 * kMargin;
    std::vector<std::string> words{layer.name + ": " + layer.what};
    std::string more = about;
    if (const std::string channels = channels_text(layer, scale); !channels.empty())
        more += (more.empty() ? "" : "; ") + channels;
    if (layer.rule == ColorRule::light)
        more +=
            (more.empty() ? "" : "; ") + std::string("exposure ") + number_text(static_cast<double>(scale.exposure()));
    if (layer.rule == ColorRule::identity) more += (more.empty() ? "" : "; ") + std::string("a colour each");
    if (!more.empty()) words.push_back(more);
    const auto rows = rows_of(swatches, inner);
    const float bar = has_bar(layer.rule) ? kBarHeight + 34 : 0;
    const float height = 2 * kMargin + kRowHeight * static_cast<float>(words.size() + rows.size()) + bar;

    Canvas canvas(width, picture.height + static_cast<std::uint32_t>(height), kPaper);
    canvas.paste(picture, 0, 0);
    float y = static_cast<float>(picture.height) + kMargin;
    for (const std::string& line : words) {
        canvas.text({kMargin, y}, line, kInk);
        y += kRowHeight;
    }
    if (bar > 0) draw_bar(canvas, layer, scale, {kMargin, y}, inner);
    y += bar;
    for (const auto& row : rows) {
        float x = kMargin;
        for (const Swatch& swatch : row) {
            canvas.box({x - 1, y - 1}, {x + kSwatch + 1, y + kSwatch + 1}, kInk);
            canvas.box({x, y}, {x + kSwatch, y + kSwatch}, swatch.color);
            canvas.text({x + kSwatch + 8, y}, swatch.name, kInk);
            x += kSwatch + 8 + text_length(swatch.name) + 20;
        }
        y += kRowHeight;
    }
    return std::move(canvas).finish();
}

std::vector<Swatch> categories_of(const TexelLayer& layer) {
    std::vector<Swatch> out;
    for (const Category& category : layer.categories) out.push_back({category.name, category.color});
    return out;
}

bool is_finite(std::span<const float> value) {
    return std::ranges::all_of(value, [](float v) { return std::isfinite(v); });
}

Image magnified(const Image& image) {
    const std::uint32_t edge = std::max({image.width, image.height, 1u});
    const std::uint32_t factor = std::max(1u, kMagnifiedEdge / edge);
    if (factor == 1) return image;
    Image out(image.width * factor, image.height * factor, image.channels);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            std::copy_n(image.at(x / factor, y / factor), image.channels, out.at(x, y));
    return out;
}

// Colours of numbers; whether one was not finite.
struct Painter {
    const ColorScale& scale;
    bool met_not_finite = false;

    Vec3 color(const Image& values, std::size_t pixel) {
        const std::span<const float> value(&values.data[pixel * values.channels], values.channels);
        if (is_finite(value)) return scale.color(value);
        met_not_finite = true;
        return kNotFiniteColor;
    }
    void add_swatch(std::vector<Swatch>& swatches) const {
        if (met_not_finite) swatches.push_back({"not a number", kNotFiniteColor});
    }
};

}  // namespace

Image draw_page(const TexelLayer& layer, const LayerPage& page, const ColorScale& scale, const std::string& about) {
    Image picture(page.values.width, page.values.height, 3);
    Painter painter{scale};
    for (std::size_t i = 0; i < page.presence.size(); ++i) {
        const Vec3 color = page.presence[i] == Presence::none ? kEmptyColor : painter.color(page.values, i);
        std::copy_n(&color.x, 3, &picture.data[3 * i]);
    }
    std::vector<Swatch> swatches = categories_of(layer);
    swatches.push_back({"no texel", kEmptyColor});
    painter.add_swatch(swatches);
    return with_legend(magnified(picture), layer, scale, about, swatches);
}

Image draw_view(const TexelLayer& layer, const LayerView& view, const ColorScale& scale, const std::string& about) {
    Image picture(view.values.width, view.values.height, 3);
    Painter painter{scale};
    const bool is_shaded = !layer.blends();
    for (std::size_t i = 0; i < view.shown.size(); ++i) {
        const float shade = is_shaded ? kGrazing + (1.0f - kGrazing) * view.facing[i] : 1.0f;
        const Vec3 color = [&] {
            switch (view.shown[i]) {
                case Shown::texel: return painter.color(view.values, i) * shade;
                case Shown::empty: return kEmptyColor;
                case Shown::no_lightmap: return kNoLightmapColor;
                case Shown::back: return kBackColor;
                case Shown::nothing: return kNothingColor;
            }
            return kNothingColor;
        }();
        std::copy_n(&color.x, 3, &picture.data[3 * i]);
    }
    std::vector<Swatch> swatches = categories_of(layer);
    swatches.insert(swatches.end(), {{"back face", kBackColor},
                                     {"no texel", kEmptyColor},
                                     {"no lightmap", kNoLightmapColor},
                                     {"no surface", kNothingColor}});
    painter.add_swatch(swatches);
    return with_legend(picture, layer, scale, about + (is_shaded ? "; darker at an angle" : ""), swatches);
}

}  // namespace lumel
