#include "chart/overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lumel {
namespace {

struct UvBox {
    float min_x = std::numeric_limits<float>::infinity(), min_y = min_x, max_x = -min_x, max_y = -min_x;

    void add(const UvTriangle& t) {
        for (const Vec2 p : t) {
            min_x = std::min(min_x, p.x), max_x = std::max(max_x, p.x);
            min_y = std::min(min_y, p.y), max_y = std::max(max_y, p.y);
        }
    }
    [[nodiscard]] bool meets(const UvBox& o) const {
        return min_x <= o.max_x && o.min_x <= max_x && min_y <= o.max_y && o.min_y <= max_y;
    }
};

// ---- Two triangles --------------------------------------------------------------------------------------------------

struct Interval {
    double low, high;
};

Interval project(const UvTriangle& t, double nx, double ny) {
    const double a = nx * t[0].x + ny * t[0].y, b = nx * t[1].x + ny * t[1].y, c = nx * t[2].x + ny * t[2].y;
    return {std::min({a, b, c}), std::max({a, b, c})};
}

// Width of the common interval along the normals of `t`'s edges, the smallest of the three.
double common_width(const UvTriangle& t, const UvTriangle& other) {
    double width = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vec2 a = t[k], b = t[(k + 1) % 3];
        const double nx = double{a.y} - b.y, ny = double{b.x} - a.x;
        const double length = std::sqrt(nx * nx + ny * ny);
        if (length == 0.0) return 0.0;
        const Interval p = project(t, nx, ny), q = project(other, nx, ny);
        width = std::min(width, (std::min(p.high, q.high) - std::max(p.low, q.low)) / length);
        if (width <= 0.0) return 0.0;
    }
    return width;
}

// ---- The tree -------------------------------------------------------------------------------------------------------

class BoxTree {
public:
    explicit BoxTree(std::span<const UvTriangle> triangles) : triangles_(triangles) {
        for (std::uint32_t i = 0; i < triangles.size(); ++i) order_.push_back(i);
    }

    // Keeps only the triangles that can overlap anything, then builds.
    void build(double floor) {
        std::erase_if(order_, [&](std::uint32_t i) { return uv_altitude(triangles_[i]) <= floor; });
        if (order_.empty()) return;
        nodes_.reserve(2 * order_.size() / kLeafSize + 1);
        build_node(0, static_cast<std::uint32_t>(order_.size()));
    }

    // Calls visit(j) for the triangles whose boxes meet that of triangle i, until it returns false.
    template <class Visit>
    bool query(std::uint32_t i, const Visit& visit) const {
        if (nodes_.empty()) return true;
        UvBox box;
        box.add(triangles_[i]);
        std::uint32_t stack[64], top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            if (!node.box.meets(box)) continue;
            if (node.right != 0) {
                stack[top++] = node.right;
                stack[top++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
                continue;
            }
            for (std::uint32_t k = node.first; k < node.last; ++k)
                if (!visit(order_[k])) return false;
        }
        return true;
    }

    [[nodiscard]] const std::vector<std::uint32_t>& triangles() const { return order_; }

private:
    static constexpr std::uint32_t kLeafSize = 4;

    struct Node {
        UvBox box;
        std::uint32_t first, last;
        std::uint32_t right = 0;  // inner nodes: the second child; the first one follows its parent
    };

    // Halves by the longer side of the box: depth is the logarithm of the count.
    void build_node(std::uint32_t first, std::uint32_t last) {
        const std::size_t self = nodes_.size();
        nodes_.push_back({{}, first, last});
        for (std::uint32_t k = first; k < last; ++k) nodes_[self].box.add(triangles_[order_[k]]);
        if (last - first <= kLeafSize) return;
        const UvBox box = nodes_[self].box;
        const bool by_x = box.max_x - box.min_x >= box.max_y - box.min_y;
        const auto centre = [&](std::uint32_t i) {
            const UvTriangle& t = triangles_[i];
            return by_x ? t[0].x + t[1].x + t[2].x : t[0].y + t[1].y + t[2].y;
        };
        const std::uint32_t middle = first + (last - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const float ca = centre(a), cb = centre(b);
                             return ca != cb ? ca < cb : a < b;
                         });
        build_node(first, middle);
        nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
        build_node(middle, last);
    }

    std::span<const UvTriangle> triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace

double uv_altitude(const UvTriangle& t) {
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
        const double x = double{t[(k + 1) % 3].x} - t[k].x, y = double{t[(k + 1) % 3].y} - t[k].y;
        longest = std::max(longest, x * x + y * y);
    }
    return longest > 0.0 ? std::abs(uv_cross(t)) / std::sqrt(longest) : 0.0;
}

Vec2 overlap_centre(const UvTriangle& a, const UvTriangle& b) {
    // Sutherland and Hodgman: b cut by the three edges of a; then the mean of the corners that are left.
    struct Point {
        double x, y;
    };
    std::vector<Point> left, cut;
    for (const Vec2 p : b) left.push_back({p.x, p.y});
    const double side = uv_cross(a) < 0.0 ? -1.0 : 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 from = a[k], to = a[(k + 1) % 3];
        const auto inside = [&](Point p) {
            return side * ((double{to.x} - from.x) * (p.y - from.y) - (double{to.y} - from.y) * (p.x - from.x));
        };
        cut.clear();
        for (std::size_t i = 0; i < left.size(); ++i) {
            const Point p = left[i], q = left[(i + 1) % left.size()];
            const double dp = inside(p), dq = inside(q);
            if (dp >= 0.0) cut.push_back(p);
            if ((dp < 0.0) != (dq < 0.0)) {
                const double t = dp / (dp - dq);
                cut.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
            }
        }
        std::swap(left, cut);
    }
    if (left.empty()) return (a[0] + a[1] + a[2]) * (1.0f / 3.0f);
    double x = 0.0, y = 0.0;
    for (const Point p : left) x += p.x, y += p.y;
    const auto n = static_cast<double>(left.size());
    return {static_cast<float>(x / n), static_cast<float>(y / n)};
}

OverlapSearch find_overlaps(std::span<const UvTriangle> triangles, const OverlapTolerance& tolerance,
                            std::size_t max_pairs) {
    BoxTree tree(triangles);
    tree.build(tolerance.floor);
    std::vector<std::uint32_t> subjects = tree.triangles();
    std::sort(subjects.begin(), subjects.end());

    OverlapSearch search;
    for (const std::uint32_t i : subjects) {
        const double altitude = uv_altitude(triangles[i]);
        const bool go_on = tree.query(i, [&](std::uint32_t j) {
            if (j <= i) return true;
            const double thinner = std::min(altitude, uv_altitude(triangles[j]));
            const double allowed =
                std::max(tolerance.floor, std::min(tolerance.absolute, tolerance.relative * thinner));
            if (common_width(triangles[i], triangles[j]) <= allowed) return true;
            if (common_width(triangles[j], triangles[i]) <= allowed) return true;
            if (search.pairs.size() == max_pairs) return false;
            search.pairs.push_back({i, j});
            return true;
        });
        if (!go_on) {
            search.complete = false;
            break;
        }
    }
    return search;
}

}  // namespace lumel
