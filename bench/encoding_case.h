// A light, what is true of it over the normals of the hemisphere, and how far a model of it is from that.
#pragma once

#include <functional>
#include <vector>

#include "encode/texel_light.h"
#include "environment.h"

namespace lumel::bench {

// The normals that errors are measured over.
const HemisphereGrid& hemisphere_normals();

struct EncodingCase {
    Environment environment;
    std::vector<Vec3d> truth;  // E on the grid
    TexelLight light;
    double mean = 0.0;  // of I

    explicit EncodingCase(Environment e);
};

// I for a unit normal of the tangent frame; and what makes that of a light.
using Decoded = std::function<Vec3(Vec3 normal)>;
using EncodingModel = std::function<Decoded(const EncodingCase&)>;

// Mean over hemisphere and channels.
double squared_error(const EncodingCase& c, const Decoded& decoded);

}  // namespace lumel::bench
