// The closed forms that other tests rely on, against each other and published values (Howell's catalogue).
#include "support/closed_forms.h"

#include <gtest/gtest.h>

namespace lumel::closed_form {
namespace {

constexpr double kDigits = 1e-12;
const Vec kUp{0, 0, 1};

// Rectangle facing down at height h over the origin; half edges a along x and b along y.
double overhead(Vec point, double a, double b, double h, Vec center = {}) {
    return rectangle_light(point, kUp, center + Vec{0, 0, h}, {0, b, 0}, {a, 0, 0}, 1.0 / kPi);
}

TEST(ClosedForms, PointToRectangle) {
    EXPECT_NEAR(overhead({}, 0.5, 0.5, 1, {0.5, 0.5, 0}), 0.13853160599489298, kDigits);
    EXPECT_NEAR(overhead({}, 0.5, 0.5, 1), 0.23945647046077354, kDigits);
    EXPECT_NEAR(overhead({}, 1, 1, 0.25), 0.9514241225854796, kDigits);
    // From behind it is dark.
    EXPECT_EQ(rectangle_light({}, kUp, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1.0), 0.0);
}

TEST(ClosedForms, PointToPerpendicularWall) {
    // A wall in the plane x = 0.5, one high and two wide, facing the point at the origin.
    const auto wall = [](double y_center) {
        return rectangle_light({}, kUp, {0.5, y_center, 0.5}, {0, 0, 0.5}, {0, 1, 0}, 1.0 / kPi);
    };
    EXPECT_NEAR(wall(1.0), 0.13548839696490272, kDigits);
    EXPECT_NEAR(wall(0.0), 0.24853781982997455, kDigits);
    // The part below the horizon adds nothing.
    EXPECT_NEAR(rectangle_light({}, kUp, {0.5, 0, 0}, {0, 0, 1}, {0, 1, 0}, 1.0 / kPi), wall(0.0), kDigits);
}

TEST(ClosedForms, PointToDiscAndSphere) {
    EXPECT_NEAR(parallel_disc_light(1, 2, 0, 1 / kPi), 0.2, kDigits);
    EXPECT_NEAR(sphere_light({}, kUp, {0, 0, 3}, 1, 1 / kPi), 1.0 / 9, kDigits);
    EXPECT_NEAR(sphere_light({}, {std::sqrt(0.75), 0, 0.5}, {0, 0, 3}, 1, 1 / kPi), 0.5 / 9, kDigits);
}

TEST(ClosedForms, CapCutByTheHorizon) {
    EXPECT_NEAR(cap(0.5, 0.1), kPi * 0.0427127369826, 1e-11);
    EXPECT_NEAR(cap(0.5, -0.2), kPi * 0.0093458323558, 1e-11);
    EXPECT_NEAR(cap(1.0, 0.4), kPi * 0.7, kDigits);  // a lune between two hemispheres
    EXPECT_EQ(cap(0.5, -0.5), 0.0);
    EXPECT_NEAR(cap(0.5, 0.5 - 1e-9), kPi * 0.125, 1e-8);  // continuous where it touches the horizon
}

TEST(ClosedForms, FacingRectangles) {
    EXPECT_NEAR(parallel_rectangles(1, 1, 1), 0.19982489569838746, kDigits);
    EXPECT_NEAR(parallel_rectangles(2, 1, 0.5), 0.5089886690414376, kDigits);
    EXPECT_NEAR(parallel_rectangles(1, 1, 0.1), 0.8269945223972565, kDigits);
}

TEST(ClosedForms, FormFactorIsTheMeanOverTheReceiver) {
    constexpr int kSteps = 200;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j)
            sum += overhead({(i + 0.5) / kSteps - 0.5, (j + 0.5) / kSteps - 0.5, 0}, 0.5, 0.5, 1);
    EXPECT_NEAR(sum / (kSteps * kSteps), parallel_rectangles(1, 1, 1), 1e-6);  // midpoint rule: 1/24 h^2 f''
}

// A disc from off its axis, against a polygon of many corners.
TEST(ClosedForms, DiscIsThePolygonOfManyCorners) {
    std::vector<Vec> corners;
    constexpr int kCorners = 20000;
    for (int i = 0; i < kCorners; ++i) {
        const double phi = -2 * kPi * i / kCorners;  // counter-clockwise seen from below
        corners.push_back({0.8 * std::cos(phi), 0.8 * std::sin(phi), 1.5});
    }
    for (const double offset : {0.0, 0.5, 0.8, 3.0})
        EXPECT_NEAR(polygon_light({offset, 0, 0}, kUp, corners, 1.0), parallel_disc_light(0.8, 1.5, offset, 1.0), 1e-7);
}

}  // namespace
}  // namespace lumel::closed_form
