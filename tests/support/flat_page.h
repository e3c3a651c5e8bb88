// A page made by hand: triangles with given places in texels, and where they are in the world.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "chart/chart_set.h"
#include "support/world_builder.h"
#include "texel/texel_buffer.h"

namespace lumel::test {

// One mesh, one instance, one page. Triangles are on the plane y = 0 unless a corner is moved: texel (u, v) is at world
// (u, 0, -v) * metres_per_texel, and fronts look up.
struct FlatPage {
    std::vector<std::array<Vec2, 3>> texels;
    std::vector<std::uint32_t> chart;
    std::uint32_t width = 16, height = 16;
    float metres_per_texel = 1.0f;

    void add(std::array<Vec2, 3> corners, std::uint32_t in_chart = 0) {
        texels.push_back(corners);
        chart.push_back(in_chart);
    }
    // The parallelogram corner, corner + u, corner + u + v, corner + v.
    void add_quad(Vec2 corner, Vec2 u, Vec2 v, std::uint32_t in_chart = 0) {
        add({corner, corner + u, corner + u + v}, in_chart);
        add({corner, corner + u + v, corner + v}, in_chart);
    }
};

class BakedPage {
public:
    explicit BakedPage(const FlatPage& page, unsigned threads = 1) : context(threads) {
        Mesh mesh;
        MeshCharts mesh_charts;
        for (std::uint32_t t = 0; t < page.texels.size(); ++t) {
            for (const Vec2 p : page.texels[t])
                mesh.positions.push_back({p.x * page.metres_per_texel, 0, -p.y * page.metres_per_texel});
            mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
        }
        mesh.normals.assign(mesh.positions.size(), Vec3{0, 1, 0});
        mesh_charts.chart_of_triangle = page.chart;
        mesh_charts.uv = page.texels;
        const std::uint32_t chart_count = 1 + *std::max_element(page.chart.begin(), page.chart.end());
        mesh_charts.charts.resize(chart_count);
        WorldBuilder builder;
        builder.add_mesh(std::move(mesh));
        world = builder.build();
        charts.meshes.push_back(std::move(mesh_charts));
        atlas.pages = {{page.width, page.height}};
        atlas.first_placement = {0, chart_count};
        atlas.placements.assign(chart_count, {0, {1, 1}, {0, 0}});

        const auto by_page = triangles_by_page(world.scene, world.geometry, charts, atlas);
        auto result = rasterize_page(world.scene, world.geometry, charts, atlas, 0, by_page.at(0), context);
        if (result.ok()) {
            texels = std::move(result).value();
        } else {
            ADD_FAILURE() << result.error().text();
        }
    }

    [[nodiscard]] std::vector<SamplePoint> samples(std::size_t texel) const {
        std::array<SamplePoint, kSamplesPerTexel> points;
        const std::uint32_t n = sample_points(texels, texel, world.scene, world.geometry, charts, atlas, points);
        return {points.begin(), points.begin() + n};
    }
    [[nodiscard]] std::array<Vec2, 3> uv(std::uint32_t triangle) const {
        return atlas.triangle_uv(charts, world.geometry, world.scene, triangle).texels;
    }

    Context context;
    World world;
    ChartSet charts;
    Atlas atlas;
    TexelBuffer texels;
};

}  // namespace lumel::test
