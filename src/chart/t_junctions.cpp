#include "chart/t_junctions.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "chart/patch.h"

namespace lumel {
namespace {

constexpr double kPlanarCos = 0.9994;        // 2 degrees
constexpr double kSamePlaneCos = 0.99998;    // 0.36 degrees: many in a row stay within the above
constexpr double kAntiparallelCos = 0.9999;  // 0.8 degrees: the ends decide how near edges are

Eigen::Vector3d to_double(Vec3 v) { return {v.x, v.y, v.z}; }

struct BorderEdge {
    std::uint32_t edge;
    Eigen::Vector3d from, direction;
    double length;
    Eigen::AlignedBox3d box;

    [[nodiscard]] Eigen::Vector3d at(double s) const { return from + s * direction; }
    [[nodiscard]] double along(const Eigen::Vector3d& p) const { return direction.dot(p - from); }
};

std::vector<BorderEdge> border_edges(const Mesh& mesh, const MeshTopology& topology) {
    std::vector<BorderEdge> out;
    for (std::uint32_t e = 0; e < topology.twin.size(); ++e) {
        if (topology.twin[e] != kNone || topology.area[e / 3] == 0.0) continue;
        const Eigen::Vector3d a = to_double(mesh.positions[corner_vertex(mesh, e)]),
                              b = to_double(mesh.positions[corner_vertex(mesh, next_edge(e))]);
        const double length = (b - a).norm();
        if (length == 0.0) continue;
        Eigen::AlignedBox3d box(a);
        box.extend(b);
        out.push_back({e, a, (b - a) / length, length, box});
    }
    return out;
}

// ---- A tree of their boxes ------------------------------------------------------------------------------------------

class EdgeTree {
public:
    EdgeTree(const std::vector<BorderEdge>& edges, double margin) : edges_(edges), margin_(margin) {
        order_.resize(edges.size());
        std::iota(order_.begin(), order_.end(), 0u);
        if (!edges.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
    }

    // Calls visit(j) for the edges whose boxes come near that of edge i; stops after as many as no clean mesh has.
    template <class Visit>
    void query(std::uint32_t i, const Visit& visit) const {
        constexpr std::uint32_t kMostVisits = 4096;
        if (nodes_.empty()) return;
        Eigen::AlignedBox3d box = edges_[i].box;
        box.min().array() -= margin_;
        box.max().array() += margin_;
        std::uint32_t visits = 0;
        std::vector<std::uint32_t> stack{0};
        while (!stack.empty()) {
            const std::uint32_t self = stack.back();
            const Node& node = nodes_[self];
            stack.pop_back();
            if (!node.box.intersects(box)) continue;
            if (node.right != 0) {
                stack.push_back(node.right);
                stack.push_back(self + 1);
                continue;
            }
            for (std::uint32_t k = node.first; k < node.last; ++k) {
                if (++visits > kMostVisits) return;
                visit(order_[k]);
            }
        }
    }

private:
    static constexpr std::uint32_t kLeafSize = 4;

    struct Node {
        Eigen::AlignedBox3d box;
        std::uint32_t first, last;
        std::uint32_t right = 0;  // inner nodes: the second child; the first one follows its parent
    };

    void build(std::uint32_t first, std::uint32_t last) {
        const std::size_t self = nodes_.size();
        nodes_.push_back({{}, first, last});
        for (std::uint32_t k = first; k < last; ++k) nodes_[self].box.extend(edges_[order_[k]].box);
        if (last - first <= kLeafSize) return;
        Eigen::Index axis = 0;
        nodes_[self].box.sizes().maxCoeff(&axis);
        const std::uint32_t middle = first + (last - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const double ca = edges_[a].box.center()[axis], cb = edges_[b].box.center()[axis];
                             return ca != cb ? ca < cb : a < b;
                         });
        build(first, middle);
        nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
        build(middle, last);
    }

