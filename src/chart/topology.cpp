#include "chart/topology.h"

#include "chart/eigen_vectors.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>

namespace lumel {
namespace {

// Compared as numbers: -0 and 0 are one position.
std::tuple<float, float, float> position_key(Vec3 p) { return {p.x, p.y, p.z}; }

std::vector<std::uint32_t> weld(const Mesh& mesh) {
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto key_a = position_key(mesh.positions[a]), key_b = position_key(mesh.positions[b]);
        return key_a != key_b ? key_a < key_b : a < b;
    });
    std::vector<std::uint32_t> point(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && position_key(mesh.positions[order[i]]) == position_key(mesh.positions[order[i - 1]]);
        point[order[i]] = same ? point[order[i - 1]] : order[i];
    }
    return point;
}

void measure_triangles(const Mesh& mesh, MeshTopology& topology) {
    topology.normal.assign(mesh.triangles.size(), Vec3{});
    topology.area.assign(mesh.triangles.size(), 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& v = mesh.triangles[t];
        const Eigen::Vector3d a = to_double(mesh.positions[v[0]]), b = to_double(mesh.positions[v[1]]),
                              c = to_double(mesh.positions[v[2]]);
        const Eigen::Vector3d cross = (b - a).cross(c - a);
        const double length = cross.norm();
        const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        if (!(length > kZeroAreaRatio * longest)) continue;
        const Eigen::Vector3d n = cross / length;
        topology.area[t] = 0.5 * length;
        topology.normal[t] = {static_cast<float>(n.x()), static_cast<float>(n.y()), static_cast<float>(n.z())};
    }
}

// An edge with its end points in ascending order, for grouping the triangles around it.
struct EdgeRecord {
    std::uint32_t low, high, edge;
    bool forward;  // the triangle runs from low to high
    bool operator<(const EdgeRecord& o) const { return std::tie(low, high, edge) < std::tie(o.low, o.high, o.edge); }
};

std::vector<EdgeRecord> collect_edges(const Mesh& mesh, const MeshTopology& topology) {
    std::vector<EdgeRecord> records;
    records.reserve(3 * mesh.triangles.size());
    for (std::uint32_t e = 0; e < 3 * mesh.triangles.size(); ++e) {
        if (topology.area[e / 3] == 0.0) continue;
        const std::uint32_t a = topology.point[corner_vertex(mesh, e)];
        const std::uint32_t b = topology.point[corner_vertex(mesh, next_edge(e))];
        records.push_back({std::min(a, b), std::max(a, b), e, a < b});
    }
    std::sort(records.begin(), records.end());
    return records;
}

// Pairs opposite edges of one group, the smoothest continuation first.
void pair_group(const EdgeRecord* first, const EdgeRecord* last, MeshTopology& topology) {
    constexpr std::ptrdiff_t kMaxFan = 32;  // more triangles around one edge than this: all of them end there
    if (last - first > kMaxFan) return;
    struct Candidate {
        float alignment;
        std::uint32_t a, b;
    };
    std::vector<Candidate> candidates;
    for (const EdgeRecord* f = first; f != last; ++f)
        for (const EdgeRecord* g = first; g != last; ++g)
            if (f->forward && !g->forward)
                candidates.push_back(
                    {dot(topology.normal[f->edge / 3], topology.normal[g->edge / 3]), f->edge, g->edge});
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
        return x.alignment != y.alignment ? x.alignment > y.alignment : std::tie(x.a, x.b) < std::tie(y.a, y.b);
    });
    for (const Candidate& c : candidates) {
        if (topology.twin[c.a] != kNone || topology.twin[c.b] != kNone) continue;
        topology.twin[c.a] = c.b;
        topology.twin[c.b] = c.a;
    }
}

}  // namespace

MeshTopology build_topology(const Mesh& mesh) {
    MeshTopology topology;
    topology.point = weld(mesh);
    measure_triangles(mesh, topology);
    topology.twin.assign(3 * mesh.triangles.size(), kNone);
    const std::vector<EdgeRecord> records = collect_edges(mesh, topology);
    for (std::size_t i = 0; i < records.size();) {
        std::size_t end = i + 1;
        while (end < records.size() && records[end].low == records[i].low && records[end].high == records[i].high)
            ++end;
        if (end - i > 1) pair_group(&records[i], &records[i] + (end - i), topology);
        i = end;
    }
    return topology;
}

}  // namespace lumel
