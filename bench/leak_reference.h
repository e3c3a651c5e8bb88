// The truth of the leak suite: what each texel of a page should hold so that no lookup shows the light of the other
// side of a wall. By brute force on 8 x 8 fine points a texel, of which those inside solids are known from how the
// scene was made; nothing here asks the code that picks the sample points of a bake.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bench_scene.h"
#include "light/light_set.h"

namespace lumel::bench {

inline constexpr std::uint32_t kFineEdge = 8;  // fine points along a texel

// What a pixel of the page may hold: the mean I (luminance) of the visible fine points of each group of them that see
// each other. Of a texel with such points of its own: the largest group, and those as large but for a row. Else (a
// texel inside a wall, a dilated one, one of which less than a row is seen): of each group that lookups blend the pixel
// into, weighted as they do.
struct AllowedLight {
    std::vector<float> means;  // empty: no lookup at a visible point reads the pixel
    bool own = false;          // whether more than a row of its own points are visible
};

struct LeakReference {
    std::vector<AllowedLight> pixels;  // of page 0, row by row
    double scene_mean = 0.0;           // of I over all visible fine points
    double sigma = 0.0;                // root mean square error of the means of whole texels, of scene_mean
};

// `paths`: of each texel, over all its visible fine points. Brute force, as many bounces as a bake's.
LeakReference leak_reference(const BenchScene& bench, const std::function<bool(Vec3)>& hidden, std::uint32_t paths,
                             Context& context);

}  // namespace lumel::bench
