#include "chart/t_junctions.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "base/union_find.h"
#include "chart/eigen_vectors.h"
#include "chart/patch.h"

namespace lumel {
namespace {

constexpr double kPlanarCos = 0.9994;        // 2 degrees
constexpr double kSamePlaneCos = 0.99998;    // 0.36 degrees
constexpr double kNearShare = 1e-4;          // of the shorter edge: how near two that touch are
constexpr double kAntiparallelCos = 0.9999;  // 0.8 degrees: the ends decide how near edges are

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

// Does the edge come as near to the box? By the axes of the box: exact but for the corners of what surrounds it.
bool comes_near(const BorderEdge& edge, const Eigen::AlignedBox3d& box, double margin) {
    double first = 0.0, last = edge.length;
    for (Eigen::Index c = 0; c < 3; ++c) {
        const double low = box.min()[c] - margin - edge.from[c], high = box.max()[c] + margin - edge.from[c];
        const double d = edge.direction[c];
        if (d == 0.0) {
            if (low > 0.0 || high < 0.0) return false;
            continue;
        }
        first = std::max(first, std::min(low / d, high / d));
        last = std::min(last, std::max(low / d, high / d));
    }
    return first <= last;
}

// ---- A tree of their boxes ------------------------------------------------------------------------------------------

class EdgeTree {
public:
    explicit EdgeTree(const std::vector<BorderEdge>& edges) : edges_(edges) {
        order_.resize(edges.size());
        std::iota(order_.begin(), order_.end(), 0u);
        if (!edges.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
    }

    // Calls visit(j) for the edges to whose boxes edge i comes as near; stops after as many as no clean mesh has.
    template <class Visit>
    void query(std::uint32_t i, double margin, const Visit& visit) const {
        constexpr std::uint32_t kMostVisits = 4096;
        if (nodes_.empty()) return;
        std::uint32_t visits = 0;
        std::vector<std::uint32_t> stack{0};
        while (!stack.empty()) {
            const std::uint32_t self = stack.back();
            const Node& node = nodes_[self];
            stack.pop_back();
            if (!comes_near(edges_[i], node.box, margin)) continue;
            if (node.right != 0) {
                stack.push_back(node.right);
                stack.push_back(self + 1);
                continue;
            }
            for (std::uint32_t k = node.first; k < node.last; ++k) {
                if (!comes_near(edges_[i], edges_[order_[k]].box, margin)) continue;
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
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

// ---- Two edges ------------------------------------------------------------------------------------------------------

std::optional<SmoothContact> touch(const BorderEdge& a, const BorderEdge& b, double rounding) {
    if (a.direction.dot(b.direction) > -kAntiparallelCos) return std::nullopt;
    const double near = std::max(rounding, kNearShare * std::min(a.length, b.length));
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
    const EdgeTree tree(edges);
    std::vector<SmoothContact> contacts;
    for (std::uint32_t i = 0; i < edges.size(); ++i)
        tree.query(i, std::max(rounding, kNearShare * edges[i].length), [&](std::uint32_t j) {
            if (j <= i || edges[i].edge / 3 == edges[j].edge / 3) return;
            if (dot(topology.normal[edges[i].edge / 3], topology.normal[edges[j].edge / 3]) < kPlanarCos) return;
            if (const std::optional<SmoothContact> contact = touch(edges[i], edges[j], rounding))
                contacts.push_back(*contact);
        });
    std::sort(contacts.begin(), contacts.end(),
              [](const SmoothContact& x, const SmoothContact& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    return contacts;
}

namespace {

// Flat clusters that become one. What they may deviate from one plane is counted as distances on the unit sphere, which
// add up to no less than what they are.
class FlatUnion {
public:
    FlatUnion(const MeshTopology& topology, const std::vector<std::vector<std::uint32_t>>& clusters)
        : sets_(clusters.size()) {
        for (const auto& cluster : clusters) {
            double area = 0.0, deviation = 0.0;
            const Eigen::Vector3d normal = mean_normal(topology, cluster);
            for (const std::uint32_t t : cluster) {
                area += topology.area[t];
                deviation = std::max(deviation, (to_double(topology.normal[t]) - normal).norm());
            }
            normal_.push_back(normal);
            flat_.push_back(is_planar(topology, cluster, normal, kPlanarCos));
            whole_.push_back({area * normal, deviation});
        }
    }

    std::uint32_t find(std::uint32_t c) { return sets_.find(c); }

    // Unites the clusters, and what they are of, where all of it is flat then.
    void unite(std::uint32_t a, std::uint32_t b) {
        if (!flat_[a] || !flat_[b] || normal_[a].dot(normal_[b]) < kSamePlaneCos) return;
        const std::uint32_t x = std::min(find(a), find(b)), y = std::max(find(a), find(b));
        if (x == y) return;
        const Eigen::Vector3d sum = whole_[x].normal + whole_[y].normal, mean = sum.normalized();
        const double deviation = std::max((whole_[x].normal.normalized() - mean).norm() + whole_[x].deviation,
                                          (whole_[y].normal.normalized() - mean).norm() + whole_[y].deviation);
        if (deviation * deviation > 2.0 - 2.0 * kPlanarCos) return;
        sets_.absorb(x, y);
        whole_[x] = {sum, deviation};
    }

private:
    struct Whole {
        Eigen::Vector3d normal;  // times the area
        double deviation;        // at most, of a triangle's normal
    };
    UnionFind sets_;
    std::vector<Eigen::Vector3d> normal_;  // of the clusters
    std::vector<bool> flat_;
    std::vector<Whole> whole_;  // of what is united, by its root
};

}  // namespace

std::vector<std::vector<std::uint32_t>> unite_across_t_junctions(const Mesh& mesh, const MeshTopology& topology,
                                                                 std::vector<std::vector<std::uint32_t>> clusters) {
    std::vector<std::uint32_t> cluster_of(topology.triangle_count(), kNone);
    for (std::uint32_t c = 0; c < clusters.size(); ++c)
        for (const std::uint32_t t : clusters[c]) cluster_of[t] = c;
    FlatUnion flat(topology, clusters);
    for (const SmoothContact& c : t_junctions(mesh, topology)) flat.unite(cluster_of[c.a / 3], cluster_of[c.b / 3]);
    std::vector<std::vector<std::uint32_t>> united;
    std::vector<std::uint32_t> number(clusters.size(), kNone);
    for (std::uint32_t c = 0; c < clusters.size(); ++c) {
        std::uint32_t& n = number[flat.find(c)];
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
