#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "chart/atlas_record.h"
#include "chart/chart_set.h"
#include "lumel/bake.h"
#include "post/lightmap.h"
#include "support/small_bake.h"
#include "support/traced_scene.h"
#include "texel/texel_buffer.h"

namespace lumel {
namespace {

// Every point of a surface finds, in the page and in each mip, light of its own chart in all texels that a lookup there
// weighs: the declared filter by its definition, at points spread over every triangle.
TEST(Bake, LookupsInMipsReadOneChart) {
    constexpr std::uint32_t kMips = 3;
    for (const LookupFilter filter : {LookupFilter::bilinear, LookupFilter::bicubic}) {
        BakeOptions options = test::small_options();
        options.samples = 1;
        options.mips = kMips;
        options.filter = filter;
        const Scene scene = test::room();
        ChartSet charts;
        Atlas atlas;
        std::vector<std::vector<Lightmap>> pages;  // page, mip
        BakeSink sink;
        sink.layout = [&](const WorldGeometry&, const ChartSet& c, const Atlas& a) {
            charts = c;
            atlas = a;
            return success();
        };
        sink.page = [&](const Lightmap& map) {
            if (map.mip == 0) pages.emplace_back();
            EXPECT_EQ(map.mip, pages.back().size());
            pages.back().push_back(map);
            return success();
        };
        Context context(2);
        ASSERT_TRUE(bake(scene, options, sink, context).ok());
        EXPECT_EQ(atlas.masks, (MaskRule{filter, kMips, 1}));
        const double reach = atlas.masks.reach() - 1e-3;  // of a texel: rounding of placed UVs
        std::uint64_t looked = 0;
        for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
            const MeshCharts& mesh = charts.meshes[scene.instances[i].mesh];
            for (std::uint32_t t = 0; t < mesh.chart_of_triangle.size(); ++t) {
                const Atlas::TriangleUv uv = atlas.mesh_triangle_uv(charts, scene, i, t);
                if (uv.page == kNone) continue;
                ASSERT_EQ(pages[uv.page].size(), kMips + 1);
                const std::uint32_t chart = atlas.first_placement[i] + mesh.chart_of_triangle[t];
                for (std::uint32_t point = 0; point < 45; ++point) {
                    const double a = point % 9 / 8.0, b = (1.0 - a) * (point / 9 / 4.0);
                    const double u = uv.texels[0].x + a * (double{uv.texels[1].x} - uv.texels[0].x) +
                                     b * (double{uv.texels[2].x} - uv.texels[0].x);
                    const double v = uv.texels[0].y + a * (double{uv.texels[1].y} - uv.texels[0].y) +
                                     b * (double{uv.texels[2].y} - uv.texels[0].y);
                    for (const Lightmap& map : pages[uv.page]) {
                        const double side = std::exp2(map.mip), x = u / side, y = v / side;
                        for (double row = std::floor(y) - 2.0; row <= y + 2.0; ++row)
                            for (double column = std::floor(x) - 2.0; column <= x + 2.0; ++column) {
                                if (std::abs(column + 0.5 - x) >= reach || std::abs(row + 0.5 - y) >= reach) continue;
                                const std::uint32_t texel =
                                    texel_at_pixel(map.texel_at, map.width, map.height,
                                                   static_cast<std::int32_t>(column), static_cast<std::int32_t>(row));
                                ASSERT_NE(texel, kNone) << "mip " << map.mip << " of " << scene.instances[i].name;
                                ASSERT_EQ(map.chart[texel], chart) << "mip " << map.mip;
                                ++looked;
                            }
                    }
                }
            }
        }
        EXPECT_GT(looked, 1000u);
    }
}

TEST(Bake, NoLightIsAnErrorThatNamesTheRemedy) {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.8f});
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}); });
    Context context(1);
    BakeSink sink{[](const auto&, const auto&, const auto&) { return success(); },
                  [](const auto&) { return success(); }};
    const auto result = bake(b.build(), {}, sink, context);
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().text().find("--sky"), std::string::npos);
}

