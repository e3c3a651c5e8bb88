// Texels of pages made by hand: coverage, valid points, owners, representative points, determinism.
#include "texel/texel_buffer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "support/flat_page.h"
#include "texel/texel_triangle.h"

namespace lumel {
namespace {

using test::BakedPage;
using test::FlatPage;
using test::Random;

constexpr std::uint64_t kAll = ~std::uint64_t{0};

double valid_area(const TexelBuffer& texels) {
    double points = 0;
    for (const std::uint64_t mask : texels.valid) points += std::popcount(mask);
    return points / kSamplesPerTexel;
}

// A polygon approximating a disc as a fan, optionally turned and squeezed.
FlatPage disc(Vec2 center, float radius, int corners, float squeeze = 1.0f) {
    FlatPage page;
    page.width = page.height = 64;
    const auto at = [&](int i) {
        const float angle = 6.2831853f * (static_cast<float>(i % corners) + 0.3f) / static_cast<float>(corners);
        const Vec2 p{radius * std::cos(angle), squeeze * radius * std::sin(angle)};
        return center + Vec2{0.8f * p.x - 0.6f * p.y, 0.6f * p.x + 0.8f * p.y};
    };
    for (int i = 0; i < corners; ++i) page.add({center, at(i), at(i + 1)});
    return page;
}

double area(const FlatPage& page) {
    double sum = 0;
    for (const auto& t : page.texels) sum += 0.5 * std::fabs(double{cross(t[1] - t[0], t[2] - t[0])});
    return sum;
}

// Each sample point lies in its texel and in a triangle listed for it. 2e-6 of the coordinate: barycentrics are floats.
void expect_points_inside(const BakedPage& page) {
    const TexelBuffer& texels = page.texels;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const auto points = page.samples(i);
        ASSERT_EQ(points.size(), static_cast<std::size_t>(std::max(1, std::popcount(texels.valid[i]))));
        for (const SamplePoint& p : points) {
            const auto first = texels.triangles.begin() + texels.first_triangle[i];
            const auto end = texels.triangles.begin() + texels.first_triangle[i + 1];
            ASSERT_TRUE(std::find(first, end, p.triangle) != end);
            ASSERT_GE(p.b1, 0.0f);
            ASSERT_GE(p.b2, 0.0f);
            ASSERT_LE(p.b1 + p.b2, 1.0f);
            const auto uv = page.uv(p.triangle);
            const double b0 = 1.0 - p.b1 - p.b2;
            const double x = b0 * uv[0].x + double{p.b1} * uv[1].x + double{p.b2} * uv[2].x;
            const double y = b0 * uv[0].y + double{p.b1} * uv[1].y + double{p.b2} * uv[2].y;
            const double slack = 2e-6 * 64;
            ASSERT_NEAR(x, texels.x[i] + 0.5, 0.5 + slack);
            ASSERT_NEAR(y, texels.y[i] + 0.5, 0.5 + slack);
        }
    }
}

// A (0, 6, 2)-net: one point in each of the 64 boxes of every shape 2^-i x 2^-(6-i); none within 1/128 of the sides.
TEST(TexelBuffer, SubtexelPointsAreANet) {
    for (int split = 0; split <= 6; ++split) {
        std::uint64_t seen = 0;
        const auto columns = static_cast<float>(1 << split), rows = static_cast<float>(64 >> split);
        for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
            const Vec2 p = subtexel_point(s);
            seen |= std::uint64_t{1} << static_cast<int>(std::floor(p.x * columns) + columns * std::floor(p.y * rows));
        }
        EXPECT_EQ(seen, kAll) << "boxes of 1/" << columns << " x 1/" << rows;
    }
    for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
        EXPECT_GE(std::min(subtexel_point(s).x, subtexel_point(s).y), 1.0f / 128);
        EXPECT_LE(std::max(subtexel_point(s).x, subtexel_point(s).y), 1.0f - 1.0f / 128);
    }
}

// Bakes of few samples use a prefix: its 2^k points lie in different boxes of every shape 2^-i x 2^-(k-i).
TEST(TexelBuffer, PrefixesOfTheSubtexelPointsAreNetsToo) {
    for (int k = 1; k < 6; ++k)
        for (int split = 0; split <= k; ++split) {
            std::uint64_t seen = 0;
            const auto columns = static_cast<float>(1 << split), rows = static_cast<float>(1 << (k - split));
            for (std::uint32_t s = 0; s < (1u << k); ++s) {
                const Vec2 p = subtexel_point(s);
                seen |=
                    std::uint64_t{1} << static_cast<int>(std::floor(p.x * columns) + columns * std::floor(p.y * rows));
            }
            EXPECT_EQ(seen, (std::uint64_t{1} << (1 << k)) - 1) << (1 << k) << " points, " << columns << " columns";
        }
}

