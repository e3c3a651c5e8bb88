#include "seam/find_seams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/cancelled.h"
#include "base/parallel.h"

namespace lumel {
namespace {

struct Box {
    Vec3 low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};

    void add(Vec3 p) {
        low = min(low, p);
        high = max(high, p);
    }
    [[nodiscard]] bool meets(const Box& other) const {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y &&
               low.z <= other.high.z && other.low.z <= high.z;
    }
};

// Metres within which another line is the same.
float distance_of(const BorderEdge& edge, const SeamRule& rule) {
    const float texels = length(edge.texels_to - edge.texels_from), metres = length(edge.to - edge.from);
    return std::min(rule.distance, rule.distance_in_texels * metres / std::max(texels, 1e-6f));
}

// A binary tree of boxes over the edges: split at the median of the widest side of the middles.
class EdgeTree {
public:
    EdgeTree(std::span<const BorderEdge> edges, const SeamRule& rule) : order_(edges.size()) {
        boxes_.reserve(edges.size());
        for (const BorderEdge& edge : edges) {
            const float margin = 0.5f * distance_of(edge, rule);
            Box box;
            for (const Vec3 p : {edge.from, edge.to}) {
                box.add(p - Vec3{margin, margin, margin});
                box.add(p + Vec3{margin, margin, margin});
            }
            boxes_.push_back(box);
        }
        std::iota(order_.begin(), order_.end(), 0u);
        if (!edges.empty()) build(0, edges.size());
    }

    // Calls visit(j) for the edges whose boxes meet that of edge i.
    template <class Visit>
    void for_each_near(std::uint32_t i, Visit&& visit) const {
        std::array<std::uint32_t, 64> stack;  // halves of halves: no deeper than there are bits
        std::size_t depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const Node& node = nodes_[stack[--depth]];
            if (!node.box.meets(boxes_[i])) continue;
            if (node.right != 0) {
                stack[depth++] = node.right;
                stack[depth++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
                continue;
            }
            for (std::uint32_t k = node.begin; k < node.end; ++k)
                if (boxes_[order_[k]].meets(boxes_[i])) visit(order_[k]);
        }
    }

private:
    static constexpr std::size_t kLeaf = 4;
    struct Node {
        Box box;
        std::uint32_t begin = 0, end = 0, right = 0;  // right 0: a leaf; the left child follows its parent
    };

    std::uint32_t build(std::size_t begin, std::size_t end) {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back({{}, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), 0});
        Box box, middles;
        for (std::size_t k = begin; k < end; ++k) {
            box.add(boxes_[order_[k]].low);
            box.add(boxes_[order_[k]].high);
            middles.add(middle(order_[k]));
        }
        nodes_[index].box = box;
        if (end - begin <= kLeaf) return index;
        const Vec3 size = middles.high - middles.low;
        const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t half = (begin + end) / 2;
        const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
        std::nth_element(at(begin), at(half), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const float x = middle(a)[axis], y = middle(b)[axis];
            return x != y ? x < y : a < b;
        });
        build(begin, half);
        nodes_[index].right = build(half, end);
        return index;
    }
    [[nodiscard]] Vec3 middle(std::uint32_t i) const { return (boxes_[i].low + boxes_[i].high) * 0.5f; }

    std::vector<Box> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

struct Line {
    std::array<double, 3> from, direction;
    double length;

    explicit Line(const BorderEdge& edge) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            from[k] = double{edge.from[k]};
            direction[k] = double{edge.to[k]} - from[k];
            sum += direction[k] * direction[k];
        }
        length = std::sqrt(sum);
        for (double& d : direction) d /= length;
    }
};

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

constexpr double kParallelCosine = 0.99;  // 8 degrees: what crosses at a larger angle shares a corner, not a line

// Where along line a, in metres, line b is within `distance`: the offset between the two is linear in the place along
// a, so that its square is a parabola.
std::optional<std::array<double, 2>> shared_piece(const Line& a, const Line& b, double distance) {
    const double c = dot(a.direction, b.direction);
    if (std::fabs(c) < kParallelCosine) return std::nullopt;
    std::array<double, 3> p, q;  // offset = p + q t
    for (std::size_t k = 0; k < 3; ++k) p[k] = a.from[k] - b.from[k];
    const double s0 = dot(p, b.direction);
    for (std::size_t k = 0; k < 3; ++k) {
        p[k] -= s0 * b.direction[k];
        q[k] = a.direction[k] - c * b.direction[k];
    }
    double low = std::max(0.0, std::min(-s0 / c, (b.length - s0) / c));
    double high = std::min(a.length, std::max(-s0 / c, (b.length - s0) / c));
    const double qq = dot(q, q), pq = dot(p, q), rest = dot(p, p) - distance * distance;
    if (qq * a.length * a.length < 1e-6 * distance * distance) {  // as good as parallel
        if (rest > 0.0) return std::nullopt;
    } else {
        const double root = pq * pq - qq * rest;
        if (root < 0.0) return std::nullopt;
        low = std::max(low, (-pq - std::sqrt(root)) / qq);
        high = std::min(high, (-pq + std::sqrt(root)) / qq);
    }
    // Two edges one after the other, or at an angle, are near each other at a corner alone.
    if (high - low < std::min(2.0 * distance, 0.5 * std::min(a.length, b.length))) return std::nullopt;
    return std::array{low, high};
}

