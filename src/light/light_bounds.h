// What a light can bring to a point, at most, without looking at it: for the choice among many.
// Based on: Conty Estevez, Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting".
#pragma once

#include <limits>

#include "lumel/vec.h"

namespace lumel {

struct LightTable;

// Where light is gathered.
struct Receiver {
    Vec3 position;
    Vec3 normal;  // of the hemisphere that light comes from
    // How the local lights are chosen there, of light that has not bounced; null: by the tree.
    const LightTable* table = nullptr;
};

// Where receivers are that share a choice of lights: all within a sphere, their normals within a cone.
struct ReceiverRegion {
    Vec3 centre;
    Vec3 axis;                 // of the normals
    float radius = 0.0f;       // metres
    float cos_normals = 1.0f;  // cosine of the half angle of their cone
};

// Where a light is and where it shines; of a group of lights, a bound.
struct LightBounds {
    Vec3 low, high;             // box
    Vec3 axis{0, 0, 1};         // of the cone of directions in which surfaces face
    float cos_facing = -1.0f;   // half angle of that cone; -1: all directions
    float cos_emission = 0.0f;  // how far from facing they still shine; 0: 90 degrees
    double intensity = 0.0;     // the largest in any direction, strength(); of a group the sum. 0: no light
    float reach = std::numeric_limits<float>::infinity();  // metres from the box beyond which there is no light
    bool both_sides = false;
    bool must_be_sampled = false;  // no ray can hit it
};

}  // namespace lumel
