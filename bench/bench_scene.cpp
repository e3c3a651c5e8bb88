#include "bench_scene.h"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "io/image_io.h"
#include "load.h"
#include "lumel/bake.h"

namespace lumel::bench {
namespace {

// The synthetic scenes keep the radiance of their constant sky beside the file, for glTF has no word for it.
struct KnownSky {
    std::string_view scene;
    Vec3 radiance;
};
constexpr KnownSky kKnownSkies[] = {
    {"bench_window_room", {1.0f, 1.25f, 1.6f}},
    {"bench_courtyard", {0.7f, 0.9f, 1.3f}},
};

bool emits(const Scene& scene) {
    return !scene.lights.empty() || !scene.sky.is_black() ||
           std::ranges::any_of(scene.materials, [](const Material& m) { return max_component(m.emission) > 0.0f; });
}

BakeOptions light_of_the_benchmarks() {
    BakeOptions light;
    light.sky.color = Vec3{0.7f, 0.9f, 1.3f};
    light.sun.direction = Vec3{0.4188f, -0.7614f, -0.4949f};
    light.sun.color = {14.0f, 12.5f, 10.0f};
    light.sun.illuminance = 1.0;
    return light;
}

}  // namespace

Scene load_lit(const std::string& path, Context& context, const std::string& sky_map) {
    LoadedScene loaded = need(load_scene(path, context));
    Scene& scene = loaded.scene;
    const std::string stem = std::filesystem::path(path).stem().string();
    const auto* known = std::ranges::find(kKnownSkies, std::string_view(stem), &KnownSky::scene);
    if (known != std::end(kKnownSkies)) {
        scene.sky = {};
        scene.sky.color = known->radiance;
    } else if (!emits(scene) && !sky_map.empty()) {
        scene.sky.map = need(read_sky(sky_map));
    } else if (!emits(scene)) {
        need(apply_lighting(scene, light_of_the_benchmarks()));
    }
    return std::move(scene);
}

BenchScene::BenchScene(const std::string& path, const ChartOptions& options, Context& context,
                       const std::string& sky_map)
    : BenchScene(base_name(path), load_lit(path, context, sky_map), options, context) {}

BenchScene::BenchScene(std::string scene_name, Scene made, const ChartOptions& options, Context& context)
    : name(std::move(scene_name)),
      scene(std::move(made)),
      geometry(need(flatten(scene, context))),
      charts(need(make_charts(scene, geometry, options, context))),
      atlas(need(make_atlas(scene, geometry, charts, options, context))) {
    const auto by_page = triangles_by_page(scene, geometry, charts, atlas);
    texels = need(rasterize_page(scene, geometry, charts, atlas, 0, by_page.at(0), context));
    tracer = need(make_embree_tracer(geometry, surfaces, context));
}

TexelRange BenchScene::middle_texels(std::size_t at_most) const {
    const std::size_t count = at_most == 0 ? texels.size() : std::min(at_most, texels.size());
    return {(texels.size() - count) / 2, count};
}

}  // namespace lumel::bench
