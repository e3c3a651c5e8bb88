// A scene built in code and all that its paths are traced through.
#pragma once

#include <memory>
#include <utility>

#include "light/light_set.h"
#include "path/path_integrator.h"
#include "support/scene_builder.h"
#include "trace/tracer.h"

namespace lumel::test {

struct TracedScene {
    Scene scene;
    WorldGeometry geometry;
    SurfaceReader surfaces{scene, geometry};
    LightSet lights{scene, geometry, surfaces};
    std::unique_ptr<Tracer> tracer;
    Transport transport{scene, geometry, surfaces, lights, *tracer};

    TracedScene(Scene built, Context& context)
        : scene(std::move(built)),
          geometry(flatten(scene, context).value()),
          tracer(make_embree_tracer(geometry, surfaces, context).value()) {}
    TracedScene(const TracedScene&) = delete;  // its members point at each other
    TracedScene& operator=(const TracedScene&) = delete;
};

// A room with one side open to the sky, two boxes in it, a lamp, a sun and a point light: every
// kind of path.
inline Scene room() {
    SceneBuilder b;
    const auto white = b.material({0.8f, 0.8f, 0.7f});
    const auto red = b.material({0.7f, 0.1f, 0.1f}, {}, true);
    const auto lamp = b.material({0.1f, 0.1f, 0.1f}, {20, 15, 10});
    b.object("room", white, [](Mesh& m) {
        add_quad(m, {0, 0, 2}, {3, 0, 0}, {0, 0, -2});
        add_quad(m, {0, 0, 0}, {3, 0, 0}, {0, 2, 0});
        add_quad(m, {0, 0, 2}, {0, 0, -2}, {0, 2, 0});
    });
    const auto box = b.object(
        "box", red,
        [](Mesh& m) {
            add_box(m, {-0.3f, 0, -0.3f}, {0.3f, 0.6f, 0.3f}, false);
        },
        Affine{{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {1, 0, 1}});
    b.instance("box 2", b.scene().instances[box].mesh, Affine{{Vec3{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {2.2f, 0, 0.8f}});
    b.object("lamp", lamp, [](Mesh& m) { add_quad(m, {1, 1.9f, 1}, {0.4f, 0, 0}, {0, 0, 0.4f}); });
    Light& sun = b.light(LightShape::sun);
    sun.direction = normalize(Vec3{-0.5f, -1.0f, -0.4f});
    sun.intensity = {5, 4, 3};
    sun.angular_diameter = 0.1f;
    Light& point = b.light(LightShape::point);
    point.position = {2.5f, 1.5f, 1.5f};
    point.intensity = {1, 2, 3};
    b.scene().sky.color = {0.4f, 0.6f, 1.0f};
    return b.build();
}

}  // namespace lumel::test
