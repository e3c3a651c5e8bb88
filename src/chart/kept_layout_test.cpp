// TEXCOORD_1 as it comes: kept, packed anew mesh by mesh, or rejected, and what is told of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "chart/chart_set.h"
#include "support/chart_layouts.h"

namespace lumel {
namespace {

using test::Level;
using test::LevelBuilder;
using test::scaled;

// A level's layout, and what was told while it was made.
struct LaidOut : test::Layout {
    explicit LaidOut(const Level& from, const ChartOptions& options = {}) : level(from) {
        static_cast<test::Layout&>(*this) = test::layout(level, options, context);
    }
    void expect_clean() const { test::expect_clean(test::judge(level, *this)); }
    [[nodiscard]] bool told_nothing() const { return context.diagnostics.all().empty(); }
    [[nodiscard]] std::uint64_t count(std::string_view code) const { return context.diagnostics.count(code); }
    [[nodiscard]] std::string first_example(std::string_view code) const {
        const Diagnostic* d = diagnostic(code);
        return d && !d->examples.empty() ? d->examples[0] : "";
    }
    [[nodiscard]] std::string message(std::string_view code) const {
        const Diagnostic* d = diagnostic(code);
        return d ? d->message : "";
    }

    const Level& level;
    Context context{1};

private:
    [[nodiscard]] const Diagnostic* diagnostic(std::string_view code) const {
        const auto& all = context.diagnostics.all();
        const auto found = std::ranges::find(all, code, &Diagnostic::code);
        return found == all.end() ? nullptr : &*found;
    }
};

// One node for each mesh.
template <class... Meshes>
Level level_of(Meshes... meshes) {
    LevelBuilder b;
    (b.instance(b.mesh(std::move(meshes))), ...);
    return b.build();
}

Mesh floor_with_uv1(Vec2 low, Vec2 size) {
    Mesh mesh = test::flat_grid(2, 2.0f);
    for (const Vec3 p : mesh.positions) mesh.uv1.push_back(low + Vec2{0.5f * p.x, -0.5f * p.z} * size);
    return mesh;
}

// Two floors side by side on the page, with room between them.
Level two_floors() {
    return level_of(floor_with_uv1({0.05f, 0.05f}, {0.4f, 0.4f}), floor_with_uv1({0.55f, 0.05f}, {0.4f, 0.4f}));
}

// Both halves of a layout as one mesh, the second one elsewhere in space.
Mesh joined(Mesh two, const Mesh& other, Vec3 shift) {
    const auto first = static_cast<std::uint32_t>(two.positions.size());
    for (std::size_t v = 0; v < other.positions.size(); ++v) {
        two.positions.push_back(other.positions[v] + shift);
        two.normals.push_back(other.normals[v]);
        two.uv1.push_back(other.uv1[v]);
    }
    for (const Triangle& t : other.triangles) two.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    test::cover_with_one_primitive(two);
    return two;
}

ChartOptions square_page(std::uint32_t edge, Uv1Policy policy = Uv1Policy::automatic) {
    ChartOptions options;
    options.resolution_width = options.resolution_height = edge;
    options.uv1 = policy;
    return options;
}

TEST(KeptLayout, IsKeptUnchanged) {
    const Level level = two_floors();
    ChartOptions options;
    options.resolution_width = 300;
    options.resolution_height = 200;
    const LaidOut l(level, options);
    EXPECT_TRUE(l.charts.scene_wide);
    ASSERT_EQ(l.atlas.pages.size(), 1u);
    EXPECT_EQ(l.atlas.pages[0].width, 300u);
    for (std::uint32_t w = 0; w < level.geometry.triangle_count(); ++w) {
        const auto uv = l.atlas.triangle_uv(l.charts, level.geometry, level.scene, w);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 file = level.geometry.uv1[level.geometry.triangles[w].vertices[k]];
            EXPECT_EQ(uv.texels[k], (Vec2{file.x * 300.0f, file.y * 200.0f}));
        }
    }
    l.expect_clean();
    EXPECT_TRUE(l.told_nothing());
}

// Two floors of 4 m2 on 0.16 of the page each: at 10 texels per metre 800 texels over 0.32 of the page, an edge
// of 50.
TEST(KeptLayout, ResolutionFollowsDensityOrBudget) {
    const Level level = two_floors();
    ChartOptions options;
    options.texels_per_metre = 10.0;
    EXPECT_EQ(LaidOut(level, options).atlas.pages[0].width, 52u) << "50, up to a multiple of 4";
    options.texels_per_metre = 0.0;
    options.texel_budget = 3200.0;
    EXPECT_EQ(LaidOut(level, options).atlas.pages[0].width, 100u);
}

TEST(KeptLayout, NodesThatOverlapGetChartsPerMesh) {
    const Level level = level_of(floor_with_uv1({0, 0}, {0.5f, 0.5f}), floor_with_uv1({0.2f, 0.2f}, {0.8f, 0.8f}));
    const LaidOut l(level);
    EXPECT_FALSE(l.charts.scene_wide);
    EXPECT_TRUE(l.charts.meshes[0].from_uv1);
    l.expect_clean();
    // Kept mesh by mesh, but not unchanged: that is told, and why.
    EXPECT_GT(l.count("uv1-repacked"), 0u);
    EXPECT_NE(l.first_example("uv1-repacked").find("node 'node 0' triangle "), std::string::npos);
    EXPECT_NE(l.first_example("uv1-repacked").find(" and node 'node 1' triangle "), std::string::npos);
    EXPECT_EQ(l.count("uv-overlap"), 0u) << "the mesh layouts themselves are sound";

    ChartOptions asked;
    asked.uv1 = Uv1Policy::scene;
    const LaidOut forced(level, asked);
    EXPECT_TRUE(forced.charts.scene_wide);
    EXPECT_GT(forced.count("uv-overlap"), 0u);
    EXPECT_EQ(forced.count("uv-overlap"), l.count("uv1-repacked"));
    EXPECT_NE(forced.message("uv-overlap").find("kept as asked"), std::string::npos);
    EXPECT_GT(forced.count("uv-bleeding"), 0u);
}

TEST(KeptLayout, AMeshInstancedTwiceGetsChartsPerInstance) {
    LevelBuilder b;
    const std::uint32_t m = b.mesh(floor_with_uv1({0, 0}, {0.5f, 0.5f}));
    b.instance(m).instance(m, scaled({1, 1, 1}, {9, 0, 0}));
    const Level level = b.build();
    const LaidOut l(level);
    EXPECT_FALSE(l.charts.scene_wide);
    l.expect_clean();
    EXPECT_EQ(l.first_example("uv1-repacked"), "node 'node 1' shares its mesh with another node");
}

TEST(KeptLayout, PaddingTooNarrowForThePageIsReported) {
    const Level level = level_of(floor_with_uv1({0.0f, 0.0f}, {0.495f, 1}), floor_with_uv1({0.505f, 0}, {0.495f, 1}));
    EXPECT_EQ(LaidOut(level, square_page(512)).count("uv-bleeding"), 0u);
    const LaidOut coarse(level, square_page(32));
    EXPECT_EQ(coarse.count("uv-bleeding"), 64u) << "the two columns beside the gap";
    EXPECT_EQ(coarse.first_example("uv-bleeding"),
              "node 'node 0' chart 0 triangle 2 and node 'node 1' chart 0 triangle 0: 64 texels of 32x32 at UV "
              "(0.4844, 0.0156)");
}

// Within one mesh, islands that share texels are one chart, as a texel has one owner; and that is told.
TEST(KeptLayout, IslandsThatShareTexelsAreOneChart) {
    const Level level =
        level_of(joined(floor_with_uv1({0, 0}, {0.495f, 1}), floor_with_uv1({0.505f, 0}, {0.495f, 1}), {9, 0, 0}));
    const LaidOut fine(level, square_page(512));
    EXPECT_EQ(fine.charts.meshes[0].charts.size(), 2u);
    EXPECT_EQ(fine.count("uv-bleeding"), 0u);
    const LaidOut coarse(level, square_page(32));
    EXPECT_TRUE(coarse.charts.scene_wide) << "kept unchanged all the same";
    EXPECT_EQ(coarse.charts.meshes[0].charts.size(), 1u);
    EXPECT_EQ(coarse.count("uv-bleeding"), 64u) << "the two columns beside the gap";
    // Packed anew they are apart at any resolution.
    const LaidOut packed(level, square_page(32, Uv1Policy::mesh));
    EXPECT_EQ(packed.charts.meshes[0].charts.size(), 2u);
    packed.expect_clean();
    EXPECT_TRUE(packed.told_nothing());
}

// A layout that is kept from a record has the page of then, whatever page the options would lead to: what shares texels
// on it is told, and is one chart, as then.
TEST(KeptLayout, ChartsAreJudgedOnThePageOfTheRecord) {
    const Level apart = level_of(floor_with_uv1({0.0f, 0.0f}, {0.495f, 1}), floor_with_uv1({0.505f, 0}, {0.495f, 1}));
    const Level one =
        level_of(joined(floor_with_uv1({0, 0}, {0.495f, 1}), floor_with_uv1({0.505f, 0}, {0.495f, 1}), {9, 0, 0}));
    for (const Level* level : {&apart, &one}) {
        for (const std::uint32_t edge : {32u, 512u}) {
            const LaidOut then(*level, square_page(edge));
            const AtlasRecord record = test::record_of(*level, then);
            ChartOptions options;
            options.texel_budget = edge == 32 ? 250000.0 : 500.0;  // a page of 504, or of 24
            options.previous = &record;
            const LaidOut now(*level, options);
            EXPECT_EQ(now.atlas.pages[0].width, edge);
            EXPECT_EQ(now.count("uv-bleeding"), edge == 32 ? 64u : 0u);
            EXPECT_EQ(now.first_example("uv-bleeding"), then.first_example("uv-bleeding"));
            EXPECT_EQ(now.charts.meshes[0].charts.size(), then.charts.meshes[0].charts.size());
            EXPECT_EQ(now.atlas.kept, then.atlas.placements.size());
        }
    }
    // A page that the options rule out is an error before its texels are looked at.
    const LaidOut then(apart, square_page(512));
    const AtlasRecord record = test::record_of(apart, then);
    ChartOptions options;
    options.max_page = 256;
    options.previous = &record;
    Context context(1);
    const auto refused = make_charts(apart.scene, apart.geometry, options, context);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("--max-page 256"), std::string::npos) << refused.error().text();
}

