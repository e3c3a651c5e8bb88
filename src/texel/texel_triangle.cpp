#include "texel/texel_triangle.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumel {
namespace {

// Barycentrics in single precision whose three weights are not negative.
Barycentrics rounded(double b1, double b2) {
    Barycentrics b{static_cast<float>(std::clamp(b1, 0.0, 1.0)), static_cast<float>(std::clamp(b2, 0.0, 1.0))};
    while (b.b1 + b.b2 > 1.0f) {
        float& larger = b.b1 > b.b2 ? b.b1 : b.b2;
        larger = std::nextafterf(larger, 0.0f);
    }
    return b;
}

std::int32_t cell(double x, std::uint32_t limit) {
    return static_cast<std::int32_t>(std::clamp(x, 0.0, static_cast<double>(limit)));
}

struct ClipVertex {
    double x, y, b1, b2;
};

ClipVertex mix(const ClipVertex& a, const ClipVertex& b, double t) {
    return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.b1 + (b.b1 - a.b1) * t, a.b2 + (b.b2 - a.b2) * t};
}

// A triangle cut by four lines has at most seven corners.
class Polygon {
public:
    void push(const ClipVertex& vertex) { vertices_[count_++] = vertex; }
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] const ClipVertex& operator[](std::size_t i) const { return vertices_[i]; }

    // What lies where `depth` is not negative. Based on: Sutherland and Hodgman 1974.
    template <class Depth>
    [[nodiscard]] Polygon clipped(Depth&& depth) const {
        Polygon out;
        for (std::size_t i = 0; i < count_; ++i) {
            const ClipVertex &a = vertices_[i], &b = vertices_[(i + 1) % count_];
            const double da = depth(a), db = depth(b);
            if (da >= 0.0) out.push(a);
            if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) out.push(mix(a, b, da / (da - db)));
        }
        return out;
    }

    [[nodiscard]] double area() const {
        double twice = 0.0;
        for (std::size_t i = 2; i < count_; ++i) {
            const ClipVertex &o = vertices_[0], &a = vertices_[i - 1], &b = vertices_[i];
            twice += (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
        }
        return 0.5 * std::fabs(twice);
    }

    // The mean of the corners: inside, and defined without area too.
    [[nodiscard]] ClipVertex middle() const {
        ClipVertex sum{0, 0, 0, 0};
        for (std::size_t i = 0; i < count_; ++i) {
            sum.x += vertices_[i].x;
            sum.y += vertices_[i].y;
            sum.b1 += vertices_[i].b1;
            sum.b2 += vertices_[i].b2;
        }
        const double n = static_cast<double>(count_);
        return {sum.x / n, sum.y / n, sum.b1 / n, sum.b2 / n};
    }

private:
    std::array<ClipVertex, 16> vertices_;
    std::size_t count_ = 0;
};

}  // namespace

CellRange covered_cells(TexelInterval interval, std::uint32_t limit) {
    TexelInterval inner{interval.low + kTouch, interval.high - kTouch};
    if (inner.low >= inner.high) inner.low = inner.high = 0.5 * (interval.low + interval.high);
    const double end = std::max(std::ceil(inner.high), std::floor(inner.low) + 1.0);
    return {cell(std::floor(inner.low), limit), cell(end, limit)};
}

TexelTriangle::TexelTriangle(const std::array<Vec2, 3>& texels) {
    for (std::size_t i = 0; i < 3; ++i) corner_[i] = {texels[i].x, texels[i].y};
    x_ = {std::min({corner_[0].x, corner_[1].x, corner_[2].x}), std::max({corner_[0].x, corner_[1].x, corner_[2].x})};
    y_ = {std::min({corner_[0].y, corner_[1].y, corner_[2].y}), std::max({corner_[0].y, corner_[1].y, corner_[2].y})};
    const Point u{corner_[1].x - corner_[0].x, corner_[1].y - corner_[0].y};
    const Point v{corner_[2].x - corner_[0].x, corner_[2].y - corner_[0].y};
    const double twice_area = u.x * v.y - u.y * v.x;
    has_area_ = twice_area != 0.0;
    const double orientation = twice_area < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < 3; ++i) side_[i] = Side(corner_[(i + 1) % 3], corner_[(i + 2) % 3], orientation);
}

TexelTriangle::Side::Side(Point a, Point b, double orientation) {
    if (b.x < a.x || (b.x == a.x && b.y < a.y)) {
        std::swap(a, b);
        orientation = -orientation;
    }
    from = a;
    direction = {orientation * (b.x - a.x), orientation * (b.y - a.y)};
}

CellRange TexelTriangle::rows(std::uint32_t height) const { return covered_cells(y_, height); }

// The triangle between the lines y = row and y = row + 1 is convex: the texels of its x range are those it covers.
CellRange TexelTriangle::columns(std::int32_t row, std::uint32_t width) const {
    const double low = row, high = low + 1.0;
    TexelInterval range{x_.high, x_.low};
    const auto include = [&](double x) {
        range.low = std::min(range.low, x);
        range.high = std::max(range.high, x);
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const Point a = corner_[i], b = corner_[(i + 1) % 3];
        if (a.y >= low && a.y <= high) include(a.x);
        for (const double line : {low, high})
            if ((a.y < line) != (b.y < line)) include(a.x + (b.x - a.x) * ((line - a.y) / (b.y - a.y)));
    }
    if (range.low > range.high) return {};
    return covered_cells(range, width);
}

bool TexelTriangle::in_bounds(Point p) const {
    return p.x >= x_.low && p.x <= x_.high && p.y >= y_.low && p.y <= y_.high;
}

std::optional<Barycentrics> TexelTriangle::locate(double x, double y) const {
    const Point p{x, y};
    if (!has_area_ || !in_bounds(p)) return std::nullopt;
    const double d0 = side_[0].distance(p), d1 = side_[1].distance(p), d2 = side_[2].distance(p);
    const double sum = d0 + d1 + d2;
    if (!(d0 >= 0.0 && d1 >= 0.0 && d2 >= 0.0 && sum > 0.0)) return std::nullopt;
    return rounded(d1 / sum, d2 / sum);
}

bool TexelTriangle::contains_texel(double left, double top) const {
    if (!has_area_ || left < x_.low || left + 1.0 > x_.high || top < y_.low || top + 1.0 > y_.high) return false;
    return std::ranges::all_of(side_, [&](const Side& side) {
        return side.distance({left, top}) >= 0.0 && side.distance({left + 1.0, top}) >= 0.0 &&
               side.distance({left, top + 1.0}) >= 0.0 && side.distance({left + 1.0, top + 1.0}) >= 0.0;
    });
}

TexelTriangle::Part TexelTriangle::part_in(double left, double top) const {
    Polygon whole;
    for (std::size_t i = 0; i < 3; ++i)
        whole.push({corner_[i].x, corner_[i].y, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0});
    Polygon cut = whole.clipped([&](const ClipVertex& v) { return v.x - left; })
                      .clipped([&](const ClipVertex& v) { return left + 1.0 - v.x; })
                      .clipped([&](const ClipVertex& v) { return v.y - top; })
                      .clipped([&](const ClipVertex& v) { return top + 1.0 - v.y; });
    if (cut.size() == 0) cut = whole;  // parted from the texel by a rounding
    const ClipVertex middle = cut.middle();
    return {rounded(middle.b1, middle.b2), cut.area()};
}

}  // namespace lumel
