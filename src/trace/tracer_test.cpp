// The contract of Tracer, on the product's back end: agreement with brute force, the alpha rule, skipping, ties, bad
// rays, and results that do not depend on how rays are batched.
#include "trace/tracer.h"

#include <gtest/gtest.h>
#if defined(__linux__)
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numeric>
#include <thread>

#include "math/warp.h"
#include "support/brute_tracer.h"
#include "support/ray_agreement.h"
#include "support/world_builder.h"

namespace lumel {
namespace {

using test::Random;
using test::World;
using test::WorldBuilder;

std::unique_ptr<Tracer> make_tracer(const World& world) {
    Context context(1);
    auto tracer = make_embree_tracer(world.geometry, world.surfaces(), context);
    EXPECT_TRUE(tracer.ok());
    return std::move(tracer).value();
}

Hit closest(const Tracer& tracer, const Ray& ray) {
    Hit hit;
    tracer.closest({&ray, 1}, {&hit, 1});
    return hit;
}

bool occluded(const Tracer& tracer, const Ray& ray) {
    std::uint8_t blocked = 2;
    tracer.occluded({&ray, 1}, {&blocked, 1});
    EXPECT_LE(blocked, 1);
    return blocked == 1;
}

bool same(const Hit& a, const Hit& b) {
    return a.triangle == b.triangle && a.t == b.t && a.b1 == b.b1 && a.b2 == b.b2 && a.back_face == b.back_face;
}

// Unit squares facing +z at the given depths, from (0,0) to (1,1).
World stacked_quads(std::initializer_list<float> depths, const Material& material = {}) {
    WorldBuilder builder;
    const std::uint32_t id = builder.add_material(material);
    for (const float z : depths) builder.add_quad({0, 0, z}, {1, 0, 0}, {0, 1, 0}, id);
    return builder.build();
}

Material blend(float alpha) {
    Material material;
    material.alpha_mode = AlphaMode::blend;
    material.alpha = alpha;
    return material;
}

TEST(Tracer, HitHasDistanceBarycentricsAndSide) {
    const World world = stacked_quads({0.0f});
    const auto tracer = make_tracer(world);
    const Hit front = closest(*tracer, {{0.75f, 0.25f, 2}, 0, {0, 0, -1}});
    EXPECT_EQ(front.triangle, 0u);
    EXPECT_NEAR(front.t, 2.0f, 1e-6f);  // Embree divides by a refined reciprocal estimate: up to an ulp or two off
    // Corners (0,0), (1,0), (1,1): the point is 0.25 a + 0.5 b + 0.25 c.
    EXPECT_NEAR(front.b1, 0.5f, 1e-6f);
    EXPECT_NEAR(front.b2, 0.25f, 1e-6f);
    EXPECT_FALSE(front.back_face);
    EXPECT_TRUE(closest(*tracer, {{0.75f, 0.25f, -2}, 0, {0, 0, 1}}).back_face);
    EXPECT_TRUE(closest(*tracer, {{0.75f, 0.25f, 2}, 0, {0, 0, 1}}).missed());
}

TEST(Tracer, MirroredInstancesKeepTheirFront) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    WorldBuilder builder;
    builder.add_mesh(mesh, kNone, {{Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {}});
    const World world = builder.build();
    const auto tracer = make_tracer(world);
    EXPECT_EQ(world.geometry.geometric_normal(0), (Vec3{0, 0, 1}));
    EXPECT_FALSE(closest(*tracer, {{-0.25f, 0.25f, 1}, 0, {0, 0, -1}}).back_face);
    EXPECT_TRUE(closest(*tracer, {{-0.25f, 0.25f, -1}, 0, {0, 0, 1}}).back_face);
}

TEST(Tracer, SegmentEndsCount) {
    const World world = stacked_quads({0.0f});
    const auto tracer = make_tracer(world);
    const auto ray = [](float tmin, float tmax) { return Ray{{0.5f, 0.25f, 2}, tmin, {0, 0, -1}, tmax}; };
    for (const Ray& hit : {ray(0, 3), ray(1.5f, 2.5f), ray(0, 2.0001f), ray(1.9999f, 3)}) {
        EXPECT_FALSE(closest(*tracer, hit).missed()) << hit.tmin << " " << hit.tmax;
        EXPECT_TRUE(occluded(*tracer, hit)) << hit.tmin << " " << hit.tmax;
    }
    for (const Ray& miss : {ray(0, 1.9999f), ray(2.0001f, 3)}) {
        EXPECT_TRUE(closest(*tracer, miss).missed()) << miss.tmin << " " << miss.tmax;
        EXPECT_FALSE(occluded(*tracer, miss)) << miss.tmin << " " << miss.tmax;
    }
}

// 500 triangles and 100,000 rays; the full size is in tracer_long_test.cpp.
TEST(Tracer, AgreesWithBruteForce) {
    WorldBuilder soup, rooms;
    soup.add_soup(500, {0, 0, 0}, 1.0f, 11);
    rooms.add_box({-1, -1, -1}, {1, 1, 1}, true);
    rooms.add_box({-0.5f, -0.9f, -0.5f}, {0.25f, 0.1f, 0.3f});
    rooms.add_icosphere({0.4f, 0.5f, 0.3f}, 0.4f, 2);
    for (const World& world : {soup.build(), rooms.build()}) {
        const auto tracer = make_tracer(world);
        const test::BruteTracer brute(world.geometry, world.surfaces());
        EXPECT_TRUE(test::tracers_agree(*tracer, brute, world.geometry, 100000, 21));
    }
}

TEST(Tracer, SkipsTheTriangleAskedFor) {
    const World world = stacked_quads({0.0f, -1.0f});  // triangles 0, 1 and behind them 2, 3
    const auto tracer = make_tracer(world);
    Ray ray{{0.75f, 0.25f, 2}, 0, {0, 0, -1}};
    EXPECT_EQ(closest(*tracer, ray).triangle, 0u);
    ray.skip = 0;
    EXPECT_EQ(closest(*tracer, ray).triangle, 2u);
    ray.tmax = 2.5f;
    EXPECT_TRUE(closest(*tracer, ray).missed());
    EXPECT_FALSE(occluded(*tracer, ray));
    ray.skip = 1;  // not the one in the way
    EXPECT_TRUE(occluded(*tracer, ray));
}

// Two hundred copies of one square: the lowest id wins, however the tree is laid out; also when that one is skipped.
TEST(Tracer, LowestIdWinsTies) {
    WorldBuilder builder;
    for (int i = 0; i < 200; ++i) builder.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const World world = builder.build();
    const auto tracer = make_tracer(world);
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 u = random.pair();
        const Vec3 target{0.9f * u.x + 0.05f, 0.9f * u.y + 0.05f, 0.0f};
        const Vec3 origin{random.unit(), random.unit(), 1.0f};
        Ray ray{origin, 0, normalize(target - origin)};
        const Hit hit = closest(*tracer, ray);
        ASSERT_LE(hit.triangle, 1u) << "ray " << i;
        ray.skip = hit.triangle;
        ASSERT_EQ(closest(*tracer, ray).triangle, hit.triangle + 2) << "ray " << i;
    }
}

TEST(Tracer, MaskLetsRaysThroughHoles) {
    Texture checker{"checker", 2, 2, true, {}};
    for (const int alpha : {255, 0, 0, 255})
        checker.rgba.insert(checker.rgba.end(), {255, 255, 255, std::uint8_t(alpha)});
    WorldBuilder builder;
    Material material;
    material.alpha_mode = AlphaMode::mask;
    material.base_color_texture.texture = builder.add_texture(checker);
    material.base_color_texture.nearest = true;
    builder.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, builder.add_material(material));
    builder.add_quad({0, 0, -1}, {1, 0, 0}, {0, 1, 0});  // opaque, behind
    const World world = builder.build();
    ASSERT_TRUE(world.geometry.triangles[0].flags & kNeedsAlpha);
    const auto tracer = make_tracer(world);
    Random random(4);
    for (int i = 0; i < 4000; ++i) {
        const Vec2 p = random.pair();
        Ray ray{{p.x, p.y, 1}, 0, {0, 0, -1}};
        const bool solid = (p.x < 0.5f) == (p.y < 0.5f);
        ASSERT_EQ(closest(*tracer, ray).triangle < 2, solid) << p.x << " " << p.y;
        ray.tmax = 1.5f;
        ASSERT_EQ(occluded(*tracer, ray), solid) << p.x << " " << p.y;
    }
}