// A lamp above the floor, and one below it, whose light does not get through.
TEST(Bake, WarnsWhereNoLightReachesAnyTexel) {
    for (const float height : {1.0f, -1.0f}) {
        test::SceneBuilder b;
        const auto white = b.material({0.8f, 0.8f, 0.8f});
        b.object("floor", white, [](Mesh& m) { test::add_quad(m, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}); });
        b.light(LightShape::point).position = {0.5f, height, 0.5f};
        Context context(1);
        BakeSink sink{[](const auto&, const auto&, const auto&) { return success(); },
                      [](const auto&) { return success(); }};
        ASSERT_TRUE(bake(b.build(), test::small_options(), sink, context).ok());
        EXPECT_EQ(context.diagnostics.count("no-light"), height < 0.0f ? 1u : 0u);
    }
}

BakeSink no_sink() {
    return {[](const auto&, const auto&, const auto&) { return success(); }, [](const auto&) { return success(); }};
}

// A floor half of which is behind a wall of its own height, and blocked from above: half its texels are black, and no
// number of samples changes that. The other half converges.
TEST(Bake, TellsWhyTexelsAreNotWithinTheError) {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.8f});
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}); });
    b.object(
        "cover", b.material({0, 0, 0}),
        [](Mesh& m) {
            test::add_box(m, {-9, -1, -9}, {0.5f, 1, 9}, true);
        },
        {}, NodeClass::occluder);
    b.light(LightShape::point).position = {2.0f, 1.0f, 0.5f};
    BakeOptions options = test::small_options();
    options.texels_per_metre = 32;
    options.samples = 256;
    options.stop = StopRule::error;
    options.error = 0.2;
    Context context(1);
    const Result<BakeReport> report = bake(b.build(), options, no_sink(), context);
    ASSERT_TRUE(report.ok());
    EXPECT_NEAR(report->share_unlit, 0.5, 2.0 / 32.0);  // the texels at the foot of the wall are either
    EXPECT_NEAR(report->share_within_error, 0.5, 3.0 / 32.0);
    EXPECT_LE(report->share_out_of_samples, 2.0 / 32.0);
}

// A room with a lamp in it and a crate on its floor, its walls facing in, and out.
TEST(Bake, NamesNodesThatAreInsideOut) {
    for (const bool inward : {true, false}) {
        test::SceneBuilder b;
        const auto white = b.material({0.8f, 0.8f, 0.8f});
        b.object("walls", white, [&](Mesh& m) { test::add_box(m, {0, 0, 0}, {2, 2, 2}, inward); });
        b.object("crate", white, [](Mesh& m) { test::add_box(m, {0.5f, 0.3f, 0.5f}, {1, 0.8f, 1}, false); });
        b.light(LightShape::point).position = {1.5f, 1.5f, 1.5f};
        Context context(2);
        ASSERT_TRUE(bake(b.build(), test::small_options(), no_sink(), context).ok());
        const auto names = [&](const char* code) {
            std::vector<std::string> out;
            for (const Diagnostic& d : context.diagnostics.all())
                if (d.code == code) out.insert(out.end(), d.examples.begin(), d.examples.end());
            return out;
        };
        using Names = std::vector<std::string>;
        EXPECT_EQ(names("inside-out"), inward ? Names{} : Names{"walls"});
        EXPECT_EQ(names("backs-seen"), inward ? Names{} : Names{"crate"});
    }
}

// The megabytes that an error says are needed; 0 where it says none.
std::uint64_t megabytes_needed(const Error& error) {
    const std::size_t at = error.message.find("need about ");
    return at == std::string::npos ? 0 : std::strtoull(error.message.c_str() + at + 11, nullptr, 10);
}

TEST(Bake, TooLittleMemoryIsAnErrorThatSaysHowMuchIsNeeded) {
    BakeOptions options = test::small_options();
    options.max_memory_bytes = 1 << 20;
    Context context(1);
    const auto result = bake(test::room(), options, no_sink(), context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::out_of_memory);
    const std::uint64_t needed = megabytes_needed(result.error());
    ASSERT_GT(needed, 1u) << result.error().message;
    // Just that is enough; less is not.
    options.max_memory_bytes = needed << 20;
    const auto enough = bake(test::room(), options, no_sink(), context);
    ASSERT_TRUE(enough.ok()) << enough.error().text();
    EXPECT_LE(enough->predicted_memory_bytes, needed << 20);
    options.max_memory_bytes = (needed - 1) << 20;
    const auto less = bake(test::room(), options, no_sink(), context);
    ASSERT_FALSE(less.ok());
    EXPECT_EQ(megabytes_needed(less.error()), needed);
}

