// Light from all around a texel as many small sources: sky maps and made-up lights, in double precision.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "encode/hemisphere_fit.h"
#include "image/image.h"

namespace lumel::bench {

using Vec3d = std::array<double, 3>;

// Directions with the solid angle and the radiance of each.
struct Environment {
    std::string name;
    std::vector<Vec3d> direction, radiance;
    std::vector<double> solid_angle;
    void add(Vec3d d, double w, Vec3d l) {
        direction.push_back(d);
        solid_angle.push_back(w);
        radiance.push_back(l);
    }
};

// An equirectangular map box-filtered to 128 x 64; the image's up is +z, its middle column is -y.
Environment environment_of(const Image& map, std::string name);

// One texel's lights, upper hemisphere only: constant, gradient, sun, two colours, window, ring, hemisphere +
// direction.
std::vector<Environment> made_up_lights();
// The k-th of an endless row of random ones: a constant and one to three lobes.
Environment random_light(std::uint64_t k);

// Turned so that `up` is +z. `above_only`: without what is below the horizon.
Environment turned(const Environment& environment, Vec3d up, bool above_only);

// I = E/pi about each normal.
std::vector<Vec3d> irradiance(const Environment& environment, const std::vector<Vec3>& normals);
// Coefficients of radiance.
RadianceSh<Vec3, 9> project(const Environment& environment);
// What encodings are solved from, with `fit` the least squares of the true irradiance on the grid.
TexelLight exact_light(const Environment& environment, const HemisphereGrid& grid, const std::vector<Vec3d>& on_grid);

}  // namespace lumel::bench
