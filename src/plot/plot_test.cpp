#include "plot/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "plot/label.h"
#include "plot/plot_text.h"

namespace lumel {
namespace {

TEST(Plot, AxesRunFromOneRoundNumberToAnother) {
    const auto range = [](std::vector<double> values) {
        const LogRange r = log_range(values);
        return std::pair(r.low, r.high);
    };
    const auto expect = [](std::pair<double, double> got, double low, double high) {
        EXPECT_NEAR(got.first, low, 1e-9 * low);
        EXPECT_NEAR(got.second, high, 1e-9 * high);
    };
    expect(range({0.3, 45.0, 7.0}), 0.2, 50.0);
    expect(range({1.0, 10.0}), 1.0, 10.0);
    expect(range({1e-3, 1.01}), 1e-3, 2.0);
    expect(range({5.0}), 5.0, 50.0);
    expect(range({-1.0, 0.0, 2.5, NAN}), 2.0, 5.0);  // what has no place does not count
    expect(range({}), 1.0, 10.0);
    const std::vector<double> ticks = log_ticks({0.02, 1.0});
    ASSERT_EQ(ticks.size(), 6u);
    for (std::size_t i = 0; i < ticks.size(); ++i)
        EXPECT_NEAR(ticks[i], (std::vector{0.02, 0.05, 0.1, 0.2, 0.5, 1.0})[i], 1e-9);
    EXPECT_EQ(log_ticks({1e-5, 1.0}).size(), 6u);  // the powers alone
}

bool is_colored(const Image& image, double x, double y) {
    const float* p = image.at(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    return std::fabs(p[0] - p[2]) > 0.3f;
}

// A falling line: its colour is at the upper left and the lower right end of the frame and in the middle between them,
// not at the other ends.
TEST(Plot, PointsAreWhereTheirLogarithmsAre) {
    const Image image =
        draw_plot({{"title", "x", "y", {{"line", {{1.0, 100.0}, {0.0, 50.0}, {100.0, 1.0}, {-1.0, 5.0}}}}}});
    const double left = 112, right = image.width - 24.0, top = 44, bottom = image.height - 60.0;
    EXPECT_TRUE(is_colored(image, left, top));
    EXPECT_TRUE(is_colored(image, right, bottom));
    EXPECT_TRUE(is_colored(image, 0.5 * (left + right), 0.5 * (top + bottom)));
    EXPECT_FALSE(is_colored(image, left, bottom));
    EXPECT_FALSE(is_colored(image, 0.75 * left + 0.25 * right, 0.25 * top + 0.75 * bottom));
}

TEST(Plot, PanelsStandSideBySide) {
    const PlotPanel panel{"p", "x", "y", {{"line", {{1, 1}}}}};
    const Image one = draw_plot({panel}), three = draw_plot({panel, panel, panel});
    EXPECT_EQ(three.width, 2 * one.width);
    EXPECT_EQ(three.height, 2 * one.height);
    EXPECT_EQ(draw_plot({panel, {"empty", "x", "y", {}}}).width, 2 * one.width);
}

TEST(Plot, WordsHaveBoxes) {
    EXPECT_TRUE(text_boxes("").empty());
    EXPECT_GT(text_boxes("relMSE").size(), 10u);
    EXPECT_GT(text_width("CPU seconds"), 2.0f * text_width("CPU"));
}

TEST(Label, IsInTheLowerCornerOfItsPart) {
    constexpr std::uint32_t kWidth = 64, kHeight = 32, kLeft = 32;
    std::vector<std::uint8_t> rgb(std::size_t{kWidth} * kHeight * 3, 128);
    draw_label(rgb, kWidth, kLeft, "L");
    const auto at = [&](std::uint32_t x, std::uint32_t y) { return int{rgb[3 * (y * kWidth + x)]}; };
    EXPECT_EQ(at(kLeft - 1, kHeight - 1), 128);
    EXPECT_EQ(at(kLeft, kHeight - 1), 0);
    EXPECT_EQ(at(kLeft, 0), 128);
    EXPECT_EQ(at(kWidth - 1, kHeight - 1), 128) << "no wider than its words";
    EXPECT_GT(std::ranges::count(rgb, 255), 0);
}

TEST(Label, IsCutWhereItDoesNotFit) {
    std::vector<std::uint8_t> rgb(4 * 4 * 3, 128);
    draw_label(rgb, 4, 2, "path-traced");
    for (std::size_t y = 0; y < 4; ++y) EXPECT_EQ(rgb[3 * (4 * y + 1)], 128) << y;
}

}  // namespace
}  // namespace lumel
