#include "flux_lights.h"

#include <array>
#include <map>
#include <tuple>

#include "base/union_find.h"
#include "light/emissive.h"
#include "math/discrete.h"

namespace lumel::bench {

FluxLights::FluxLights(const Scene& scene, const WorldGeometry& geometry, SurfaceReader surfaces)
    : scene_(&scene), geometry_(&geometry), surfaces_(surfaces) {
    for (const Light& light : scene.lights) {
        if (light.bake == LightBake::none || max_component(light.intensity) <= 0.0f) continue;
        switch (light.shape) {
            case LightShape::sun: lights_.emplace_back(SunLight(light)); break;
            case LightShape::point:
            case LightShape::spot: lights_.emplace_back(PunctualLight(light)); break;
            case LightShape::rectangle: lights_.emplace_back(RectangleLight(light)); break;
            case LightShape::disc: lights_.emplace_back(DiscLight(light)); break;
            case LightShape::sphere: lights_.emplace_back(SphereLight(light)); break;
        }
    }
    add_emissive_objects();
}

void FluxLights::add_emissive_objects() {
    std::vector<std::uint32_t> emitters;
    for (std::uint32_t t = 0; t < geometry_->triangle_count(); ++t)
        if (is_emitter(geometry_->triangles[t]) && geometry_->area(t) > 0.0f) emitters.push_back(t);

    UnionFind groups(emitters.size());                                  // that share a corner, over any number of steps
    std::map<std::tuple<float, float, float>, std::uint32_t> first_at;  // corner to the first emitter that has it
    for (std::uint32_t i = 0; i < emitters.size(); ++i)
        for (const Vec3 corner : geometry_->corners(emitters[i]))
            groups.unite(i, first_at.emplace(std::tuple(corner.x, corner.y, corner.z), i).first->second);

    std::map<std::uint32_t, EmissiveObject> objects;
    for (std::uint32_t i = 0; i < emitters.size(); ++i) objects[groups.find(i)].triangles.push_back(emitters[i]);
    for (auto& [group, object] : objects) {
        std::vector<double> areas;
        for (const std::uint32_t t : object.triangles) areas.push_back(static_cast<double>(geometry_->area(t)));
        object.ends.resize(areas.size());
        share_units(areas, 0, object.ends);
        lights_.emplace_back(std::move(object));
    }
}

LightSample FluxLights::sample_object(const EmissiveObject& object, Vec3 point, Vec2 u) const {
    const Choice choice = choose(object.ends, u.x);
    LightSample sample = EmissiveTriangle(*scene_, *geometry_, surfaces_, object.triangles[choice.index])
                             .sample(point, {choice.fraction, u.y});
    sample.weight = sample.weight / probability(choice.units);
    return sample;
}

LightSample FluxLights::sample(std::size_t light, Vec3 point, Vec2 u) const {
    return std::visit(
        [&](const auto& entry) {
            using Type = std::decay_t<decltype(entry)>;
            if constexpr (std::is_same_v<Type, EmissiveObject>)
                return sample_object(entry, point, u);
            else if constexpr (std::is_same_v<Type, SunLight>)
                return entry.sample(u);
            else
                return entry.sample(point, u);
        },
        lights_[light]);
}

}  // namespace lumel::bench
