// Ten million rays off random triangles from 1 mm to 10 km.
#include <gtest/gtest.h>

#include "support/offset_rays.h"

namespace lumel {
namespace {

TEST(RayOffsetLong, NoRayMeetsItsOwnTriangle) {
    test::OffsetCount total;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const auto count = test::trace_offset_rays(1000, 100, seed);
        total.rays += count.rays;
        ASSERT_EQ(count.self_hits, 0u) << count.first_failure << ", seed " << seed;
        ASSERT_EQ(count.missed_occluders, 0u) << count.first_failure << ", seed " << seed;
    }
    EXPECT_GT(total.rays, 10000000u);
}

}  // namespace
}  // namespace lumel
