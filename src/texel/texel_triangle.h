// A triangle in the plane of a page, in texels: which texels it covers, which points lie in it, and where.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "lumel/vec.h"

namespace lumel {

struct TexelInterval {
    double low = 0.0, high = 0.0;
};

// Cells [first, end) of unit width that an interval covers. A cell that it reaches into by less than kTouch is not
// covered: its light would come from the very rim of a chart, where the next surface begins. Every interval covers at
// least one cell.
struct CellRange {
    std::int32_t first = 0, end = 0;
};
inline constexpr double kTouch = 0x1p-10;
CellRange covered_cells(TexelInterval interval, std::uint32_t limit);

// Barycentrics of corners 1 and 2.
struct Barycentrics {
    float b1 = 0.0f, b2 = 0.0f;
};

class TexelTriangle {
public:
    explicit TexelTriangle(const std::array<Vec2, 3>& texels);

    // Rows of texels that it covers, of a page of `height` rows; and the texels of one of them.
    [[nodiscard]] CellRange rows(std::uint32_t height) const;
    [[nodiscard]] CellRange columns(std::int32_t row, std::uint32_t width) const;

    // Where p lies in the triangle, its edges included; nothing where it lies outside or the triangle has no area. A
    // point on the edge between two triangles lies in at least one of them, whatever the rounding.
    [[nodiscard]] std::optional<Barycentrics> locate(double x, double y) const;
    // Whether all of the texel with this corner lies in it.
    [[nodiscard]] bool contains_texel(double left, double top) const;

    // The middle of what it shares with a texel, and how much that is. Precondition: it covers the texel.
    struct Part {
        Barycentrics middle;
        double area = 0.0;
    };
    [[nodiscard]] Part part_in(double left, double top) const;

    [[nodiscard]] bool has_area() const { return has_area_; }

private:
    struct Point {
        double x, y;
    };
    // A side: positive on the inner side of it. The line through two corners is the same, but for the sign of
    // `direction`, for both triangles that share it: its ends are taken in the order of their coordinates.
    struct Side {
        Point from, direction;
        Side(Point a, Point b, double orientation);
        Side() = default;
        [[nodiscard]] double distance(Point p) const {
            return direction.x * (p.y - from.y) - direction.y * (p.x - from.x);
        }
    };
    [[nodiscard]] bool in_bounds(Point p) const;

    std::array<Point, 3> corner_;
    std::array<Side, 3> side_;  // opposite to the corner
    TexelInterval x_, y_;
    bool has_area_ = false;
};

}  // namespace lumel
