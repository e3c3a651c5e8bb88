// Layouts that are kept through edits of a scene.
#include "chart/atlas_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>

#include "base/hash.h"
#include "io/gltf_document.h"
#include "support/chart_layouts.h"
#include "support/test_data.h"

namespace lumel {
namespace {

using test::expect_clean;
using test::judge;
using test::Layout;
using test::Level;
using test::record_of;

Level with_paths(Level level) {
    for (Instance& instance : level.scene.instances) instance.path_hash = Hasher().text(instance.name).finish().low;
    return level;
}

// Instances and geometry anew after an edit.
Level edited(const Level& level, const std::function<void(std::vector<Instance>&)>& edit) {
    Level out;
    out.scene = level.scene;
    edit(out.scene.instances);
    Context context(1);
    auto geometry = flatten(out.scene, context);
    EXPECT_TRUE(geometry.ok());
    out.geometry = std::move(*geometry);
    return out;
}

ChartOptions usual() {
    ChartOptions options;
    options.texel_budget = 60000;
    return options;
}

struct Kept {
    std::size_t same = 0, moved = 0;
};

// Of the charts of instances of one name in both, how many have page, scale and offset to the bit. Counted by the names
// of nodes and the order of charts in their mesh: not by what is tested.
Kept compare(const Level& before, const Layout& then, const Level& after, const Layout& now) {
    Kept out;
    std::map<std::string, std::size_t> old;
    for (std::size_t i = 0; i < before.scene.instances.size(); ++i) old[before.scene.instances[i].name] = i;
    for (std::size_t i = 0; i < after.scene.instances.size(); ++i) {
        const auto at = old.find(after.scene.instances[i].name);
        if (at == old.end()) continue;
        const std::uint32_t a = then.atlas.first_placement[at->second], b = now.atlas.first_placement[i];
        for (std::uint32_t c = 0; b + c < now.atlas.first_placement[i + 1]; ++c) {
            const ChartPlacement &p = then.atlas.placements[a + c], &q = now.atlas.placements[b + c];
            const bool same = p.page == q.page && p.scale == q.scale && p.offset == q.offset && p.box == q.box;
            ++(same ? out.same : out.moved);
        }
    }
    return out;
}

Layout layout_keeping(const Level& level, const AtlasRecord& record, ChartOptions options, unsigned threads = 1) {
    Context context(threads);
    options.previous = &record;
    Layout out = test::layout(level, options, context);
    EXPECT_EQ(context.diagnostics.count("atlas-conflict"), 0u);
    return out;
}

class StickyAtlas : public testing::Test {
protected:
    StickyAtlas() : before(with_paths(test::mixed_level())) {
        Context context(1);
        then = test::layout(before, usual(), context);
        record = record_of(before, then);
    }
    std::string error_of(ChartOptions options) {
        options.previous = &record;
        Context context(1);
        const auto atlas = make_atlas(before.scene, before.geometry, then.charts, options, context);
        if (atlas.ok()) return "no error";
        EXPECT_EQ(atlas.error().code, ErrorCode::usage);
        EXPECT_EQ(atlas.error().where, "previous.json");
        return atlas.error().text();
    }
    Level before;
    Layout then;
    AtlasRecord record;
};

TEST_F(StickyAtlas, TheSameSceneKeepsItsLayout) {
    const Layout now = layout_keeping(before, record, usual());
    EXPECT_EQ(now.atlas.kept, then.atlas.placements.size());
    EXPECT_EQ(compare(before, then, before, now).same, then.atlas.placements.size());
    ASSERT_EQ(now.atlas.pages.size(), then.atlas.pages.size());
    EXPECT_EQ(now.atlas.pages[0].height, then.atlas.pages[0].height);
    EXPECT_EQ(now.atlas.density, then.atlas.density);
}

// Another order of instances, one gone, one new, one moved and turned: all but the new one stay.
TEST_F(StickyAtlas, EditsLeaveOtherChartsInPlace) {
    const Level after = edited(before, [](std::vector<Instance>& instances) {
        Instance fresh = instances[4];
        fresh.name = "a new one";
        fresh.path_hash = 77;
        fresh.transform.translation.z += 40.0f;
        Affine& moved = instances[7].transform;
        moved.translation.x += 3.7f;
        std::swap(moved.columns[0], moved.columns[1]);
        moved.columns[0] = moved.columns[0] * -1.0f;  // a turn by 90 degrees
        instances.erase(instances.begin() + 5);
        instances.push_back(fresh);
        std::reverse(instances.begin(), instances.end());
    });
    const Layout now = layout_keeping(after, record, usual());
    expect_clean(judge(after, now));
    const Kept kept = compare(before, then, after, now);
    EXPECT_EQ(kept.moved, 0u);
    EXPECT_GT(kept.same, 100u);
    EXPECT_EQ(now.atlas.kept, kept.same);
}

// What is scaled has another size and goes elsewhere; a denser node, too.
TEST_F(StickyAtlas, WhatChangesItsSizeIsNew) {
    const Level after = edited(before, [](std::vector<Instance>& instances) {
        for (Vec3& column : instances[0].transform.columns) column = column * 2.0f;
        instances[3].density_scale = 2.0f;
    });
    const Layout now = layout_keeping(after, record, usual());
    expect_clean(judge(after, now));
    const Kept kept = compare(before, then, after, now);
    EXPECT_GT(kept.moved, 0u);
    EXPECT_LE(kept.moved, 12u) << "two boxes of six sides";
}

// Copies that share path and shape are told apart by where they are.
TEST_F(StickyAtlas, CopiesOfOneNameKeepTheirOwnCharts) {
    Level copies = edited(before, [](std::vector<Instance>& instances) {
        for (Instance& instance : instances) instance.path_hash = 1;
    });
    Context context(1);
    then = test::layout(copies, usual(), context);
    record = record_of(copies, then);
    const Level after = edited(copies, [](std::vector<Instance>& instances) { instances.erase(instances.begin()); });
    EXPECT_EQ(compare(copies, then, after, layout_keeping(after, record, usual())).moved, 0u);
}

TEST_F(StickyAtlas, SameBitsForAnyNumberOfThreads) {
    const Level after = edited(before, [](std::vector<Instance>& instances) {
        instances[2].density_scale = 3.0f;
        instances.pop_back();
    });
    const Layout one = layout_keeping(after, record, usual(), 1), eight = layout_keeping(after, record, usual(), 8);
    EXPECT_EQ(compare(after, one, after, eight).moved, 0u);
}

TEST_F(StickyAtlas, SaysWhyALayoutCannotBeKept) {
    ChartOptions options = usual();
    options.texels_per_metre = 2.0 * record.density;
    EXPECT_NE(error_of(options).find("--texels-per-metre"), std::string::npos) << error_of(options);
    options = usual();
    options.max_page = 64;
    EXPECT_NE(error_of(options).find("--max-page 64"), std::string::npos) << error_of(options);
    options = usual();
    options.resolution_width = options.resolution_height = 512;
    EXPECT_NE(error_of(options).find("--resolution"), std::string::npos) << error_of(options);
    options = usual();
    options.masks.block = 4;
    EXPECT_NE(error_of(options).find("--mips 0 --block 4 is asked for"), std::string::npos) << error_of(options);
    record.masks.block = 4;
    EXPECT_NE(error_of(options).find("whole cells"), std::string::npos) << error_of(options);
    EXPECT_NE(error_of(usual()).find("kept apart under --filter bilinear --mips 0 --block 4"), std::string::npos);
    record.masks.block = 1;
    record.scene_wide = true;
    EXPECT_NE(error_of(usual()).find("TEXCOORD_1"), std::string::npos) << error_of(usual());
}

// A density that no chart of then was drawn at is that of a damaged file, or of another scene: new charts, or all,
// would be drawn at it.
TEST_F(StickyAtlas, ADensityThatNoChartHasIsNotBelieved) {
    const AtlasRecord good = record;
    record.density = 2e5;
    EXPECT_NE(error_of(usual()).find("none of its "), std::string::npos) << error_of(usual());
    EXPECT_NE(error_of(usual()).find("2e+05 per metre"), std::string::npos) << error_of(usual());
    record = good;
    for (AtlasRecord::Chart& chart : record.charts) chart.name.id += 1;
    EXPECT_NE(error_of(usual()).find("none of its "), std::string::npos) << error_of(usual());
    // One that is the same is enough.
    record.charts[3] = good.charts[3];
    EXPECT_EQ(layout_keeping(before, record, usual()).atlas.kept, 1u);
}

// The density of then may be asked for by its number, and the page by its size.
TEST_F(StickyAtlas, TheSameAskedForIsNoObstacle) {
    ChartOptions options = usual();
    options.texels_per_metre = record.density * (1.0 + 1e-7);
    options.resolution_width = record.pages[0].width;
    options.resolution_height = record.pages[0].height;
    EXPECT_EQ(layout_keeping(before, record, options).atlas.kept, then.atlas.placements.size());
}

// A record is foreign: what lies on top of another chart is packed anew.
TEST_F(StickyAtlas, ChartsOnTopOfEachOtherArePackedAnew) {
    for (AtlasRecord::Chart& chart : record.charts) chart.box.x = chart.box.y = 0;
    ChartOptions options = usual();
    options.previous = &record;
    Context context(1);
    const Layout now = test::layout(before, options, context);
    expect_clean(judge(before, now));
    EXPECT_GE(now.atlas.kept, 1u);
    EXPECT_LT(now.atlas.kept, 10u) << "but for one whose free corner has room for another";
    EXPECT_EQ(context.diagnostics.count("atlas-conflict"), record.charts.size() - now.atlas.kept);
}

// ---- Real scenes ----------------------------------------------------------------------------------------------------

class StickyScenes : public testing::TestWithParam<const char*> {};

// One object goes, another comes in another place: all others stay, and the atlas grows by 2 % at most on top of what
// the new one has more texels than the old one had.
TEST_P(StickyScenes, OneObjectGoesAndOneComes) {
    const auto path = test::data_file(std::string("scenes/") + GetParam());
    if (!path) GTEST_SKIP() << "no " << GetParam() << ": set LUMEL_DATA";
    Context context(2);
    auto loaded = load_scene(*path, context);
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    Level before{std::move(loaded->scene), {}};
    // Names that are unique, for compare(); paths stay as the file gave them.
    std::vector<std::uint32_t> textured;
    for (std::uint32_t i = 0; i < before.scene.instances.size(); ++i) {
        Instance& instance = before.scene.instances[i];
        instance.name += " " + std::to_string(i);
        if (instance.node_class == NodeClass::probe) instance.node_class = NodeClass::lightmap;
        if (instance.node_class == NodeClass::lightmap) textured.push_back(i);
    }
    before = edited(before, [](std::vector<Instance>&) {});
    const Layout then = test::layout(before, {}, context);
    const AtlasRecord record = record_of(before, then);
    // By their boxes: what charts have, whatever the pages have.
    const auto texels_of = [](const Atlas& atlas) {
        std::uint64_t sum = 0;
        for (const ChartPlacement& place : atlas.placements) sum += std::uint64_t{place.box.width} * place.box.height;
        return static_cast<double>(sum);
    };
    const auto texels = [](const Atlas& atlas) {
        std::uint64_t sum = 0;
        for (const AtlasPage& page : atlas.pages) sum += std::uint64_t{page.width} * page.height;
        return static_cast<double>(sum);
    };
    ASSERT_GT(textured.size(), 4u);
    for (const std::size_t turn : {0u, 1u, 2u}) {
        const std::uint32_t gone = textured[turn * textured.size() / 3];
        const std::uint32_t copied = textured[(turn * textured.size() / 3 + textured.size() / 2) % textured.size()];
        const Level after = edited(before, [&](std::vector<Instance>& instances) {
            Instance fresh = instances[copied];
            fresh.name = "fresh";
            fresh.path_hash = 12345;
            fresh.transform.translation.y += 100.0f;
            instances.push_back(fresh);
            instances.erase(instances.begin() + gone);
        });
        const Layout now = layout_keeping(after, record, {}, 2);
        const Kept kept = compare(before, then, after, now);
        EXPECT_EQ(kept.moved, 0u) << "without " << before.scene.instances[gone].name;
        EXPECT_GT(kept.same, 0u);
        const double growth = texels(now.atlas) / texels(then.atlas) - 1.0;
        const double more = texels_of(now.atlas) / texels_of(then.atlas) - 1.0;
        EXPECT_LE(growth, std::max(more, 0.0) + 0.02) << before.scene.instances[copied].name;
        RecordProperty("growth_percent_" + std::to_string(turn), std::to_string(100.0 * growth));
        RecordProperty("stayed_" + std::to_string(turn), std::to_string(kept.same));
        if (turn == 0) expect_clean(judge(after, now));
    }
}

INSTANTIATE_TEST_SUITE_P(Files, StickyScenes, testing::Values("godot_room.glb", "kenney_city.glb"),
                         [](const auto& info) {
                             const std::string name = info.param;
                             return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace lumel
