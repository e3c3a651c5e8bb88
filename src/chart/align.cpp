#include "chart/align.h"

#include <algorithm>
#include <limits>

namespace lumel {
namespace {

using Point = Eigen::Vector2d;

// Andrew's monotone chain, counter-clockwise, without collinear points.
std::vector<Point> convex_hull(std::vector<Point> points) {
    std::sort(points.begin(), points.end(),
              [](const Point& a, const Point& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    std::vector<Point> hull(2 * points.size());
    std::size_t n = 0;
    const auto turn = [](const Point& o, const Point& a, const Point& b) {
        return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
    };
    for (std::size_t i = 0; i < points.size(); hull[n++] = points[i++])
        while (n >= 2 && turn(hull[n - 2], hull[n - 1], points[i]) <= 0.0) --n;
    const std::size_t lower = n + 1;
    for (std::size_t i = points.size() - 1; i-- > 0; hull[n++] = points[i])
        while (n >= lower && turn(hull[n - 2], hull[n - 1], points[i]) <= 0.0) --n;
    hull.resize(n - 1);
    return hull;
}

struct Box {
    Point low, high;
    [[nodiscard]] double area() const { return (high.x() - low.x()) * (high.y() - low.y()); }
};

// Box of the points seen along `axis` and its perpendicular.
Box box_along(const std::vector<Point>& points, const Point& axis) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Box box{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
    for (const Point& p : points) {
        const Point q{axis.dot(p), axis.x() * p.y() - axis.y() * p.x()};
        box.low = box.low.cwiseMin(q), box.high = box.high.cwiseMax(q);
    }
    return box;
}

// Hull edges grouped by direction would be finer; a long hull is thinned, as its directions are dense anyway.
Point best_axis(const std::vector<Point>& hull) {
    constexpr std::size_t kMaxDirections = 256;
    const std::size_t step = hull.size() / kMaxDirections + 1;
    struct Choice {
        Point axis;
        double area, length;
    };
    std::vector<Choice> choices;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.size(); i += step) {
        const Point edge = hull[(i + 1) % hull.size()] - hull[i];
        if (edge.norm() == 0.0) continue;
        const Point axis = edge.normalized();
        choices.push_back({axis, box_along(hull, axis).area(), edge.norm()});
        smallest = std::min(smallest, choices.back().area);
    }
    Point best{1.0, 0.0};
    double longest = 0.0;
    for (const Choice& c : choices)
        if (c.area <= 1.01 * smallest && c.length > longest) best = c.axis, longest = c.length;
    return best;
}

}  // namespace

void align_to_box(std::vector<Eigen::Vector2d>& points) {
    const std::vector<Point> hull = convex_hull(points);
    Point axis = best_axis(hull);
    Box box = box_along(hull, axis);
    if (box.high.y() - box.low.y() > box.high.x() - box.low.x()) {
        axis = {-axis.y(), axis.x()};
        box = box_along(hull, axis);
    }
    for (Point& p : points) p = Point{axis.dot(p), axis.x() * p.y() - axis.y() * p.x()} - box.low;
}

}  // namespace lumel