// Where TEXCOORD_1 was edited, or a node has another name, it is another chart that lies there.
TEST(KeptLayout, EditedChartsAreNotCountedAsKept) {
    const Level level = two_floors();
    const LaidOut then(level, square_page(64));
    const AtlasRecord record = test::record_of(level, then);
    ChartOptions options;
    options.previous = &record;
    EXPECT_EQ(LaidOut(level, options).atlas.kept, 2u);
    const Level edited =
        level_of(floor_with_uv1({0.05f, 0.05f}, {0.4f, 0.4f}), floor_with_uv1({0.55f, 0.05f}, {0.4f, 0.3f}));
    EXPECT_EQ(LaidOut(edited, options).atlas.kept, 1u);
    Level renamed = two_floors();
    for (Instance& instance : renamed.scene.instances) instance.path_hash += 77;
    EXPECT_EQ(LaidOut(renamed, options).atlas.kept, 0u);
}

// Tiles of one floor, side by side in space as in the layout, without any padding: their light goes on, nothing
// bleeds.
TEST(KeptLayout, ChartsThatGoOnInEachOtherDoNotBleed) {
    const Mesh left = floor_with_uv1({0, 0}, {0.5f, 1}), right = floor_with_uv1({0.5f, 0}, {0.5f, 1});
    for (const float gap : {0.0f, 0.5f}) {  // metres; a texel is 2/16 m
        for (const bool one_mesh : {true, false}) {
            LevelBuilder b;
            if (one_mesh)
                b.instance(b.mesh(joined(left, right, {2 + gap, 0, 0})));
            else
                b.instance(b.mesh(left)).instance(b.mesh(right), scaled({1, 1, 1}, {2 + gap, 0, 0}));
            const Level level = b.build();
            const LaidOut l(level, square_page(32));
            EXPECT_TRUE(l.charts.scene_wide);
            EXPECT_EQ(l.count("uv-bleeding") > 0, gap > 0.0f) << gap << one_mesh;
        }
    }
    // And a wall that stands on the floor's edge: one place, but another light.
    LevelBuilder b;
    const Affine upright{{Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}}, {2, 0, 0}};
    b.instance(b.mesh(left)).instance(b.mesh(right), upright);
    EXPECT_EQ(LaidOut(b.build(), square_page(32)).count("uv-bleeding"), 64u);
}

