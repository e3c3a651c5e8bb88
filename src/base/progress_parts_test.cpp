#include "base/progress_parts.h"

#include <gtest/gtest.h>

#include <vector>

namespace lumel {
namespace {

struct Seen {
    std::string stage;
    double fraction;
    std::uint64_t rays;
    bool operator==(const Seen&) const = default;
};

TEST(ProgressParts, FractionsAndRaysOnlyGrow) {
    Context context(1);
    std::vector<Seen> seen;
    context.on_progress = [&](const Progress& p) { seen.push_back({std::string(p.stage), p.fraction, p.rays}); };
    {
        ProgressParts pictures(context, "views", 4);
        for (const double work : {3.0, 1.0}) {
            pictures.begin(work);
            ProgressParts halves(context, "render", 2);
            for (int half = 0; half < 2; ++half) {
                halves.begin(1);
                context.report("trace", 0.5, 10);
                context.report("trace", 1.0, 30);
            }
        }
    }
    context.report("later", 0.25, 5);
    const std::vector<Seen> expected{{"views", 0.1875, 10},  {"views", 0.375, 30},  {"views", 0.5625, 40},
                                     {"views", 0.75, 60},    {"views", 0.8125, 70}, {"views", 0.875, 90},
                                     {"views", 0.9375, 100}, {"views", 1.0, 120},   {"later", 0.25, 5}};
    EXPECT_EQ(seen, expected);
}

// Two pages, the second three times as large, each through two stages.
TEST(ProgressParts, StagesOfAPartKeepTheirNames) {
    Context context(1);
    std::vector<Seen> seen;
    context.on_progress = [&](const Progress& p) { seen.push_back({std::string(p.stage), p.fraction, p.rays}); };
    {
        ProgressParts pages(context, 4);
        for (const double work : {1.0, 3.0}) {
            pages.begin(work);
            context.report("trace", 0.5, 10);
            context.report("trace", 1.0, 20);
            context.report("write", 1.0);
        }
    }
    const std::vector<Seen> expected{{"trace", 0.125, 10}, {"trace", 0.25, 20}, {"write", 0.25, 0},
                                     {"trace", 0.625, 30}, {"trace", 1.0, 40},  {"write", 1.0, 0}};
    EXPECT_EQ(seen, expected);
}

TEST(ProgressParts, NobodyNeedListen) {
    Context context(1);
    ProgressParts parts(context, "views", 2);
    parts.begin(2);
    context.report("render", 0.5);
}

}  // namespace
}  // namespace lumel