// Through n layers of opacity a, a share (1-a)^n of the rays passes: layers decide independently.
TEST(Tracer, BlendStopsRaysWithProbabilityAlpha) {
    constexpr int kRays = 200000;
    for (const float alpha : {0.25f, 0.5f, 0.9f}) {
        const World world = stacked_quads({0.0f, -0.5f, -1.0f}, blend(alpha));
        const auto tracer = make_tracer(world);
        Random random(5);
        std::array<double, 4> stopped{};
        for (int i = 0; i < kRays; ++i) {
            const Vec2 p = random.pair();
            const Hit hit = closest(*tracer, {{p.x, p.y, 1}, 0, {0, 0, -1}, 1e30f, kNone, random.bits()});
            ++stopped[hit.missed() ? 3 : hit.triangle / 2];
        }
        double passes = 1.0;
        for (int layer = 0; layer < 4; ++layer) {
            const double expected = layer < 3 ? passes * alpha : passes;
            const double sigma = std::sqrt(expected * (1 - expected) / kRays);
            EXPECT_NEAR(stopped[static_cast<std::size_t>(layer)] / kRays, expected,
                        test::z_limit(test::sidak(1e-6, 12)) * sigma)
                << "alpha " << alpha << " layer " << layer;
            passes *= 1.0 - alpha;
        }
    }
}