TEST(TexelBuffer, AlignedQuadHasWholeTexels) {
    FlatPage page;
    page.add_quad({2, 3}, {5, 0}, {0, 4});
    const BakedPage baked(page);
    const TexelBuffer& t = baked.texels;
    ASSERT_EQ(t.size(), 20u);
    for (std::size_t i = 0; i < t.size(); ++i) {
        EXPECT_EQ(t.x[i], 2 + i % 5);  // row-major
        EXPECT_EQ(t.y[i], 3 + i / 5);
        EXPECT_EQ(t.valid[i], kAll);
        EXPECT_EQ(t.at(t.x[i], t.y[i]), i);
        EXPECT_NEAR(t.position[i].x, t.x[i] + 0.5f, 1e-5f);
        EXPECT_NEAR(-t.position[i].z, t.y[i] + 0.5f, 1e-5f);
        EXPECT_EQ(t.normal[i], (Vec3{0, 1, 0}));
        EXPECT_NEAR(t.world_size[i], 1.0f, 1e-5f);
    }
    EXPECT_EQ(std::count(t.texel_at.begin(), t.texel_at.end(), kNone), 16 * 16 - 20);
    EXPECT_EQ(baked.context.diagnostics.count("chart-overlap"), 0u);
    expect_points_inside(baked);
}

TEST(TexelBuffer, PixelsBeyondThePageHaveNoTexel) {
    FlatPage page;
    page.width = 8;
    page.height = 5;
    page.add_quad({0, 0}, {8, 0}, {0, 5});
    const BakedPage baked(page);
    const TexelBuffer& t = baked.texels;
    ASSERT_EQ(t.size(), 40u);
    EXPECT_EQ(t.at(7, 4), 39u);
    for (const auto& [x, y] : {std::pair{-1, 2}, {8, 2}, {2, -1}, {2, 5}})
        EXPECT_EQ(t.at(x, y), kNone) << x << ' ' << y;
}

TEST(TexelBuffer, OneSurfaceIsOneChartWithinThirtyDegrees) {
    const auto tilted = [](float degrees) {
        const float angle = degrees * 3.14159265f / 180.0f;
        return Vec3{std::sin(angle), std::cos(angle), 0};
    };
    TexelBuffer t;
    t.chart = {4, 4, 4, 5};
    t.normal = {tilted(0), tilted(29.9f), tilted(30.1f), tilted(0)};
    EXPECT_TRUE(t.on_one_surface(0, 1));
    EXPECT_TRUE(t.on_one_surface(2, 1));
    EXPECT_FALSE(t.on_one_surface(0, 2));
    EXPECT_FALSE(t.on_one_surface(0, 3));
}

// Points in a texel are a net of 64: their share misses the true one by at most a few points where an edge crosses, and
// the errors of the ~200 border texels average out.
TEST(TexelBuffer, ValidPointsMeasureTheArea) {
    for (const float squeeze : {1.0f, 0.2f}) {
        const FlatPage page = disc({31.3f, 32.1f}, 27.0f, 40, squeeze);
        const BakedPage baked(page);
        EXPECT_NEAR(valid_area(baked.texels), area(page), 1e-3 * area(page));
        expect_points_inside(baked);
        for (std::size_t i = 0; i < baked.texels.size(); ++i) {
            const double dx = baked.texels.x[i] + 0.5 - 31.3, dy = baked.texels.y[i] + 0.5 - 32.1;
            if (squeeze == 1.0f && std::sqrt(dx * dx + dy * dy) < 25.5) {
                EXPECT_EQ(baked.texels.valid[i], kAll) << "a crack between triangles";
            }
        }
    }
}