class SeamFinder {
public:
    SeamFinder(std::span<const BorderEdge> edges, const SeamRule& rule)
        : edges_(edges), rule_(rule), tree_(edges, rule) {
        lines_.reserve(edges.size());
        for (const BorderEdge& edge : edges) lines_.emplace_back(edge);
    }

    void find(std::uint32_t i, std::vector<Seam>& out) const {
        const std::size_t first = out.size();
        tree_.for_each_near(i, [&](std::uint32_t j) {
            if (j <= i || edges_[i].triangle == edges_[j].triangle) return;
            if (const auto seam = between(i, j)) out.push_back(*seam);
        });
        std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                  [](const Seam& x, const Seam& y) { return x.b < y.b; });
    }

private:
    [[nodiscard]] std::optional<Seam> between(std::uint32_t i, std::uint32_t j) const {
        const Line &a = lines_[i], &b = lines_[j];
        // Faces on one side of the line are layers, a rug on a floor: what lies above has light of its own.
        constexpr float kOneSide = 0.5f;
        if (dot(edges_[i].inward, edges_[j].inward) > kOneSide) return std::nullopt;
        const auto piece =
            shared_piece(a, b, double{std::min(distance_of(edges_[i], rule_), distance_of(edges_[j], rule_))});
        if (!piece) return std::nullopt;
        const auto on_b = [&](double t) {
            double s = 0.0;
            for (std::size_t k = 0; k < 3; ++k) s += (a.from[k] + a.direction[k] * t - b.from[k]) * b.direction[k];
            return static_cast<float>(std::clamp(s / b.length, 0.0, 1.0));
        };
        const auto on_a = [&](double t) { return static_cast<float>(t / a.length); };
        const Seam seam{i, j, on_a((*piece)[0]), on_a((*piece)[1]), on_b((*piece)[0]), on_b((*piece)[1])};
        return is_one_surface(seam) && !is_one_lookup(seam) ? std::optional(seam) : std::nullopt;
    }

    [[nodiscard]] bool is_one_surface(const Seam& s) const {
        for (const float t : {0.0f, 0.5f, 1.0f})
            if (dot(normal_at(edges_[s.a], std::lerp(s.a_from, s.a_to, t)),
                    normal_at(edges_[s.b], std::lerp(s.b_from, s.b_to, t))) >= rule_.normal_cosine)
                return true;
        return false;
    }

    [[nodiscard]] bool is_one_lookup(const Seam& s) const {
        const BorderEdge &a = edges_[s.a], &b = edges_[s.b];
        return a.page == b.page && length(texels_at(a, s.a_from) - texels_at(b, s.b_from)) <= rule_.same_texels &&
               length(texels_at(a, s.a_to) - texels_at(b, s.b_to)) <= rule_.same_texels;
    }

    std::span<const BorderEdge> edges_;
    SeamRule rule_;
    EdgeTree tree_;
    std::vector<Line> lines_;
};

}  // namespace

Result<std::vector<Seam>> find_seams(std::span<const BorderEdge> edges, const SeamRule& rule, Context& context) {
    constexpr std::size_t kEdgesPerChunk = 4096;
    const SeamFinder finder(edges, rule);
    std::vector<std::vector<Seam>> parts((edges.size() + kEdgesPerChunk - 1) / kEdgesPerChunk);
    const bool done = parallel_for(
        context, edges.size(), kEdgesPerChunk,
        [&](const ChunkRange& range) {
            for (std::size_t i = range.begin; i < range.end; ++i)
                finder.find(static_cast<std::uint32_t>(i), parts[range.index]);
        },
        "seams");
    if (!done) return cancelled_error();
    std::vector<Seam> out;
    for (const std::vector<Seam>& part : parts) out.insert(out.end(), part.begin(), part.end());
    return out;
}

}  // namespace lumel
