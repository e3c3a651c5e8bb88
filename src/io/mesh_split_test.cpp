#include "io/mesh_split.h"

#include <gtest/gtest.h>

#include <numeric>

namespace lumel {
namespace {

// A strip of `n` quads along x in one primitive, vertices shared; charts as asked per triangle, UV = position.
struct Strip {
    Mesh mesh;
    MeshCharts charts;
    std::vector<std::uint32_t> elements;

    explicit Strip(std::vector<std::uint32_t> chart_of_triangle) {
        const auto count = static_cast<std::uint32_t>(chart_of_triangle.size());
        for (std::uint32_t i = 0; i < count + 2; ++i) mesh.positions.push_back({float(i / 2), float(i % 2), 0});
        std::uint32_t charts_used = 0;
        for (std::uint32_t t = 0; t < count; ++t) {
            mesh.triangles.push_back(t % 2 == 0 ? Triangle{t, t + 1, t + 2} : Triangle{t + 1, t, t + 2});
            std::array<Vec2, 3> uv{};
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3 p = mesh.positions[mesh.triangles[t][c]];
                uv[c] = {p.x, p.y};
            }
            charts.uv.push_back(uv);
            if (chart_of_triangle[t] != kNone) charts_used = std::max(charts_used, chart_of_triangle[t] + 1);
        }
        charts.chart_of_triangle = std::move(chart_of_triangle);
        charts.charts.resize(charts_used);
        mesh.primitives.push_back({0, count + 2, 0, count, kNone});
        elements.resize(mesh.positions.size());
        std::iota(elements.begin(), elements.end(), 0u);
    }
    [[nodiscard]] std::vector<MeshPart> split(std::vector<std::uint32_t> groups) const {
        return split_mesh(mesh, charts, groups, elements);
    }
};

TEST(SplitMesh, OneChartKeepsTheFilesVertices) {
    const Strip strip({0, 0, 0, 0});
    const auto parts = strip.split({0});
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].element, strip.elements);
    EXPECT_EQ(parts[0].indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5}));
}

TEST(SplitMesh, VerticesDoubleOnlyAlongTheCut) {
    const Strip strip({0, 0, 1, 1});
    const auto parts = strip.split({0, 0});
    ASSERT_EQ(parts.size(), 1u);
    // Vertices 2 and 3 lie in both charts.
    EXPECT_EQ(parts[0].element, (std::vector<std::uint32_t>{0, 1, 2, 2, 3, 3, 4, 5}));
    for (std::size_t i = 0; i < parts[0].indices.size(); ++i) {
        const std::uint32_t t = parts[0].triangles[i / 3], v = parts[0].indices[i];
        EXPECT_EQ(parts[0].element[v], strip.mesh.triangles[t][i % 3]);
        EXPECT_EQ(parts[0].chart[v], strip.charts.chart_of_triangle[t]);
        EXPECT_EQ(parts[0].chart_uv[v], strip.charts.uv[t][i % 3]);
    }
}

TEST(SplitMesh, OnePartPerPage) {
    const Strip strip({0, 1, 0, 1});
    const auto parts = strip.split({5, 2});
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].group, 2u);
    EXPECT_EQ(parts[0].triangles, (std::vector<std::uint32_t>{1, 3}));
    EXPECT_EQ(parts[1].group, 5u);
    EXPECT_EQ(parts[1].triangles, (std::vector<std::uint32_t>{0, 2}));
}

TEST(SplitMesh, ZeroAreaTrianglesGoAlong) {
    const Strip strip({kNone, 0, 1, kNone});
    const auto parts = strip.split({3, 1});
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].triangles, (std::vector<std::uint32_t>{0, 2, 3}));
    EXPECT_EQ(parts[1].triangles, (std::vector<std::uint32_t>{1}));
    // They share the vertices that are there: of 0 1 2 | 2 3 4 | 4 3 5 0, 1 and 5 are theirs alone.
    EXPECT_EQ(parts[0].element, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
}

TEST(SplitMesh, ChartsWithoutAPageStayApart) {
    const Strip strip({0, 1});
    const auto parts = strip.split({kNone, 0});
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[1].group, kNone);
    EXPECT_EQ(parts[1].triangles, (std::vector<std::uint32_t>{0}));
}

// A file without normals: the loader gives each corner a vertex of its own; they are one element again.
TEST(SplitMesh, CornersDoubledByTheLoaderAreMergedAgain) {
    const Strip shared({0, 0, 0, 0});
    Strip strip = shared;
    strip.mesh.positions.clear();
    strip.elements.clear();
    for (Triangle& triangle : strip.mesh.triangles)
        for (std::uint32_t& v : triangle) {
            strip.elements.push_back(v);
            strip.mesh.positions.push_back(shared.mesh.positions[v]);
            v = static_cast<std::uint32_t>(strip.elements.size() - 1);
        }
    const auto parts = strip.split({0});
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].element, shared.elements);
}

TEST(SplitMesh, PrimitivesStayApart) {
    Strip strip({0, 0, 0, 0});
    strip.mesh.primitives = {{0, 6, 0, 2, 0}, {0, 6, 2, 2, 1}};
    const auto parts = strip.split({0});
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].primitive, 0u);
    EXPECT_EQ(parts[1].primitive, 1u);
    EXPECT_EQ(parts[1].triangles, (std::vector<std::uint32_t>{2, 3}));
    EXPECT_EQ(parts[1].element, (std::vector<std::uint32_t>{2, 3, 4, 5}));
}

}  // namespace
}  // namespace lumel