TEST(Tracer, AlphaRuleIsAFunctionOfKeyAndTriangle) {
    EXPECT_TRUE(stops_ray(1.0f, 0, 0));
    int passed = 0;
    for (std::uint32_t key = 0; key < 1000; ++key) {
        EXPECT_FALSE(stops_ray(0.0f, key, 7));
        EXPECT_EQ(stops_ray(0.5f, key, 7), stops_ray(0.5f, key, 7));
        passed += stops_ray(0.5f, key, 7) ? 0 : 1;
    }
    EXPECT_NEAR(passed, 500, test::z_limit(1e-6) * std::sqrt(250.0));  // consecutive keys are as good as random ones
}

World mixed_world() {
    WorldBuilder builder;
    builder.add_soup(300, {0, 0, 0}, 1.0f, 6);
    builder.add_soup(300, {0, 0, 0}, 1.0f, 7, builder.add_material(blend(0.5f)));
    for (int i = 0; i < 4; ++i) {
        // Surfaces within rounding of one another: equal up to where their corners lie.
        const float shift = 0.01f * static_cast<float>(i);
        builder.add_quad({-1 - shift, -1, 0.3f}, {2.0f, 0.1f, 0.4f}, {0.1f, 2.2f + shift, 0.2f});
    }
    builder.add_box({-2, -2, -2}, {2, 2, 2}, true);
    return builder.build();
}

std::vector<Ray> mixed_rays(const World& world, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Ray> rays = test::random_rays(world.geometry, count, seed);
    for (Ray& ray : rays) {
        ray.alpha_key = random.bits();
        if (random.unit() < 0.5f) ray.skip = random.bits() % world.geometry.triangle_count();
        if (random.unit() < 0.5f) ray.tmax = 3.0f * random.unit() + 1e-3f;
    }
    return rays;
}

TEST(Tracer, OcclusionIsAHitOfAnyKind) {
    const World world = mixed_world();
    const auto tracer = make_tracer(world);
    const auto rays = mixed_rays(world, 200000, 8);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> blocked(rays.size());
    tracer->closest(rays, hits);
    tracer->occluded(rays, blocked);
    std::size_t free = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(blocked[i] != 0, !hits[i].missed()) << "ray " << i;
        free += blocked[i] == 0 ? 1 : 0;
    }
    EXPECT_GT(free, rays.size() / 10);
    EXPECT_LT(free, rays.size() * 9 / 10);
}

