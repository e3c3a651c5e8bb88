// Embree against its brute-force twin at full size: 2,000 triangles, a million rays per scene.
#include <gtest/gtest.h>

#include "support/brute_tracer.h"
#include "support/ray_agreement.h"
#include "support/world_builder.h"
#include "trace/tracer.h"

namespace lumel {
namespace {

void expect_agreement(const test::World& world, std::uint64_t seed) {
    Context context(1);
    const auto tracer = make_embree_tracer(world.geometry, world.surfaces(), context);
    ASSERT_TRUE(tracer.ok());
    const test::BruteTracer brute(world.geometry, world.surfaces());
    EXPECT_TRUE(test::tracers_agree(**tracer, brute, world.geometry, 1000000, seed));
}

TEST(TracerLong, AgreesWithBruteForceOnSoup) {
    test::WorldBuilder builder;
    builder.add_soup(2000, {10, -20, 30}, 5.0f, 31);
    expect_agreement(builder.build(), 32);
}

TEST(TracerLong, AgreesWithBruteForceInAFurnishedRoom) {
    test::WorldBuilder builder;
    builder.add_box({-4, 0, -3}, {4, 3, 3}, true);
    builder.add_icosphere({1, 1.2f, 0.5f}, 0.9f, 3);  // 1,280 triangles
    for (int i = 0; i < 50; ++i) {
        const float step = static_cast<float>(i);
        const float x = -3.5f + 0.14f * step, z = -2.0f + 0.07f * static_cast<float>(i % 11);
        builder.add_box({x, 0.01f, z}, {x + 0.1f, 0.3f + 0.02f * step, z + 0.4f});  // off the floor: no ties
    }
    expect_agreement(builder.build(), 33);
}

}  // namespace
}  // namespace lumel
