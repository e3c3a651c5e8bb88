// Which triangles of a UV layout overlap: found with a tree of bounding boxes and the separating-axis test.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lumel/vec.h"

namespace lumel {

using UvTriangle = std::array<Vec2, 3>;

// Two triangles overlap where their interiors share a piece that is wider than min(absolute, relative * the smaller
// altitude of the two), but at least `floor`; triangles thinner than `floor` overlap nothing. All but `relative` are
// lengths in UV units.
struct OverlapTolerance {
    double floor = 0.0;     // what rounding of the coordinates makes
    double absolute = 0.0;  // so narrow an overlap shows on no texel
    double relative = 0.0;  // so that small triangles on top of each other are found all the same
};

struct OverlapSearch {
    std::vector<std::array<std::uint32_t, 2>> pairs;  // indices i < j
    bool complete = true;                             // false: stopped at the limit
};

// Stops after `max_pairs` pairs. Coordinates must be finite. Pairs come in a fixed order.
OverlapSearch find_overlaps(std::span<const UvTriangle> triangles, const OverlapTolerance& tolerance,
                            std::size_t max_pairs);

// Signed double area in double precision.
inline double uv_cross(const UvTriangle& t) {
    return (double{t[1].x} - t[0].x) * (double{t[2].y} - t[0].y) -
           (double{t[1].y} - t[0].y) * (double{t[2].x} - t[0].x);
}

// Smallest altitude.
double uv_altitude(const UvTriangle& t);

// The middle of what two overlapping triangles share: where to look for it.
Vec2 overlap_centre(const UvTriangle& a, const UvTriangle& b);

}  // namespace lumel