// A sliver of the surface may have no area in the layout: it lies on a line of another chart, and bleeds nothing.
TEST(KeptLayout, CollapsedTrianglesDoNotBleed) {
    Mesh sliver = test::flat_grid(1, 0.04f);  // 0.04 % of the floor: fewer than the thousandth that is let pass
    for (const Vec3 p : sliver.positions) sliver.uv1.push_back({0.2f + 2.5f * p.x, 0.5f});
    const Level level = level_of(joined(floor_with_uv1({0, 0}, {1, 1}), sliver, {0.4f, 0, -1}));
    const LaidOut l(level, square_page(32));
    EXPECT_TRUE(l.charts.scene_wide);
    EXPECT_EQ(l.charts.meshes[0].charts.size(), 2u);
    EXPECT_EQ(l.count("uv-bleeding"), 0u);
}

// Two islands of one mesh on top of each other, under each policy.
TEST(KeptLayout, OverlapsInsideAMesh) {
    const Level level =
        level_of(joined(floor_with_uv1({0, 0}, {0.5f, 0.5f}), floor_with_uv1({0.25f, 0.25f}, {0.5f, 0.5f}), {9, 0, 0}));
    {
        const LaidOut l(level);  // automatic: charts of ours
        EXPECT_FALSE(l.charts.meshes[0].from_uv1);
        l.expect_clean();
        EXPECT_EQ(l.count("uv1-rejected"), 1u);
        // The quarter of the page that both cover is one cell of 2 x 2 in either: two triangles each, along one
        // diagonal.
        EXPECT_EQ(l.first_example("uv1-rejected"), "node 'node 0': 2 pairs of triangles overlap in it");
        ASSERT_EQ(l.count("uv-overlap"), 2u);
        EXPECT_EQ(l.first_example("uv-overlap"), "node 'node 0' triangles 6 and 8 at UV (0.4167, 0.3333)");
        EXPECT_NE(l.message("uv-overlap").find("charts were made"), std::string::npos);
        EXPECT_EQ(l.count("uv1-repacked"), 0u) << "nothing of it was kept";
    }
    {
        const LaidOut l(level, square_page(64, Uv1Policy::scene));  // as it is, and told
        EXPECT_TRUE(l.charts.scene_wide);
        EXPECT_EQ(l.count("uv-overlap"), 2u);
        EXPECT_NE(l.message("uv-overlap").find("kept as asked"), std::string::npos);
    }
    {
        const LaidOut l(level, square_page(64, Uv1Policy::mesh));  // islands on top of each other are packed apart
        EXPECT_TRUE(l.charts.meshes[0].from_uv1);
        EXPECT_EQ(l.charts.meshes[0].charts.size(), 2u);
        l.expect_clean();
        EXPECT_EQ(l.count("uv-overlap"), 2u);
        EXPECT_NE(l.message("uv-overlap").find("packed apart"), std::string::npos);
    }
}

