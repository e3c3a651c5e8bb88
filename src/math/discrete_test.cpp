#include "math/discrete.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/statistics.h"

namespace lumel {
namespace {

std::vector<std::uint32_t> shares(const std::vector<double>& weights, std::size_t guaranteed) {
    std::vector<std::uint32_t> ends(weights.size());
    share_units(weights, guaranteed, ends);
    return ends;
}

TEST(ShareUnits, GivesEveryItemItsShareWithinTwoUnits) {
    const std::vector<double> weights{1, 0, 5, 2, 0.001, 1e6, 3};
    const auto ends = shares(weights, 0);
    double total = 0;
    for (const double w : weights) total += w;
    for (std::size_t i = 0; i < weights.size(); ++i)
        EXPECT_NEAR(units_of(ends, i), weights[i] / total * kUnits, 1.0) << i;  // both ends are rounded down
    EXPECT_EQ(ends.back(), kUnits);
}

TEST(ShareUnits, GuaranteedItemsGetAUnitOthersMayGetNone) {
    std::vector<double> weights(1000, 1e-12);
    weights[999] = 1e12;
    const auto ends = shares(weights, 500);
    for (std::size_t i = 0; i < 500; ++i) EXPECT_EQ(units_of(ends, i), 1u) << i;
    for (std::size_t i = 500; i < 999; ++i) EXPECT_EQ(units_of(ends, i), 0u) << i;
    EXPECT_EQ(ends.back(), kUnits);
}

TEST(ShareUnits, EqualSharesWhereAllWeightsAreZero) {
    const auto ends = shares({0, 0, 0, 0}, 4);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(units_of(ends, i), kUnits / 4) << i;
}

TEST(ShareUnits, ItemsOfNoWeightGetNone) {
    const auto ends = shares({0, 0.1, 0, 0.3, 0}, 0);
    EXPECT_EQ(units_of(ends, 0), 0u);
    EXPECT_EQ(units_of(ends, 2), 0u);
    EXPECT_EQ(units_of(ends, 4), 0u);
}

// Infinite power once became shares that are no number, and a choice beyond the end of the list.
TEST(ShareUnitsDeathTest, RefusesWeightsWithoutASum) {
    EXPECT_DEATH(shares({1, std::numeric_limits<double>::infinity()}, 0), "");
}

// The claim of the header: over all 2^24 values that a random float can take, each item is chosen exactly as often as
// its units say. Counted here at the ends of every interval.
TEST(Choose, ChoosesEachItemExactlyAsOftenAsItSays) {
    test::Random random(1);
    std::vector<double> weights(300);
    for (double& w : weights) w = random.unit() < 0.2f ? 0.0 : random.unit();
    const auto ends = shares(weights, 100);
    std::uint32_t unit = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (units_of(ends, i) == 0) continue;
        for (const std::uint32_t k : {unit, ends[i] - 1}) {
            const Choice c = choose(ends, static_cast<float>(k) * 0x1p-24f);
            EXPECT_EQ(c.index, i);
            EXPECT_EQ(c.units, units_of(ends, i));
            EXPECT_GT(c.fraction, 0.0f);
            EXPECT_LT(c.fraction, 1.0f);
        }
        unit = ends[i];
    }
    EXPECT_EQ(unit, kUnits);
}

TEST(Choose, TheFractionIsAFreshNumber) {
    const auto ends = shares({1, 2, 5}, 3);
    test::Random random(2);
    test::Moments fraction;
    for (int i = 0; i < 100000; ++i)
        if (const Choice c = choose(ends, random.unit()); c.index == 1) fraction.add(c.fraction);
    EXPECT_TRUE(test::mean_agrees(fraction, 0.5, 1e-4));
    EXPECT_NEAR(fraction.variance(), 1.0 / 12, 0.002);  // 25,000 samples: standard error 0.0005
}

}  // namespace
}  // namespace lumel