TEST(TexelBuffer, SliversAndSpecksAreCovered) {
    FlatPage page;
    page.add({Vec2{1.2f, 1.3f}, {9.7f, 6.1f}, {9.7f, 6.1001f}}, 0);    // a sliver, 1e-4 wide
    page.add({Vec2{12.4f, 2.4f}, {12.41f, 2.4f}, {12.4f, 2.41f}}, 1);  // a speck between sample points
    page.add({Vec2{3.5f, 12.5f}, {3.5f, 12.5f}, {3.5f, 12.5f}}, 2);    // a point
    page.add({Vec2{8.5f, 12.5f}, {11.5f, 12.5f}, {9.5f, 12.5f}}, 3);   // a line
    const BakedPage baked(page);
    const TexelBuffer& t = baked.texels;
    std::array<int, 4> texels{};
    for (std::size_t i = 0; i < t.size(); ++i) {
        EXPECT_TRUE(is_finite(t.position[i]));
        EXPECT_TRUE(std::isfinite(t.world_size[i]));
        ++texels[t.triangles[t.first_triangle[i]]];
    }
    EXPECT_GE(texels[0], 12);  // crosses 9 columns and 5 rows
    EXPECT_EQ(texels[1], 1);
    // Zero-area UV triangles of a mesh that has area in the world have none here: their world is flat too.
    EXPECT_EQ(texels[2], 1);
    EXPECT_EQ(texels[3], 4);
    expect_points_inside(baked);
}

// A triangle whose texels are a line but which has area in the world: finite texel size, no larger than the triangle.
TEST(TexelBuffer, CollapsedUvsHaveAFiniteTexelSize) {
    FlatPage page;
    page.add({Vec2{8.5f, 12.5f}, {11.5f, 12.5f}, {9.5f, 12.5f}});
    BakedPage baked(page);
    baked.world.geometry.positions = {{0, 0, 0}, {6, 0, 0}, {2, 0, 5}};
    const std::vector<std::uint32_t> triangles{0};
    auto texels =
        rasterize_page(baked.world.scene, baked.world.geometry, baked.charts, baked.atlas, 0, triangles, baked.context);
    ASSERT_TRUE(texels.ok());
    for (const float size : texels->world_size) EXPECT_NEAR(size, std::sqrt(41.0f), 1e-3f);
}

TEST(TexelBuffer, WorldSizeIsTheLongerEdgeOfTheTexel) {
    FlatPage page;
    page.add_quad({1, 1}, {8, 2}, {-1, 9});
    BakedPage baked(page);
    // World = J * texels with columns (0.5, 0, 0.25) and (0, 3, 1).
    for (std::size_t v = 0; v < 6; ++v) {
        const Vec2 uv = page.texels[v / 3][v % 3];
        baked.world.geometry.positions[v] = Vec3{0.5f, 0, 0.25f} * uv.x + Vec3{0, 3, 1} * uv.y;
    }
    const std::vector<std::uint32_t> triangles{0, 1};
    auto texels =
        rasterize_page(baked.world.scene, baked.world.geometry, baked.charts, baked.atlas, 0, triangles, baked.context);
    ASSERT_TRUE(texels.ok());
    for (const float size : texels->world_size) EXPECT_NEAR(size, std::sqrt(10.0f), 1e-4f);
}

// Asked for later it is the point that the buffer's position is of: whole texels, those on the rim, and a speck.
TEST(TexelBuffer, RepresentativePointIsThatOfThePosition) {
    FlatPage page = disc({20, 30}, 12, 17, 0.3f);
    page.add({Vec2{50.4f, 50.4f}, {50.41f, 50.4f}, {50.4f, 50.41f}}, 1);  // between sample points
    const BakedPage baked(page);
    for (std::size_t i = 0; i < baked.texels.size(); ++i) {
        const auto [triangle, b1, b2] =
            representative_point(baked.texels, i, baked.world.scene, baked.world.geometry, baked.charts, baked.atlas);
        EXPECT_EQ(baked.world.geometry.position(triangle, b1, b2), baked.texels.position[i]);
    }
}

TEST(TexelBuffer, RepresentativeIsTheCentreOrTheNearestSample) {
    FlatPage page;
    page.add({Vec2{4.6f, 4.0f}, {8.0f, 4.0f}, {8.0f, 9.0f}});
    const BakedPage baked(page);
    const TexelBuffer& t = baked.texels;
    for (std::size_t i = 0; i < t.size(); ++i) {
        const Vec2 corner{static_cast<float>(t.x[i]), static_cast<float>(t.y[i])};
        const TexelTriangle triangle(page.texels[0]);
        const Vec2 at{t.position[i].x, -t.position[i].z};
        EXPECT_TRUE(triangle.locate(at.x + 1e-5, at.y) || triangle.locate(at.x - 1e-5, at.y));
        float nearest = 1e30f;
        if (triangle.locate(corner.x + 0.5, corner.y + 0.5)) {
            nearest = 0;
        } else {
            for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s)
                if ((t.valid[i] >> s) & 1) nearest = std::min(nearest, length(subtexel_point(s) - Vec2{0.5f, 0.5f}));
        }
        if (nearest == 1e30f) continue;
        EXPECT_NEAR(length(at - corner - Vec2{0.5f, 0.5f}), nearest, 1e-5f) << t.x[i] << " " << t.y[i];
    }
}

