// Pictures of a scene through a camera: path-traced (the truth) or lit by a bake, pixel for pixel comparable.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "image/image.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"
#include "path/path_integrator.h"

namespace lumel {

struct PictureOptions {
    std::uint32_t width = 640, height = 360;
    std::uint32_t samples = 64;  // paths per pixel
};

// I = E/pi of the bake at a point of the front side of a world triangle; nothing where it has no texels.
using BakedIrradiance = std::function<std::optional<Vec3>(std::uint32_t triangle, float b1, float b2)>;

// The light of a bake, which need not fit into memory at once: a picture is the sum of its parts.
struct BakedLight {
    BakedIrradiance irradiance;  // zero where the texels are those of another part
    std::uint32_t parts = 1;
    std::function<Status(std::uint32_t part)> load = {};  // called, if set, before a part is looked up
};

// Radiance per pixel, 3 channels. Single-sided surfaces are not seen from behind, as in a viewer. With `baked`,
// surfaces that have texels take their light from it; all others are path-traced. Errors: cancelled, and what `load`
// returns.
Result<Image> render_picture(const Transport& transport, const PathOptions& path, const Camera& camera,
                             const PictureOptions& options, const BakedLight* baked, Context& context);

// The scene's own cameras, then viewpoints found by looking around in it, until there are `count`: rooms are looked at
// from inside, where there is light; open scenes from above a corner. Deterministic.
Result<std::vector<Camera>> choose_views(const Transport& transport, std::size_t count, Context& context);

// A camera at `eye` that looks at `target`, up +Y.
Camera look_at(Vec3 eye, Vec3 target, float vertical_fov);

}  // namespace lumel
