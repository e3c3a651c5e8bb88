// Sky and sun of the options, and the artist's global controls, applied to a scene before anything is traced.

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "base/try.h"
#include "light/light_set.h"
#include "lumel/bake.h"
#include "math/constants.h"
#include "math/frame.h"
#include "math/trig.h"
#include "scene/world_geometry.h"

namespace lumel {
namespace {

constexpr float kRadians = kPi / 180.0f;

// Too large a factor stays so, for the check of the product to find.
float single(double factor) { return static_cast<float>(std::min(factor, double{std::numeric_limits<float>::max()})); }

Light make_sun(const SunOptions& options) {
    Light sun;
    sun.name = "--sun-direction";
    sun.shape = LightShape::sun;
    sun.direction = unit_or(*options.direction, Vec3{});
    sun.intensity = options.color * single(options.illuminance);
    sun.angular_diameter = static_cast<float>(options.angle_degrees) * kRadians;
    return sun;
}

// Options that act on a sky, where there is none that they could act on.
Status check_sky_options(const Sky& sky, const SkyOptions& options) {
    const auto needs = [](const char* option, const char* what, const char* remedy) {
        return Error{ErrorCode::usage, std::string(option) + " needs a " + what, {}, remedy};
    };
    constexpr const char* kGiveMap =
        "give one with --sky FILE, or in the sidecar: a constant sky looks the same anyway";
    if (options.intensity != 1.0 && !options.color && sky.is_black())
        return needs("--sky-intensity", "sky", "give one with --sky, or in the sidecar");
    if (options.rotation_degrees != 0.0 && !sky.map) return needs("--sky-rotation", "sky map", kGiveMap);
    if (options.blur_degrees != 0.0 && !sky.map) return needs("--sky-blur", "sky map", kGiveMap);
    if (options.extract_sun && !sky.map) return needs("--sky-extract-sun", "sky map", "give one with --sky FILE");
    return success();
}

void scale(Sky& sky, float factor) {
    sky.color *= factor;
    if (sky.map)
        for (Vec3& radiance : sky.map->radiance) radiance *= factor;
}

}  // namespace

Status apply_lighting(Scene& scene, const BakeOptions& options) {
    if (options.sky.color) {
        scene.sky = {};
        scene.sky.color = *options.sky.color;
    }
    LUMEL_TRY_STATUS(check_sky_options(scene.sky, options.sky));
    scale(scene.sky, single(options.sky.intensity));
    scene.sky.rotation += static_cast<float>(options.sky.rotation_degrees) * kRadians;
    LUMEL_TRY_STATUS(validate_lighting(scene));
    if (options.sky.extract_sun) {
        Result<ExtractedSun> found = extract_sun(*scene.sky.map);
        if (!found.ok()) {
            Error error = found.error();
            error.where = options.sky.file.empty() ? scene.source : options.sky.file;
            error.remedy = "leave out --sky-extract-sun, or give the sun apart with --sun-direction";
            return error;
        }
        ExtractedSun extracted = std::move(found).value();
        scene.sky.map = std::move(extracted.sky);
        // The map's frame turned into the world's.
        const auto [s, c] = sincos_turn(scene.sky.rotation * kInvTwoPi);
        const Vec3 d = extracted.sun.direction;
        extracted.sun.direction = {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
        scene.lights.push_back(extracted.sun);
    }
    if (options.sky.blur_degrees > 0.0 && scene.sky.map)
        scene.sky.map = blur_sky(*scene.sky.map, static_cast<float>(options.sky.blur_degrees) * kRadians);
    if (options.sun.direction) scene.lights.push_back(make_sun(options.sun));
    return validate_lighting(scene);
}

std::uint32_t sample_budget(const BakeOptions& options) {
    if (options.samples != 0) return options.samples;
    const std::uint32_t samples = preset_values(options.preset).samples;
    return options.stop == StopRule::error || options.time_seconds > 0.0 ? 8 * samples : samples;
}

PresetValues preset_values(Preset preset) {
    switch (preset) {
        case Preset::preview: return {0.25e6, 256, true};
        case Preset::medium: return {2e6, 512, false};
        case Preset::production: return {8e6, 4096, false};
    }
    return {2e6, 512, false};
}

}  // namespace lumel
