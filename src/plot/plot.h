// Line charts with logarithmic axes, drawn into a picture: one panel per scene, one line per method.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"

namespace lumel {

struct PlotLine {
    std::string name;
    std::vector<std::array<double, 2>> points;  // (x, y); those that are not positive have no place and are left out
};

struct PlotPanel {
    std::string title, x_label, y_label;
    std::vector<PlotLine> lines;
};

// The exponents of the decades (fractions allowed: 1, 2 and 5 times a power of ten) that hold all positive values.
struct LogRange {
    double low = 1.0, high = 10.0;  // values, not exponents
};
LogRange log_range(const std::vector<double>& values);
// 1, 2 and 5 times powers of ten within the range; the powers alone where it is wide.
std::vector<double> log_ticks(LogRange range);

// Panels side by side, at most `columns` in a row. RGB, sRGB-coded 0..1. Lines of the same name have the same colour
// everywhere.
Image draw_plot(const std::vector<PlotPanel>& panels, std::size_t columns = 2);

}  // namespace lumel