TEST(TexelBuffer, SharedTexelsGoToTheChartWithMostOfThem) {
    FlatPage page;
    page.add_quad({2, 2}, {3.25f, 0}, {0, 4}, 1);  // reaches a quarter into column 5
    page.add_quad({5.25f, 2}, {3, 0}, {0, 4}, 0);  // the rest of column 5
    page.add_quad({2, 10}, {4, 0}, {0, 4}, 2);     // two charts in the same place
    page.add_quad({2, 10}, {4, 0}, {0, 4}, 3);
    const BakedPage baked(page);
    const TexelBuffer& t = baked.texels;
    EXPECT_EQ(baked.context.diagnostics.count("chart-overlap"), 4u + 16u);
    for (std::size_t i = 0; i < t.size(); ++i) {
        const bool own_charts_only =
            std::all_of(t.triangles.begin() + t.first_triangle[i], t.triangles.begin() + t.first_triangle[i + 1],
                        [&](std::uint32_t triangle) {
                            return page.chart[triangle] == page.chart[t.triangles[t.first_triangle[i]]];
                        });
        EXPECT_TRUE(own_charts_only);
        const std::uint32_t owner = page.chart[t.triangles[t.first_triangle[i]]];
        const std::uint32_t expected = t.y[i] >= 10 ? 2u : (t.x[i] < 5 ? 1u : 0u);
        EXPECT_EQ(owner, expected);
        EXPECT_EQ(t.chart[i], expected);
        EXPECT_EQ(std::popcount(t.valid[i]), t.x[i] == 5 && t.y[i] < 8 ? (owner == 0 ? 48 : 16)
                                             : t.x[i] == 8             ? 16
                                                                       : 64);
    }
    ASSERT_EQ(baked.context.diagnostics.all().size(), 1u);
    EXPECT_EQ(baked.context.diagnostics.all()[0].examples[0], "page 0, texel 5, 2: charts of 'node 0' and 'node 0'");
}

// Two instances of one mesh have the same charts; their texels have owners of their own: the placements.
TEST(TexelBuffer, OwnersOfInstancesDiffer) {
    FlatPage page;
    page.add_quad({2, 2}, {3, 0}, {0, 4}, 0);
    page.add_quad({6, 2}, {3, 0}, {0, 4}, 1);
    BakedPage baked(page);
    baked.world.scene.instances.push_back(baked.world.scene.instances[0]);
    const auto triangles = static_cast<std::uint32_t>(baked.world.geometry.triangles.size());
    for (std::uint32_t t = 0; t < triangles; ++t) {
        WorldTriangle copy = baked.world.geometry.triangles[t];
        copy.instance = 1;
        baked.world.geometry.triangles.push_back(copy);
    }
    baked.atlas.first_placement = {0, 2, 4};
    for (int c = 0; c < 2; ++c) baked.atlas.placements.push_back({0, {1, 1}, {0, 8}});
    const auto by_page = triangles_by_page(baked.world.scene, baked.world.geometry, baked.charts, baked.atlas);
    auto texels = rasterize_page(baked.world.scene, baked.world.geometry, baked.charts, baked.atlas, 0, by_page[0],
                                 baked.context);
    ASSERT_TRUE(texels.ok());
    ASSERT_EQ(texels->size(), 48u);
    for (std::size_t i = 0; i < texels->size(); ++i)
        EXPECT_EQ(texels->chart[i], (texels->y[i] < 8 ? 0u : 2u) + (texels->x[i] < 6 ? 0u : 1u));
}

// Charts that only meet along a line between texels share none.
TEST(TexelBuffer, TouchingChartsDoNotOverlap) {
    FlatPage page;
    page.add_quad({2, 2}, {3, 0}, {0, 4}, 0);
    page.add_quad({5, 2}, {3, 0}, {0, 4}, 1);
    const BakedPage baked(page);
    EXPECT_EQ(baked.texels.size(), 24u);
    EXPECT_EQ(baked.context.diagnostics.count("chart-overlap"), 0u);
}