TEST(Tracer, BatchesDoNotMatter) {
    const World world = mixed_world();
    const auto tracer = make_tracer(world);
    const auto rays = mixed_rays(world, 100000, 9);
    std::vector<Hit> all(rays.size());
    std::vector<std::uint8_t> all_blocked(rays.size());
    tracer->closest(rays, all);
    tracer->occluded(rays, all_blocked);
    for (const std::size_t batch : {1u, 7u, 64u, 1000u}) {
        std::vector<Hit> hits(rays.size());
        std::vector<std::uint8_t> blocked(rays.size());
        for (std::size_t first = 0; first < rays.size(); first += batch) {
            const std::size_t count = std::min(batch, rays.size() - first);
            tracer->closest(std::span(rays).subspan(first, count), std::span(hits).subspan(first, count));
            tracer->occluded(std::span(rays).subspan(first, count), std::span(blocked).subspan(first, count));
        }
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_TRUE(same(hits[i], all[i])) << "batch " << batch << " ray " << i << ": " << hits[i].triangle
                                               << " at " << hits[i].t << ", " << all[i].triangle << " at " << all[i].t;
            ASSERT_EQ(blocked[i], all_blocked[i]) << "batch " << batch << " ray " << i;
        }
    }
}

// The companions in a packet, and another build of the tree, change nothing either.
TEST(Tracer, CompanyDoesNotMatter) {
    const World world = mixed_world();
    const auto tracer = make_tracer(world), other = make_tracer(world);
    const auto rays = mixed_rays(world, 100000, 10);
    std::vector<Hit> hits(rays.size());
    tracer->closest(rays, hits);

    std::vector<std::size_t> order(rays.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    Random random(12);
    for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random.bits() % (i + 1)]);
    std::vector<Ray> shuffled;
    for (const std::size_t i : order) shuffled.push_back(rays[i]);
    std::vector<Hit> shuffled_hits(rays.size());
    other->closest(shuffled, shuffled_hits);
    for (std::size_t i = 0; i < order.size(); ++i)
        ASSERT_TRUE(same(shuffled_hits[i], hits[order[i]])) << "ray " << order[i];
}

TEST(Tracer, BadRaysAreCountedMisses) {
    const World world = stacked_quads({0.0f});
    const auto tracer = make_tracer(world);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const Vec3 origin{0.5f, 0.25f, 2}, down{0, 0, -1};
    const std::vector<Ray> bad{
        {{nan, 0, 2}, 0, down},    {{0.5f, inf, 2}, 0, down}, {{0.5f, 0.25f, 1e30f}, 0, down},
        {origin, 0, {0, nan, -1}}, {origin, 0, {0, 0, -inf}}, {origin, 0, {0, 0, 0}},
        {origin, 0, {0, 0, -2}},   {origin, nan, down},       {origin, -1, down},
        {origin, 3, down, 2},      {origin, 1, down, 1},      {origin, 0, down, nan},
        {origin, 0, down, inf},    {origin, inf, down, inf},
    };
    std::vector<Ray> rays;  // each among good ones
    for (const Ray& ray : bad) rays.insert(rays.end(), {ray, {origin, 0, down}});
    std::vector<Hit> hits(rays.size(), Hit{0, 1, 1, 1, true});
    std::vector<std::uint8_t> blocked(rays.size(), 2);
    tracer->closest(rays, hits);
    tracer->occluded(rays, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].missed(), i % 2 == 0) << "ray " << i;
        EXPECT_EQ(blocked[i], i % 2) << "ray " << i;
    }
    EXPECT_EQ(tracer->statistics().rays, 2 * rays.size());
    EXPECT_EQ(tracer->statistics().invalid, 2 * bad.size());
}

TEST(Tracer, DegenerateTrianglesAndEmptyScenesAreHarmless) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0.5f, 0.5f, -1}};
    mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {0, 1, 1}};
    WorldBuilder builder, empty;
    builder.add_mesh(mesh);
    const World world = builder.build(), nothing = empty.build();
    for (const World* w : {&world, &nothing}) {
        const auto tracer = make_tracer(*w);
        EXPECT_TRUE(closest(*tracer, {{0.5f, 0, 1}, 0, {0, 0, -1}}).missed());
        EXPECT_FALSE(occluded(*tracer, {{0.5f, 0, 1}, 0, {0, 0, -1}}));
    }
}

