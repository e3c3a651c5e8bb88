#include "io/mesh_split.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>

#include "base/check.h"
#include "base/hash.h"

namespace lumel {
namespace {

// What makes two corners one vertex.
struct CornerKey {
    std::uint32_t element, chart, u, v;
    friend bool operator==(const CornerKey&, const CornerKey&) = default;
};

struct CornerKeyHash {
    std::size_t operator()(const CornerKey& k) const {
        return mix64(mix64((std::uint64_t{k.element} << 32) | k.chart) ^ ((std::uint64_t{k.u} << 32) | k.v));
    }
};

// -0 and +0 are one place.
std::uint32_t bits(float v) { return std::bit_cast<std::uint32_t>(v + 0.0f); }

std::uint32_t lowest_group(const Primitive& primitive, const MeshCharts& charts,
                           std::span<const std::uint32_t> groups) {
    std::uint32_t lowest = kNone;
    for (std::uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t)
        if (const std::uint32_t chart = charts.chart_of_triangle[t]; chart != kNone)
            lowest = std::min(lowest, groups[chart]);
    return lowest;
}

// Renumbers the vertices by element, ties by first use: an unsplit primitive keeps the file's own order.
void sort_vertices(MeshPart& part) {
    std::vector<std::uint32_t> order(part.element.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return part.element[a] != part.element[b] ? part.element[a] < part.element[b] : a < b;
    });
    std::vector<std::uint32_t> place(order.size());
    MeshPart sorted;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        const std::uint32_t v = order[i];
        place[v] = i;
        sorted.element.push_back(part.element[v]);
        sorted.mesh_vertex.push_back(part.mesh_vertex[v]);
        sorted.chart.push_back(part.chart[v]);
        sorted.chart_uv.push_back(part.chart_uv[v]);
        sorted.corner.push_back(part.corner[v]);
    }
    for (std::uint32_t& index : part.indices) index = place[index];
    sorted.primitive = part.primitive;
    sorted.group = part.group;
    sorted.triangles = std::move(part.triangles);
    sorted.indices = std::move(part.indices);
    part = std::move(sorted);
}

// Fills vertices and indices from the part's triangles.
class VertexIndexer {
public:
    VertexIndexer(MeshPart& part, const Mesh& mesh, const MeshCharts& charts,
                  std::span<const std::uint32_t> element_of_vertex)
        : part_(part), mesh_(mesh), charts_(charts), element_of_vertex_(element_of_vertex) {}

    void run() {
        part_.indices.resize(3 * part_.triangles.size());
        for (std::uint32_t k = 0; k < part_.triangles.size(); ++k)
            if (has_chart(k)) index_charted(k);
        // Zero-area triangles show nothing: any vertex of the same element will do.
        for (std::uint32_t v = 0; v < part_.element.size(); ++v) any_of_element_.try_emplace(part_.element[v], v);
        for (std::uint32_t k = 0; k < part_.triangles.size(); ++k)
            if (!has_chart(k)) index_stray(k);
        sort_vertices(part_);
    }

private:
    [[nodiscard]] bool has_chart(std::uint32_t k) const {
        return charts_.chart_of_triangle[part_.triangles[k]] != kNone;
    }

    void index_charted(std::uint32_t k) {
        const std::uint32_t t = part_.triangles[k];
        for (std::uint32_t c = 0; c < 3; ++c) {
            const std::uint32_t vertex = mesh_.triangles[t][c];
            const Vec2 uv = charts_.uv[t][c];
            const CornerKey key{element_of_vertex_[vertex], charts_.chart_of_triangle[t], bits(uv.x), bits(uv.y)};
            const auto [at, added] = seen_.try_emplace(key, next_vertex());
            if (added) add_vertex(vertex, key.chart, uv, 3 * k + c);
            part_.indices[3 * k + c] = at->second;
        }
    }

    void index_stray(std::uint32_t k) {
        for (std::uint32_t c = 0; c < 3; ++c) {
            const std::uint32_t vertex = mesh_.triangles[part_.triangles[k]][c];
            const auto [at, added] = any_of_element_.try_emplace(element_of_vertex_[vertex], next_vertex());
            if (added) add_vertex(vertex, kNone, Vec2{}, 3 * k + c);
            part_.indices[3 * k + c] = at->second;
        }
    }

    [[nodiscard]] std::uint32_t next_vertex() const { return static_cast<std::uint32_t>(part_.element.size()); }

    void add_vertex(std::uint32_t vertex, std::uint32_t chart, Vec2 uv, std::uint32_t corner) {
        part_.element.push_back(element_of_vertex_[vertex]);
        part_.mesh_vertex.push_back(vertex);
        part_.chart.push_back(chart);
        part_.chart_uv.push_back(uv);
        part_.corner.push_back(corner);
    }

    MeshPart& part_;
    const Mesh& mesh_;
    const MeshCharts& charts_;
    std::span<const std::uint32_t> element_of_vertex_;
    std::unordered_map<CornerKey, std::uint32_t, CornerKeyHash> seen_;
    std::unordered_map<std::uint32_t, std::uint32_t> any_of_element_;
};

}  // namespace

std::vector<MeshPart> split_mesh(const Mesh& mesh, const MeshCharts& charts,
                                 std::span<const std::uint32_t> group_of_chart,
                                 std::span<const std::uint32_t> element_of_vertex) {
    LUMEL_CHECK(charts.chart_of_triangle.size() == mesh.triangles.size(), mesh.name);
    LUMEL_CHECK(group_of_chart.size() == charts.charts.size(), mesh.name);
    LUMEL_CHECK(element_of_vertex.size() == mesh.positions.size(), mesh.name);
    std::vector<MeshPart> parts;
    for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p) {
        const Primitive& primitive = mesh.primitives[p];
        const std::uint32_t stray = lowest_group(primitive, charts, group_of_chart);
        std::vector<MeshPart> of_primitive;  // by group, ascending
        for (std::uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
            const std::uint32_t chart = charts.chart_of_triangle[t];
            const std::uint32_t group = chart == kNone ? stray : group_of_chart[chart];
            auto at = std::lower_bound(of_primitive.begin(), of_primitive.end(), group,
                                       [](const MeshPart& part, std::uint32_t g) { return part.group < g; });
            if (at == of_primitive.end() || at->group != group) {
                at = of_primitive.insert(at, MeshPart{});
                at->primitive = p;
                at->group = group;
            }
            at->triangles.push_back(t);
        }
        for (MeshPart& part : of_primitive) {
            VertexIndexer(part, mesh, charts, element_of_vertex).run();
            parts.push_back(std::move(part));
        }
    }
    return parts;
}

}  // namespace lumel