template <class T>
bool equal_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TEST(TexelBuffer, ThreadsDoNotMatter) {
    FlatPage page;
    page.width = 200;
    page.height = 300;
    Random random(5);
    for (std::uint32_t i = 0; i < 400; ++i) {
        const Vec2 corner = random.pair() * 180.0f;
        page.add({corner, corner + random.pair() * 30.0f, corner + random.pair() * 30.0f}, i);
    }
    const BakedPage one(page, 1), three(page, 3);
    const TexelBuffer &a = one.texels, &b = three.texels;
    ASSERT_GT(a.size(), 10000u);
    EXPECT_TRUE(equal_bits(a.x, b.x) && equal_bits(a.y, b.y) && equal_bits(a.valid, b.valid));
    EXPECT_TRUE(equal_bits(a.chart, b.chart));
    EXPECT_TRUE(equal_bits(a.first_triangle, b.first_triangle) && equal_bits(a.triangles, b.triangles));
    EXPECT_TRUE(equal_bits(a.position, b.position) && equal_bits(a.normal, b.normal));
    EXPECT_TRUE(equal_bits(a.world_size, b.world_size) && equal_bits(a.texel_at, b.texel_at));
    const auto &da = one.context.diagnostics.all(), &db = three.context.diagnostics.all();
    ASSERT_EQ(da.size(), 1u);
    ASSERT_EQ(db.size(), 1u);
    EXPECT_EQ(da[0].count, db[0].count);
    EXPECT_EQ(da[0].examples, db[0].examples);
    expect_points_inside(one);
}

// All 64 points of a texel against each triangle one by one.
TEST(TexelBuffer, ValidMaskIsTheUnionOfTheOwnersTriangles) {
    FlatPage page = disc({20.0f, 30.0f}, 11.0f, 300);  // many triangles per texel near the middle
    const BakedPage baked(page);
    const TexelBuffer& t = baked.texels;
    for (std::size_t i = 0; i < t.size(); ++i)
        for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
            const Vec2 p = subtexel_point(s);
            bool inside = false;
            for (const auto& corners : page.texels)
                inside |= TexelTriangle(corners).locate(t.x[i] + double{p.x}, t.y[i] + double{p.y}).has_value();
            ASSERT_EQ(((t.valid[i] >> s) & 1) != 0, inside) << "texel " << i << " point " << s;
        }
}

// Whole texels gather from the middle half, at the points that gather_point names; those of the rim from wherever they
// are covered. 1e-5: barycentrics are floats.
TEST(TexelBuffer, CoveredTexelsGatherFromTheirMiddle) {
    FlatPage page;
    page.add_quad({2.25f, 3}, {5, 0}, {0, 4});
    const BakedPage baked(page);
    const TexelBuffer& t = baked.texels;
    std::size_t whole = 0, rim = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
        const auto points = baked.samples(i);
        std::size_t k = 0;
        for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
            if (!((t.valid[i] >> s) & 1)) continue;
            const auto [triangle, b1, b2] = points[k++];
            const auto uv = baked.uv(triangle);
            const Vec2 p = uv[0] * (1.0f - b1 - b2) + uv[1] * b1 + uv[2] * b2 - Vec2{float(t.x[i]), float(t.y[i])};
            const Vec2 expected = gather_point(t.valid[i], s);
            ASSERT_NEAR(p.x, expected.x, 1e-5);
            ASSERT_NEAR(p.y, expected.y, 1e-5);
            if (t.valid[i] == kAll) {
                ASSERT_NEAR(p.x, 0.5, 0.25);
                ASSERT_NEAR(p.y, 0.5, 0.25);
            }
        }
        ++(t.valid[i] == kAll ? whole : rim);
    }
    EXPECT_EQ(whole, 4u * 4u);
    EXPECT_EQ(rim, 2u * 4u);
}

TEST(TexelBuffer, CancelStops) {
    FlatPage page;
    page.add_quad({2, 3}, {5, 0}, {0, 4});
    BakedPage baked(page);
    baked.context.request_cancel();
    const std::vector<std::uint32_t> triangles{0, 1};
    const auto result =
        rasterize_page(baked.world.scene, baked.world.geometry, baked.charts, baked.atlas, 0, triangles, baked.context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lumel