// A density whose charts alone take more is an error before they are drawn, and says what to lower.
TEST(Bake, ADensityThatNoMemoryHoldsIsNotDrawn) {
    BakeOptions options = test::small_options();
    options.texels_per_metre = 1e6;
    options.max_memory_bytes = 2 << 20;  // a wall of 4096 x 4096 texels takes as much
    Context context(1);
    const auto result = bake(test::room(), options, no_sink(), context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::out_of_memory);
    EXPECT_NE(result.error().message.find("masks of"), std::string::npos) << result.error().message;
    EXPECT_NE(result.error().remedy.find("--texels-per-metre"), std::string::npos);
    EXPECT_NE(result.error().remedy.find("--max-memory"), std::string::npos);
}

// With a layout to keep nothing is traced for it: its density is given, and new charts are those of `lumel atlas`.
TEST(Bake, SealedChartsAreNotLookedForInALayoutThatIsKept) {
    const Scene scene = test::room();
    BakeOptions options = test::small_options();
    options.samples = 1;
    options.texels_per_metre = 0.0;
    options.resolution_width = options.resolution_height = 64;
    const auto record = std::make_shared<AtlasRecord>();
    BakeSink sink = no_sink();
    sink.layout = [&](const WorldGeometry&, const ChartSet& charts, const Atlas& atlas) {
        record->density = atlas.density;
        record->pages = atlas.pages;
        const std::vector<ChartName> names = chart_names(scene, charts);
        record->charts.clear();
        for (std::size_t i = 0; i < names.size(); ++i)
            record->charts.push_back({names[i], atlas.placements[i].page, atlas.placements[i].box});
        return success();
    };
    const auto looked_for = [&] {
        Context context(1);
        const auto report = bake(scene, options, sink, context);
        EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.error().text());
        return report.ok() && std::ranges::any_of(report->stages, [](const auto& s) { return s.stage == "sealed"; });
    };
    EXPECT_TRUE(looked_for());
    options.atlas = std::make_shared<const AtlasRecord>(*record);
    EXPECT_FALSE(looked_for());
    EXPECT_EQ(record->density, options.atlas->density);
}

// Where the cells do not fit, the default bakes without them and says so; who asked for them is told what to do.
TEST(Bake, CellsGiveWayToTheMemoryAllowed) {
    BakeOptions options = test::small_options();
    options.texels_per_metre = 60;
    const auto run = [&](Integrator integrator, std::uint64_t megabytes) {
        options.integrator = integrator;
        options.samples = 1024;
        options.max_memory_bytes = megabytes << 20;
        Context context(2);
        BakeSink sink = no_sink();
        std::string end;
        sink.layout = [&](const auto&, const auto&, const Atlas&) -> Status {
            end = context.diagnostics.count("no-cells") > 0 ? "paths" : "as asked";
            return Error{ErrorCode::cancelled, "seen enough", {}, {}};
        };
        const auto result = bake(test::room(), options, sink, context);
        return end.empty() ? result.error().text() : end;
    };
    const std::string refusal = run(Integrator::cells, 1);
    EXPECT_NE(refusal.find("--integrator paths"), std::string::npos) << refusal;
    // Between what both need there is room for a bake without cells.
    std::uint64_t paths = 64, cells = 64;
    while (run(Integrator::paths, paths) != "as asked") ++paths;
    while (run(Integrator::cells, cells) != "as asked") ++cells;
    ASSERT_LT(paths + 1, cells);
    EXPECT_EQ(run(Integrator::automatic, cells), "as asked");
    EXPECT_EQ(run(Integrator::automatic, cells - 1), "paths");
}

