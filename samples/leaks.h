// The leak suite: twelve scenes in which a coarse lightmap shows the light of one side of a wall on the other, unless
// something is done about it. Surfaces cut each other anywhere within texels of a quarter of a metre.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "glb_builder.h"
#include "lumel/vec.h"

namespace lumel::samples {

inline constexpr double kLeakTexelsPerMetre = 4.0;  // what the scenes are made for

struct LeakScene {
    std::string name;
    GlbBuilder glb;
    Vec3 sky{};  // its radiance, nits; glTF has no word for it
    // Whether a point a little above a surface is inside a solid, or where nobody looks at it from: known by
    // construction, so that a benchmark need not ask the code that it measures.
    std::function<bool(Vec3)> hidden;
};

std::vector<LeakScene> leak_scenes();

}  // namespace lumel::samples