    const std::vector<BorderEdge>& edges_;
    double margin_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

// ---- Two edges ------------------------------------------------------------------------------------------------------

std::optional<SmoothContact> touch(const BorderEdge& a, const BorderEdge& b, double rounding) {
    if (a.direction.dot(b.direction) > -kAntiparallelCos) return std::nullopt;
    const double near = std::max(rounding, 1e-4 * std::min(a.length, b.length));
    const double from = std::max(0.0, a.along(b.at(b.length))), to = std::min(a.length, a.along(b.from));
    if (to - from <= 10.0 * near) return std::nullopt;
    const double b_from = b.along(a.at(from)), b_to = b.along(a.at(to));
    if ((a.at(from) - b.at(b_from)).norm() > near || (a.at(to) - b.at(b_to)).norm() > near) return std::nullopt;
    return SmoothContact{a.edge, b.edge, from / a.length, to / a.length, b_from / b.length, b_to / b.length, to - from};
}

}  // namespace

std::vector<SmoothContact> t_junctions(const Mesh& mesh, const MeshTopology& topology) {
    const std::vector<BorderEdge> edges = border_edges(mesh, topology);
    double largest = 0.0;
    for (const BorderEdge& e : edges)
        largest = std::max({largest, e.box.min().cwiseAbs().maxCoeff(), e.box.max().cwiseAbs().maxCoeff()});
    const double rounding = largest * 0x1p-21;
    const EdgeTree tree(edges, rounding);
    std::vector<SmoothContact> contacts;
    for (std::uint32_t i = 0; i < edges.size(); ++i)
        tree.query(i, [&](std::uint32_t j) {
            if (j <= i || edges[i].edge / 3 == edges[j].edge / 3) return;
            if (dot(topology.normal[edges[i].edge / 3], topology.normal[edges[j].edge / 3]) < kPlanarCos) return;
            if (const std::optional<SmoothContact> contact = touch(edges[i], edges[j], rounding))
                contacts.push_back(*contact);
        });
    std::sort(contacts.begin(), contacts.end(),
              [](const SmoothContact& x, const SmoothContact& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    return contacts;
}

std::vector<std::vector<std::uint32_t>> unite_across_t_junctions(const Mesh& mesh, const MeshTopology& topology,
                                                                 std::vector<std::vector<std::uint32_t>> clusters) {
    std::vector<std::uint32_t> cluster_of(topology.triangle_count(), kNone), root(clusters.size());
    std::iota(root.begin(), root.end(), 0u);
    for (std::uint32_t c = 0; c < clusters.size(); ++c)
        for (const std::uint32_t t : clusters[c]) cluster_of[t] = c;
    const auto find = [&](std::uint32_t c) {
        while (root[c] != c) c = root[c] = root[root[c]];
        return c;
    };
    std::vector<Eigen::Vector3d> normal;
    std::vector<bool> planar;
    for (const auto& cluster : clusters) {
        normal.push_back(mean_normal(topology, cluster));
        planar.push_back(is_planar(topology, cluster, normal.back(), kPlanarCos));
    }
    for (const SmoothContact& c : t_junctions(mesh, topology)) {
        const std::uint32_t a = cluster_of[c.a / 3], b = cluster_of[c.b / 3];
        const std::uint32_t x = find(a), y = find(b);
        if (!planar[a] || !planar[b] || normal[x].dot(normal[y]) < kSamePlaneCos) continue;
        root[std::max(x, y)] = std::min(x, y);
    }
    std::vector<std::vector<std::uint32_t>> united;
    std::vector<std::uint32_t> number(clusters.size(), kNone);
    for (std::uint32_t c = 0; c < clusters.size(); ++c) {
        std::uint32_t& n = number[find(c)];
        if (n == kNone) {
            n = static_cast<std::uint32_t>(united.size());
            united.emplace_back();
        }
        united[n].insert(united[n].end(), clusters[c].begin(), clusters[c].end());
    }
    for (auto& cluster : united) std::sort(cluster.begin(), cluster.end());
    return united;
}

}  // namespace lumel
