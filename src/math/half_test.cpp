#include "math/half.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumel {
namespace {

TEST(Half, RoundsAsTheStandardDoes) {
    EXPECT_EQ(round_to_half(1.0f), 1.0f);
    EXPECT_EQ(round_to_half(1.0f + 0x1p-11f), 1.0f) << "tie to even";
    EXPECT_EQ(round_to_half(1.0f + 0x3p-11f), 1.0f + 0x1p-9f) << "tie to even";
    EXPECT_EQ(round_to_half(-3.14159274f), -3.140625f);
    EXPECT_EQ(round_to_half(1e6f), 65504.0f);
    EXPECT_EQ(round_to_half(0x1p-24f), 0x1p-24f) << "the smallest";
    EXPECT_EQ(round_to_half(0x1p-26f), 0.0f);
    EXPECT_EQ(round_to_half(0x3p-25f), 0x1p-23f) << "tie to even below 2^-14";
    EXPECT_EQ(round_to_half(NAN), 0.0f);
}

// Every number that a half holds is its own nearest.
TEST(Half, HoldsItsOwnCodes) {
    for (std::uint32_t code = 0; code < 0x7C00u; ++code) {
        const float value = half_to_float(static_cast<std::uint16_t>(code));
        ASSERT_EQ(round_to_half(value), value) << code;
        ASSERT_EQ(half_to_float(static_cast<std::uint16_t>(code | 0x8000u)), -value) << code;
    }
    EXPECT_EQ(half_to_float(0x3C00), 1.0f);
    EXPECT_EQ(half_to_float(0x7BFF), kLargestHalf);
    EXPECT_TRUE(std::isinf(half_to_float(0x7C00)));
    EXPECT_TRUE(std::isnan(half_to_float(0x7C01)));
}

TEST(Half, EveryFiniteCodeIsThatOfItsNumber) {
    for (std::uint32_t code = 0; code < 0x10000; ++code) {
        if ((code & 0x7C00u) == 0x7C00u) continue;  // infinities and NaN
        ASSERT_EQ(half_code(half_to_float(static_cast<std::uint16_t>(code))), code);
    }
}

}  // namespace
}  // namespace lumel
