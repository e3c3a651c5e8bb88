#include "math/frame.h"

#include <gtest/gtest.h>

#include "support/statistics.h"

namespace lumel {
namespace {

void expect_orthonormal(Vec3 n) {
    const Frame f(n);
    const auto dot_double = [](Vec3 a, Vec3 b) { return double{a.x} * b.x + double{a.y} * b.y + double{a.z} * b.z; };
    // A few roundings of float; near z = -0 the axes' entries reach 1/(1+z) times one rounding of n.
    constexpr double kTolerance = 1e-6;
    ASSERT_NEAR(dot_double(f.tangent, f.tangent), 1.0, kTolerance);
    ASSERT_NEAR(dot_double(f.bitangent, f.bitangent), 1.0, kTolerance);
    ASSERT_NEAR(dot_double(f.tangent, f.bitangent), 0.0, kTolerance);
    ASSERT_NEAR(dot_double(f.tangent, n), 0.0, kTolerance);
    ASSERT_NEAR(dot_double(f.bitangent, n), 0.0, kTolerance);
    ASSERT_GT(dot_double(cross(f.tangent, f.bitangent), n), 0.999) << "left-handed";
}

TEST(Frame, IsOrthonormalAndRightHandedForEveryNormal) {
    test::Random random(1);
    for (int i = 0; i < 100000; ++i) {
        const float x = random.unit() - 0.5f, y = random.unit() - 0.5f, z = random.unit() - 0.5f;
        expect_orthonormal(normalize({x, y, z}));
    }
    for (const float s : {-1.0f, 1.0f}) {
        expect_orthonormal({s, 0, 0});
        expect_orthonormal({0, s, 0});
        expect_orthonormal({0, 0, s});
        expect_orthonormal(normalize({1, 0, s * 1e-8f}));
        expect_orthonormal(normalize({1e-5f, 1e-5f, s}));
    }
    expect_orthonormal({1, 0, -0.0f});
}

TEST(Frame, ToLocalUndoesToWorld) {
    const Frame frame(normalize({0.3f, -0.5f, -0.8f}));
    const Vec3 v{0.2f, -0.7f, 0.4f};
    const Vec3 back = frame.to_local(frame.to_world(v));
    EXPECT_NEAR(length(back - v), 0.0, 1e-6);  // a few roundings of values below 1
    EXPECT_EQ(frame.to_world({0, 0, 1}), frame.normal);
}

TEST(UnitOr, TakesAnyLengthButZero) {
    for (const float length : {1e-40f, 1e-20f, 1.0f, 1e20f, 6e37f}) {
        const Vec3 unit = unit_or(Vec3{3, 0, -4} * length, Vec3{});
        // 1e-40 is stored with five digits.
        EXPECT_NEAR(unit.x, 0.6f, 1e-4f) << length;
        EXPECT_NEAR(unit.z, -0.8f, 1e-4f) << length;
    }
    EXPECT_EQ(unit_or({}, {0, 1, 0}), (Vec3{0, 1, 0}));
}

}  // namespace
}  // namespace lumel