TEST(Tracer, StatisticsSumOverThreads) {
    const World world = mixed_world();
    const auto tracer = make_tracer(world);
    const auto rays = mixed_rays(world, 1000, 13);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            std::vector<Hit> hits(rays.size());
            for (int repeat = 0; repeat < 25; ++repeat) tracer->closest(rays, hits);
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(tracer->statistics().rays, 4u * 25u * 1000u);
    EXPECT_EQ(tracer->statistics().invalid, 0u);
    EXPECT_GT(tracer->statistics().seconds, 0.0);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LUMEL_TEST_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LUMEL_TEST_SANITIZED 1
#endif
#endif
#if defined(__linux__) && !defined(LUMEL_TEST_SANITIZED)
// A process that may take 16 MB more: an error, no crash. (Sanitizers reserve more address space than that.)
TEST(TracerDeathTest, WantOfMemoryIsAnError) {
    const World world = mixed_world();
    const auto attempt = [&] {
        std::ifstream statistics("/proc/self/statm");
        rlim_t pages = 0;
        statistics >> pages;
        const rlim_t bytes = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (16u << 20);
        const rlimit limit{bytes, bytes};
        if (setrlimit(RLIMIT_AS, &limit) != 0) std::_Exit(2);
        Context context(1);
        const auto tracer = make_embree_tracer(world.geometry, world.surfaces(), context);
        std::_Exit(!tracer.ok() && tracer.error().code == ErrorCode::out_of_memory ? 0 : 1);
    };
    EXPECT_EXIT(attempt(), ::testing::ExitedWithCode(0), "");
}
#endif

// A rough terrain, large enough that its tree takes some tenths of a second.
World terrain(std::uint32_t side) {
    Mesh mesh;
    Random random(7);
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x) mesh.positions.push_back({float(x), random.unit() * 3.0f, float(y)});
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t v = y * (side + 1) + x;
            mesh.triangles.push_back({v, v + side + 1, v + 1});
            mesh.triangles.push_back({v + 1, v + side + 1, v + side + 2});
        }
    WorldBuilder builder;
    builder.add_mesh(std::move(mesh));
    return builder.build();
}

TEST(Tracer, TheBuildTellsHowFarItIsAndEndsAtOne) {
    const World world = terrain(200);
    Context context(1);
    std::vector<double> fractions;
    const auto here = std::this_thread::get_id();
    context.on_progress = [&](const Progress& progress) {
        EXPECT_EQ(progress.stage, "acceleration");
        EXPECT_EQ(std::this_thread::get_id(), here);
        fractions.push_back(progress.fraction);
    };
    ASSERT_TRUE(make_embree_tracer(world.geometry, world.surfaces(), context).ok());
    EXPECT_GT(fractions.size(), 5u);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_GT(fractions.front(), 0.0);
    EXPECT_EQ(fractions.back(), 1.0);
}

TEST(Tracer, TheBuildStopsWhereItIsCancelled) {
    const World world = terrain(200);
    for (const double at : {0.0, 0.2, 0.7}) {
        Context context(1);
        if (at == 0.0) context.request_cancel();
        double last = 0.0;
        context.on_progress = [&](const Progress& progress) {
            last = progress.fraction;
            if (last > at) context.request_cancel();
        };
        const auto tracer = make_embree_tracer(world.geometry, world.surfaces(), context);
        ASSERT_FALSE(tracer.ok()) << at;
        EXPECT_EQ(tracer.error().code, ErrorCode::cancelled);
        EXPECT_LT(last, 1.0);
    }
}

TEST(Tracer, DescriptionNamesTheBackEnd) {
    const World world = stacked_quads({0.0f});
    EXPECT_EQ(make_tracer(world)->description().substr(0, 7), "Embree ");
    EXPECT_NE(make_tracer(world)->description().find(", isa "), std::string_view::npos);
}

}  // namespace
}  // namespace lumel
