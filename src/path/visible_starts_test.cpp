#include "path/visible_starts.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

#include "lumel/bake.h"
#include "math/constants.h"
#include "post/lightmap.h"
#include "support/traced_scene.h"

namespace lumel {
namespace {

constexpr float kTexel = 0.4f;  // metres

void add_floor(test::SceneBuilder& b, std::uint32_t material) {
    b.object("floor", material, [](Mesh& m) { test::add_quad(m, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}); });
}

// The points of a texel whose corner is at the origin: on the floor, x to the right, z down the page.
struct FloorTexel {
    std::array<SurfaceStart, kSamplesPerTexel> starts;
    std::array<std::uint32_t, 2> triangles{0, 1};
    std::array<Ray, 256> rays;
    std::array<Hit, 256> hits;

    FloorTexel() {
        for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
            const Vec2 p = subtexel_point(s) * kTexel;
            starts[s] = {{p.x, 1e-5f, p.y}, {0, 1, 0}, kNone};
        }
    }
    VisibleStarts::Found find(const test::TracedScene& traced) {
        const VisibleStarts finder(*traced.tracer, traced.geometry, rays, hits);
        return finder.find({~std::uint64_t{0}, triangles, kTexel, 0}, starts, 7);
    }
    template <class Where>
    [[nodiscard]] std::uint64_t points(Where&& where) const {
        std::uint64_t out = 0;
        for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s)
            if (where(starts[s].origin)) out |= std::uint64_t{1} << s;
        return out;
    }
};

// Both sides of a sheet are lit: nothing but that the sides do not see each other tells them apart.
TEST(VisibleStarts, AThinWallPartsThePoints) {
    test::SceneBuilder b;
    const auto both = b.material({0.5f, 0.5f, 0.5f}, {}, true);
    add_floor(b, both);
    b.object("wall", both, [](Mesh& m) { test::add_quad(m, {0.13f, 0, 1}, {0, 0, -2}, {0, 1, 0}); });
    Context context(1);
    const test::TracedScene traced(b.build(), context);
    FloorTexel texel;
    const VisibleStarts::Found found = texel.find(traced);
    EXPECT_EQ(found.best, texel.points([](Vec3 p) { return p.x > 0.13f; }));
    EXPECT_EQ(found.open, ~std::uint64_t{0});
}

TEST(VisibleStarts, PointsBelowASolidAreNotOpen) {
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f});
    add_floor(b, grey);
    b.object("box", grey, [](Mesh& m) { test::add_box(m, {-0.5f, -0.2f, -0.5f}, {0.33f, 0.6f, 0.5f}, false); });
    Context context(1);
    const test::TracedScene traced(b.build(), context);
    FloorTexel texel;
    const VisibleStarts::Found found = texel.find(traced);
    // Four fifths of the texel are below it; the part that is seen wins nevertheless.
    EXPECT_EQ(found.best, texel.points([](Vec3 p) { return p.x > 0.33f; }));
    EXPECT_EQ(found.open, found.best);
    EXPECT_GT(std::popcount(found.best), 4);
}

// The floor slants into it: rays a twentieth of a texel above the floor look over its edge at points that lie inside.
TEST(VisibleStarts, ASlopeThatTheFloorEntersPartsThePoints) {
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f});
    add_floor(b, grey);
    b.object("slope", grey, [](Mesh& m) {  // its top, 0.13 m from where it meets the floor
        test::add_quad(m, {-1, 0.3f * 1.13f, 1}, {2, -0.6f, 0}, {0, 0, -2});
    });
    Context context(1);
    const test::TracedScene traced(b.build(), context);
    FloorTexel texel;
    EXPECT_EQ(texel.find(traced).best, texel.points([](Vec3 p) { return p.x > 0.13f; }));
}