// Pages shrink until they fit, and the warnings are those of the layout that is used.
TEST(Bake, PagesShrinkToTheMemoryAllowed) {
    BakeOptions options = test::small_options();
    options.texels_per_metre = 200;
    options.samples = 1;
    options.bounces = 0;
    std::vector<AtlasPage> pages;
    std::uint64_t clamped = 0;
    const auto predicted = [&](std::uint64_t max_memory) {
        options.max_memory_bytes = max_memory;
        Context context(2);
        BakeSink sink = no_sink();
        sink.layout = [&](const auto&, const auto&, const Atlas& atlas) -> Status {
            pages = atlas.pages;
            return Error{ErrorCode::cancelled, "seen enough", {}, {}};
        };
        (void)bake(test::room(), options, sink, context);
        clamped = context.diagnostics.count("chart-clamped");
        std::uint64_t largest = 0;
        for (const AtlasPage& page : pages) largest = std::max<std::uint64_t>(largest, page.width * page.height);
        return largest;
    };
    const std::uint64_t free = predicted(0);
    ASSERT_EQ(pages.size(), 1u);
    ASSERT_EQ(clamped, 0u);
    ASSERT_GT(free, 500000u);
    const std::uint64_t small = predicted(std::uint64_t{200} << 20);
    EXPECT_GT(pages.size(), 1u);
    EXPECT_LT(small, 300000u);
    // Two walls of 3 m and a floor are wider than 512 texels, however often the pages were halved to get there.
    EXPECT_LE(clamped, 6u);
    EXPECT_GT(clamped, 0u);
}

// Of a bake of several pages, with cells: every stage goes from its beginning to its end once, pages or not.
TEST(Bake, ProgressOfEachStageOnlyGrows) {
    BakeOptions options = test::small_options();
    options.texels_per_metre = 40;
    options.max_page = 128;
    options.samples = 2;
    options.integrator = Integrator::cells;
    Context context(2);
    std::map<std::string, double, std::less<>> seen;
    context.on_progress = [&](const Progress& p) {
        const std::string stage(p.stage);
        EXPECT_GE(p.fraction, seen[stage]) << stage;
        EXPECT_LE(p.fraction, 1.0) << stage;
        seen[stage] = p.fraction;
    };
    BakeSink sink;
    std::size_t pages = 0;
    sink.page = [&](const Lightmap&) {
        ++pages;
        context.report("write", 0.5);
        context.report("write", 1.0);
        return success();
    };
    ASSERT_TRUE(bake(test::room(), options, sink, context).ok());
    EXPECT_GT(pages, 2u);
    for (const char* stage : {"cells", "texels", "trace", "write"}) EXPECT_EQ(seen[stage], 1.0) << stage;
}

// The cells' layout, their view of each other, their gathering and solving are one stage: a bake that is cancelled at
// any point of it ends there.
TEST(Bake, CellsCanBeCancelledAnywhere) {
    BakeOptions options = test::small_options();
    options.integrator = Integrator::cells;
    for (const double at : {0.01, 0.1, 0.3, 0.95}) {
        Context context(2);
        double last = 0.0;
        context.on_progress = [&](const Progress& p) {
            EXPECT_FALSE(p.stage == "texels" || p.stage == "trace") << p.stage;
            if (p.stage != "cells") return;
            last = p.fraction;
            if (p.fraction >= at) context.request_cancel();
        };
        const auto result = bake(test::room(), options, no_sink(), context);
        ASSERT_FALSE(result.ok()) << at;
        EXPECT_EQ(result.error().code, ErrorCode::cancelled);
        EXPECT_GE(last, at);
    }
}

// What the light was traced in is there for pictures when the pages are done, without the cells.
TEST(Bake, TheEndSeesWhatWasTraced) {
    BakeSink sink = no_sink();
    std::uint64_t rays = 0;
    sink.finished = [&](const Transport& transport, BakeReport& report) {
        EXPECT_EQ(transport.cells, nullptr);
        EXPECT_GT(report.cells, 0u);
        rays = transport.tracer.statistics().rays;
        report.stages.push_back({"views", 1.0, 1.0});
        return success();
    };
    BakeOptions options = test::small_options();
    Context context(2);
    const auto report = bake(test::room(), options, sink, context);
    ASSERT_TRUE(report.ok()) << report.error().text();
    EXPECT_GT(rays, 0u);
    EXPECT_EQ(report->rays, rays);
    EXPECT_EQ(report->stages.back().stage, "views");
    sink.finished = [](const Transport&, BakeReport&) -> Status { return Error{ErrorCode::io, "no room", {}, {}}; };
    EXPECT_FALSE(bake(test::room(), options, sink, context).ok());
}

TEST(Bake, CancelledBakesStopAndSaySo) {
    Context context(2);
    BakeSink sink{[&](const auto&, const auto&, const auto&) {
                      context.request_cancel();
                      return success();
                  },
                  [](const auto&) { return success(); }};
    const auto result = bake(test::room(), test::small_options(), sink, context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lumel
