// Small levels laid out by charts and atlas, and judged by the independent checker.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "chart/atlas_record.h"
#include "chart/chart_set.h"
#include "support/chart_checker.h"
#include "support/meshes.h"

namespace lumel::test {

struct Level {
    Scene scene;
    WorldGeometry geometry;
};

inline Affine scaled(Vec3 s, Vec3 translation) {
    return {{Vec3{s.x, 0, 0}, Vec3{0, s.y, 0}, Vec3{0, 0, s.z}}, translation};
}

class LevelBuilder {
public:
    std::uint32_t mesh(Mesh m) {
        scene_.meshes.push_back(std::make_shared<const Mesh>(std::move(m)));
        return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
    }
    LevelBuilder& instance(std::uint32_t mesh, const Affine& transform = {}, NodeClass c = NodeClass::lightmap) {
        scene_.instances.push_back({"node " + std::to_string(scene_.instances.size()), mesh, transform, c, 1.0f});
        return *this;
    }
    Level build() {
        scene_.materials.emplace_back();
        scene_.display.meshes = scene_.meshes;
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i)
            scene_.display.instances.push_back({{}, scene_.instances[i].mesh, i});
        Context context(1);
        auto geometry = flatten(scene_, context);
        EXPECT_TRUE(geometry.ok());
        return {std::move(scene_), std::move(*geometry)};
    }

private:
    Scene scene_;
};

struct Layout {
    ChartSet charts;
    Atlas atlas;
};

inline Layout layout(const Level& level, const ChartOptions& options, Context& context) {
    auto charts = make_charts(level.scene, level.geometry, options, context);
    EXPECT_TRUE(charts.ok()) << (charts.ok() ? "" : charts.error().text());
    if (!charts.ok()) return {};
    auto atlas = make_atlas(level.scene, level.geometry, *charts, options, context);
    EXPECT_TRUE(atlas.ok()) << (atlas.ok() ? "" : atlas.error().text());
    if (!atlas.ok()) return {};
    return {std::move(*charts), std::move(*atlas)};
}

// As manifest.json has it.
inline AtlasRecord record_of(const Level& level, const Layout& l) {
    AtlasRecord out;
    out.where = "previous.json";
    out.scene_wide = l.charts.scene_wide;
    out.masks = l.atlas.masks;
    out.density = l.atlas.density;
    out.pages = l.atlas.pages;
    const std::vector<ChartName> names = chart_names(level.scene, l.charts);
    EXPECT_EQ(names.size(), l.atlas.placements.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        const ChartPlacement& place = l.atlas.placements[i];
        if (place.page != kNone) out.charts.push_back({names[i], place.page, place.box});
    }
    return out;
}

inline LayoutReport judge(const Level& level, const Layout& l) {
    return ChartChecker(level.scene, level.geometry, l.charts, l.atlas).run();
}

inline void expect_clean(const LayoutReport& report) {
    EXPECT_GT(report.texels, 0u);
    EXPECT_GT(report.samples, 0u);
    EXPECT_EQ(report.shared_texels, 0u);
    EXPECT_EQ(report.outside, 0u);
    EXPECT_EQ(report.unmapped, 0u);
    EXPECT_EQ(report.flipped, 0u);
    EXPECT_EQ(report.overlaps, 0u);
}

// Boxes, tubes and spheres at many places and scales, one mirrored, one stretched, one that gets no texels.
inline Level mixed_level() {
    LevelBuilder b;
    const std::uint32_t box = b.mesh(test::box({1, 2, 3})), ball = b.mesh(test::sphere(12, 0.7f)),
                        tube = b.mesh(test::cylinder(20, 1.0f, 0.5f, 3.0f)), floor = b.mesh(test::flat_grid(8, 10.0f));
    for (int i = 0; i < 12; ++i) {
        const float x = 4.0f * static_cast<float>(i);
        const float s = i % 3 == 0 ? 1.0f : 0.4f + 0.1f * static_cast<float>(i);
        b.instance(box, scaled({s, s, i == 5 ? -s : s}, {x, 0, 0}));
        b.instance(ball, scaled({s, s, s}, {x, 5, 0}));
        b.instance(tube, scaled({s, s, s}, {x, 10, 0}));
    }
    b.instance(box, scaled({20, 0.1f, 3}, {0, 0, 9}));
    b.instance(ball, scaled({1, 1, 1}, {0, 0, 20}), NodeClass::volume);
    b.instance(floor);
    return b.build();
}

}  // namespace lumel::test