// The back of a card that a few of the points see hides none of them.
TEST(VisibleStarts, ACardBesideATexelHidesNothing) {
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f});
    add_floor(b, grey);
    b.object("card", grey, [](Mesh& m) { test::add_quad(m, {1, 0, 0.7f}, {0, 0, -1}, {0, 0.6f, 0}); });  // faces +x
    Context context(1);
    const test::TracedScene traced(b.build(), context);
    FloorTexel texel;
    const VisibleStarts::Found found = texel.find(traced);
    EXPECT_EQ(found.best, ~std::uint64_t{0});
    EXPECT_EQ(found.open, ~std::uint64_t{0});
}

TEST(VisibleStarts, NothingIsOpenInsideASolid) {
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f});
    add_floor(b, grey);
    b.object("box", grey, [](Mesh& m) { test::add_box(m, {-0.5f, -0.2f, -0.5f}, {0.6f, 0.6f, 0.6f}, false); });
    Context context(1);
    const test::TracedScene traced(b.build(), context);
    FloorTexel texel;
    EXPECT_EQ(texel.find(traced).best, 0u);
}

TEST(VisibleStarts, FewPointsAskForASmallerPart) {
    std::uint64_t corner = 0;  // the points in the four cells at the upper left
    for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s)
        if (subtexel_point(s).x < 0.25f && subtexel_point(s).y < 0.25f) corner |= std::uint64_t{1} << s;
    ASSERT_EQ(std::popcount(corner), 4);
    const auto part = part_to_refine({}, ~std::uint64_t{0}, {corner, corner});
    ASSERT_TRUE(part.has_value());
    EXPECT_EQ(part->low, (Vec2{0, 0}));
    EXPECT_EQ(part->high, (Vec2{0.375f, 0.375f}));  // and the cells beside them
    EXPECT_FALSE(part_to_refine({}, ~std::uint64_t{0}, {~std::uint64_t{0}, ~std::uint64_t{0}}).has_value());
}

// A closed tent of sheets without a lamp on a floor in daylight, 0.9 m wide, the floor's texels 0.2 m: every texel of
// the floor is dark or in daylight, whichever the sheets leave more of, and none is a mixture of both. However the
// scene is turned, for the floor's own edges are what its texels follow.
TEST(VisibleStarts, TexelsUnderASheetHaveTheLightOfOneSide) {
    for (const float degrees : {0.0f, 37.0f}) {
        test::SceneBuilder b;
        const float angle = degrees * kPi / 180.0f;
        const Affine turn{
            {Vec3{std::cos(angle), 0, -std::sin(angle)}, {0, 1, 0}, {std::sin(angle), 0, std::cos(angle)}}, {}};
        const auto both = b.material({0.0f, 0.0f, 0.0f}, {}, true);
        b.object(
            "floor", both,
            [](Mesh& m) {
                test::add_quad(m, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
            },
            turn);
        const auto tent = b.object(
            "tent", both,
            [](Mesh& m) {
                test::add_box(m, {-0.43f, 0, -0.47f}, {0.46f, 0.05f, 0.44f}, true);
            },
            turn);
        b.scene().instances[tent].node_class = NodeClass::volume;
        b.scene().sky.color = {1, 1, 1};
        BakeOptions options;
        options.texels_per_metre = 5.0;
        options.samples = 64;
        options.integrator = Integrator::paths;
        std::size_t dark = 0, lit = 0, between = 0;
        BakeSink sink;
        sink.page = [&](const Lightmap& map) {
            for (std::size_t i = 0; i < map.texels.size(); ++i) {
                if (map.coverage[i] != Coverage::baked) continue;
                float sum = 0;
                for (const LayerMoments& layer : map.texels.layers[i]) sum += layer.irradiance.x;
                // Beside a sheet 5 cm high in texels of 20 cm at least half of the sky is seen.
                ++(sum < 0.02f ? dark : sum > 0.5f ? lit : between);
            }
            return success();
        };
        Context context;
        ASSERT_TRUE(bake(b.build(), options, sink, context).ok());
        EXPECT_EQ(between, 0u) << degrees;
        EXPECT_GE(dark, 16u) << degrees;  // 4 x 4 texels have their centres in the tent, or 5 x 4
        EXPECT_LE(dark, 25u) << degrees;
        EXPECT_GT(lit, 80u) << degrees;
    }
}

}  // namespace
}  // namespace lumel