TEST(KeptLayout, UvsThatAreNoNumbersAreRejected) {
    Mesh bad = floor_with_uv1({0, 0}, {1, 1});
    bad.uv1[4].x = std::nanf("");
    const Level level = level_of(std::move(bad));
    for (const Uv1Policy policy : {Uv1Policy::automatic, Uv1Policy::mesh}) {
        ChartOptions options;
        options.uv1 = policy;
        const LaidOut l(level, options);
        EXPECT_FALSE(l.charts.meshes[0].from_uv1);
        l.expect_clean();
        EXPECT_NE(l.first_example("uv1-rejected").find("not finite at triangle"), std::string::npos);
    }
    Context context(1);
    EXPECT_FALSE(make_charts(level.scene, level.geometry, square_page(64, Uv1Policy::scene), context).ok());
}

TEST(KeptLayout, RejectedLayoutsGetChartsOfOurs) {
    const Level level = level_of(floor_with_uv1({0, 0}, {1.5f, 1}), test::box({1, 1, 1}));
    const LaidOut l(level);
    EXPECT_FALSE(l.charts.meshes[0].from_uv1);
    EXPECT_EQ(l.count("uv1-rejected"), 1u) << "the box has none, which is no fault";
    l.expect_clean();

    ChartOptions options;
    options.uv1 = Uv1Policy::scene;
    Context context(1);
    const auto refused = make_charts(level.scene, level.geometry, options, context);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace lumel
