#include "path/light_rate.h"

#include <gtest/gtest.h>

#include <set>

#include "support/statistics.h"

namespace lumel {
namespace {

TEST(LightRate, OneToOneIsEveryPathByItsOwnNumber) {
    for (std::uint32_t index = 0; index < 300; ++index) {
        EXPECT_TRUE(LightRate{}.takes(index));
        EXPECT_EQ(LightRate{}.number(index), index);
    }
    EXPECT_EQ(LightRate{}.share(), 1.0f);
}

// From the first path on, and after a few that all had one.
TEST(LightRate, NumbersOfEveryOtherFollowOneAnother) {
    for (const std::uint32_t from : {0u, 4u, 64u}) {
        const LightRate rate{2, from};
        std::uint32_t next = from;
        for (std::uint32_t index = from; index < from + 1024; ++index)
            if (rate.takes(index)) {
                EXPECT_EQ(rate.number(index), next++);
            }
        EXPECT_EQ(next, from + 512);
    }
}

// Paths start from a texel's 64 points in turn: after two rounds of them each point has had its sample.
TEST(LightRate, EveryOtherMeetsAllPointsOfATexel) {
    std::set<std::uint32_t> points;
    for (std::uint32_t index = 0; index < 128; ++index)
        if (LightRate{2, 0}.takes(index)) points.insert(index % 64);
    EXPECT_EQ(points.size(), 64u);
}

LightRate rate_of(float light_noise, float path_noise) {
    test::Random random(7);
    LightRateStatistics statistics;
    for (int i = 0; i < 512; ++i) {
        // That texels differ is no noise.
        const auto texel = static_cast<float>(i / 8);
        const float light = 10.0f * texel + light_noise * (random.unit() - 0.5f);
        statistics.add(light, texel + path_noise * (random.unit() - 0.5f));
        if (i % 8 == 7) statistics.end_texel();
    }
    return statistics.rate(4);
}

TEST(LightRate, SpendsWhereTheNoiseIs) {
    EXPECT_EQ(rate_of(0.1f, 1.0f).paths, 2u);
    EXPECT_EQ(rate_of(0.1f, 1.0f).from, 4u);
    EXPECT_EQ(rate_of(1.0f, 1.0f).paths, 1u);
    EXPECT_EQ(rate_of(1.0f, 0.1f).paths, 1u);
    EXPECT_EQ(LightRateStatistics{}.rate(4).paths, 1u) << "nothing is known";
}

}  // namespace
}  // namespace lumel
