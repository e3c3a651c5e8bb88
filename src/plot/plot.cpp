#include "plot/plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "lumel/vec.h"
#include "plot/canvas.h"

namespace lumel {
namespace {

constexpr std::uint32_t kPanelWidth = 720, kPanelHeight = 540;
constexpr float kLeft = 112, kRight = 24, kTop = 44, kBottom = 60;  // margins of the frame in its panel
constexpr Vec3 kInk{0.15f, 0.15f, 0.17f}, kGrid{0.88f, 0.88f, 0.90f};

// Colours that stay apart for colour-blind eyes (Okabe and Ito 2008).
constexpr std::array<Vec3, 7> kColors{{{0.00f, 0.45f, 0.70f},
                                       {0.90f, 0.60f, 0.00f},
                                       {0.00f, 0.62f, 0.45f},
                                       {0.80f, 0.40f, 0.00f},
                                       {0.80f, 0.47f, 0.65f},
                                       {0.34f, 0.71f, 0.91f},
                                       {0.30f, 0.30f, 0.30f}}};

constexpr double kSlack = 1e-9;  // powers of ten are rounded

double decade_of(double v) { return std::pow(10.0, std::floor(std::log10(v) + kSlack)); }

// The next of 1, 2, 5 times a power of ten.
double step_below(double v) {
    for (const double step : {5.0, 2.0})
        if (step * decade_of(v) <= v * (1 + kSlack)) return step * decade_of(v);
    return decade_of(v);
}
double step_above(double v) {
    for (const double step : {1.0, 2.0, 5.0})
        if (step * decade_of(v) >= v * (1 - kSlack)) return step * decade_of(v);
    return 10.0 * decade_of(v);
}

std::string tick_label(double value) {
    char text[32];
    std::snprintf(text, sizeof text, value > 0.9e-3 && value < 1e4 ? "%g" : "%.0e", value);
    return text;
}

bool drawable(const std::array<double, 2>& p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && p[0] > 0.0 && p[1] > 0.0;
}

// Values to pixels within one panel.
class Frame {
public:
    Frame(const PlotPanel& panel, Vec2 corner) : corner_(corner) {
        std::vector<double> x, y;
        for (const PlotLine& line : panel.lines)
            for (const auto& p : line.points)
                if (drawable(p)) {
                    x.push_back(p[0]);
                    y.push_back(p[1]);
                }
        x_ = log_range(x);
        y_ = log_range(y);
    }
    [[nodiscard]] float left() const { return corner_.x + kLeft; }
    [[nodiscard]] float right() const { return corner_.x + kPanelWidth - kRight; }
    [[nodiscard]] float top() const { return corner_.y + kTop; }
    [[nodiscard]] float bottom() const { return corner_.y + kPanelHeight - kBottom; }
    [[nodiscard]] float x(double value) const { return left() + (right() - left()) * place(value, x_); }
    [[nodiscard]] float y(double value) const { return bottom() + (top() - bottom()) * place(value, y_); }
    [[nodiscard]] LogRange x_range() const { return x_; }
    [[nodiscard]] LogRange y_range() const { return y_; }

private:
    static float place(double value, LogRange range) {
        return static_cast<float>(std::log(value / range.low) / std::log(range.high / range.low));
    }
    Vec2 corner_;
    LogRange x_, y_;
};

void draw_axes(Canvas& canvas, const PlotPanel& panel, const Frame& frame) {
    for (const double value : log_ticks(frame.x_range())) {
        canvas.line({frame.x(value), frame.top()}, {frame.x(value), frame.bottom()}, 1.0f, kGrid);
        const std::string label = tick_label(value);
        canvas.text({frame.x(value) - 0.5f * text_length(label), frame.bottom() + 8}, label, kInk);
    }
    for (const double value : log_ticks(frame.y_range())) {
        canvas.line({frame.left(), frame.y(value)}, {frame.right(), frame.y(value)}, 1.0f, kGrid);
        const std::string label = tick_label(value);
        canvas.text({frame.left() - 8 - text_length(label), frame.y(value) - 8}, label, kInk);
    }
    canvas.line({frame.left(), frame.top()}, {frame.left(), frame.bottom()}, 2.0f, kInk);
    canvas.line({frame.left(), frame.bottom()}, {frame.right(), frame.bottom()}, 2.0f, kInk);
    const float middle_x = 0.5f * (frame.left() + frame.right()), middle_y = 0.5f * (frame.top() + frame.bottom());
    canvas.text({middle_x - 0.5f * text_length(panel.title), frame.top() - 28}, panel.title, kInk);
    canvas.text({middle_x - 0.5f * text_length(panel.x_label), frame.bottom() + 34}, panel.x_label, kInk);
    canvas.text({frame.left() - kLeft + 4, middle_y + 0.5f * text_length(panel.y_label)}, panel.y_label, kInk, true);
}

void draw_line(Canvas& canvas, const PlotLine& line, const Frame& frame, Vec3 color) {
    const std::array<double, 2>* last = nullptr;
    for (const auto& p : line.points) {
        if (!drawable(p)) continue;
        const Vec2 at{frame.x(p[0]), frame.y(p[1])};
        if (last) canvas.line({frame.x((*last)[0]), frame.y((*last)[1])}, at, 2.5f, color);
        canvas.dot_at(at, 4.0f, color);
        last = &p;
    }
}

void draw_legend(Canvas& canvas, const PlotPanel& panel, const Frame& frame, const std::vector<Vec3>& colors) {
    float width = 0.0f;
    for (const PlotLine& line : panel.lines) width = std::max(width, text_length(line.name));
    const float left = frame.right() - width - 12;
    float y = frame.top() + 8;
    for (std::size_t i = 0; i < panel.lines.size(); ++i, y += 22) {
        canvas.box({left - 44, y - 4}, {frame.right() - 2, y + 18}, {1, 1, 1});
        canvas.line({left - 36, y + 8}, {left - 10, y + 8}, 2.5f, colors[i]);
        canvas.dot_at({left - 23, y + 8}, 4.0f, colors[i]);
        canvas.text({left, y}, panel.lines[i].name, kInk);
    }
}

}  // namespace

LogRange log_range(const std::vector<double>& values) {
    double low = 0.0, high = 0.0;
    for (const double v : values) {
        if (!(v > 0.0) || !std::isfinite(v)) continue;
        low = low == 0.0 ? v : std::min(low, v);
        high = std::max(high, v);
    }
    if (low == 0.0) return {};
    const LogRange range{step_below(low), step_above(high)};
    return range.low < range.high ? range : LogRange{range.low, 10.0 * range.low};
}

std::vector<double> log_ticks(LogRange range) {
    std::vector<double> out;
    const bool wide = range.high > 2000.0 * range.low;
    for (double decade = decade_of(range.low); decade <= range.high * (1 + kSlack); decade *= 10.0)
        for (const double step : {1.0, 2.0, 5.0}) {
            const double value = step * decade;
            if (wide && step != 1.0) continue;
            if (value >= range.low * (1 - kSlack) && value <= range.high * (1 + kSlack)) out.push_back(value);
        }
    return out;
}

Image draw_plot(const std::vector<PlotPanel>& panels, std::size_t columns) {
    columns = std::clamp<std::size_t>(columns, 1, std::max<std::size_t>(1, panels.size()));
    const std::size_t rows = (panels.size() + columns - 1) / columns;
    Canvas canvas(static_cast<std::uint32_t>(columns) * kPanelWidth, static_cast<std::uint32_t>(rows) * kPanelHeight,
                  {1, 1, 1});
    std::vector<std::string> names;
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const PlotPanel& panel = panels[i];
        const std::size_t left = i % columns * kPanelWidth, top = i / columns * kPanelHeight;
        const Frame frame(panel, {static_cast<float>(left), static_cast<float>(top)});
        draw_axes(canvas, panel, frame);
        std::vector<Vec3> colors;
        for (const PlotLine& line : panel.lines) {
            const auto known = std::ranges::find(names, line.name);
            const auto index = static_cast<std::size_t>(known - names.begin());
            if (known == names.end()) names.push_back(line.name);
            colors.push_back(kColors[index % kColors.size()]);
            draw_line(canvas, line, frame, colors.back());
        }
        draw_legend(canvas, panel, frame, colors);
    }
    return std::move(canvas).finish();
}

}  // namespace lumel
