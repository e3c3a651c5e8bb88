// Times and rates of stages that come and go.
#include "stage_clock.h"

#include <gtest/gtest.h>

namespace lumel::cli {
namespace {

StageClock::Time at(int milliseconds) { return StageClock::Time{} + std::chrono::milliseconds(milliseconds); }

TEST(StageClock, TimeIsThatSinceTheLastReport) {
    StageClock clock(at(500));
    EXPECT_DOUBLE_EQ(clock.report("load", 0.25, at(1500)).seconds, 1.0);
    const Stage& stage = clock.report("load", 0.5, at(2500));
    EXPECT_DOUBLE_EQ(stage.seconds, 2.0);
    EXPECT_DOUBLE_EQ(stage.seconds_left(0.5), 2.0);
    EXPECT_DOUBLE_EQ(stage.per_second(6.0), 3.0);
}

// Four pages, each so short that every stage reports once: 50 ms of texels, then 200 ms that trace 1000 rays.
TEST(StageClock, StagesOfShortPagesKeepTheirTime) {
    StageClock clock(at(0));
    for (int page = 0; page < 4; ++page) {
        const double fraction = 0.25 * (page + 1);
        EXPECT_NEAR(clock.report("texels", fraction, at(250 * page + 50)).seconds, 0.05 * (page + 1), 1e-9);
        const Stage& trace = clock.report("trace", fraction, at(250 * page + 250));
        EXPECT_NEAR(trace.seconds, 0.2 * (page + 1), 1e-9);
        EXPECT_NEAR(trace.per_second(1000.0 * (page + 1)), 5000.0, 1e-6);
        EXPECT_NEAR(trace.seconds_left(fraction), 0.2 * (3 - page), 1e-9);
    }
}

TEST(StageClock, AFinishedStageBeginsAnew) {
    StageClock clock(at(0));
    clock.report("views", 1.0, at(3000)).finished = true;
    EXPECT_DOUBLE_EQ(clock.report("views", 1.0, at(4000)).seconds, 4.0);
    const Stage& again = clock.report("views", 0.5, at(6000));
    EXPECT_DOUBLE_EQ(again.seconds, 2.0);
    EXPECT_FALSE(again.finished);
}

TEST(StageClock, NothingDoneIsNoRate) {
    StageClock clock(at(0));
    const Stage& stage = clock.report("trace", 0.0, at(0));
    EXPECT_EQ(stage.seconds_left(0.0), 0.0);
    EXPECT_EQ(stage.per_second(10.0), 0.0);
}

}  // namespace
}  // namespace lumel::cli
