#include "leaks.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/try.h"
#include "io/image_io.h"
#include "samples.h"

namespace lumel::samples {
namespace {

constexpr Vec3 kDaylight{1, 1, 1};

// An orthonormal frame at a point.
struct Pose {
    Vec3 at{};
    std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

    [[nodiscard]] Vec3 turn(Vec3 v) const { return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z; }
    [[nodiscard]] Vec3 to_local(Vec3 p) const {
        const Vec3 d = p - at;
        return {dot(d, axes[0]), dot(d, axes[1]), dot(d, axes[2])};
    }
};

Pose turned_about_y(Vec3 at, float degrees) {
    const float angle = degrees * 3.14159265f / 180.0f, c = std::cos(angle), s = std::sin(angle);
    return {at, {Vec3{c, 0, -s}, Vec3{0, 1, 0}, Vec3{s, 0, c}}};
}

Pose turned_about_z(Vec3 at, float degrees) {
    const float angle = degrees * 3.14159265f / 180.0f, c = std::cos(angle), s = std::sin(angle);
    return {at, {Vec3{c, s, 0}, Vec3{-s, c, 0}, Vec3{0, 0, 1}}};
}

class LeakBuilder {
public:
    LeakBuilder(std::string name, Vec3 sky) {
        scene_.name = std::move(name);
        scene_.sky = sky;
        scene_.glb.use_extension("KHR_materials_emissive_strength");
        single_ = scene_.glb.add_material(make_material("plaster", {0.6f, 0.6f, 0.6f}));
        Json both = make_material("sheet", {0.6f, 0.6f, 0.6f});
        both["doubleSided"] = true;
        double_ = scene_.glb.add_material(both);
    }

    void solid_box(const char* name, Vec3 low, Vec3 high, const Pose& pose = {}, bool double_sided = false) {
        Geometry g;
        g.material = double_sided ? double_ : single_;
        g.box(low, high);
        place(name, std::move(g), pose);
        hide([=](Vec3 p) {
            const Vec3 q = pose.to_local(p);
            return q.x > low.x && q.y > low.y && q.z > low.z && q.x < high.x && q.y < high.y && q.z < high.z;
        });
    }

    // A smooth-shaded pipe about the y axis of its pose, its ends open.
    void pipe(const char* name, float radius, float low, float high, const Pose& pose) {
        constexpr std::uint32_t kSides = 32;
        constexpr float kWithinFacets = 0.98f;  // cos(pi / 32) = 0.995
        Geometry g;
        g.material = single_;
        const Vec2 profile[] = {{radius, low}, {radius, high}};
        g.revolve({}, profile, kSides);
        place(name, std::move(g), pose);
        hide([=](Vec3 p) {
            const Vec3 q = pose.to_local(p);
            return q.y > low && q.y < high && std::hypot(q.x, q.z) < kWithinFacets * radius;
        });
    }

    void ball(const char* name, Vec3 centre, float radius) {
        Geometry g;
        g.material = single_;
        g.sphere(centre, radius, 16, 32);
        place(name, std::move(g), {});
        hide([=](Vec3 p) { return length(p - centre) < 0.98f * radius; });  // the facets are within 0.99
    }

    // origin + s*u + t*v, the front towards u x v.
    void sheet(const char* name, Vec3 origin, Vec3 u, Vec3 v, bool double_sided, const Pose& pose = {}) {
        Geometry g;
        g.material = double_sided ? double_ : single_;
        g.quad(origin, u, v);
        place(name, std::move(g), pose);
    }

    // A slab that swallows what reaches into it; nobody looks at it from below.
    void floor(const Pose& pose = {}) {
        constexpr float kEdge = 5.0f, kDepth = 0.9f;
        solid_box("floor", {-0.5f * kEdge, -kDepth, -0.5f * kEdge}, {0.5f * kEdge, 0.0f, 0.5f * kEdge}, pose);
        hide([](Vec3 p) { return p.y < 0.0f; });
    }

    // A flat lamp let into a ceiling, of which 2 cm stand out; its sides are dark.
    void panel(Vec3 below, float edge, float radiance) {
        const Vec3 low = below - Vec3{0.5f * edge, 0.02f, 0.5f * edge};
        const Vec3 high = below + Vec3{0.5f * edge, 0.05f, 0.5f * edge};
        solid_box("lamp", low, high);
        Json material = make_material("light", {0, 0, 0});
        material["emissiveFactor"] = {1.0, 1.0, 1.0};
        material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", radiance}};
        Geometry g;
        g.material = scene_.glb.add_material(material);
        g.quad(low - Vec3{0, 0.001f, 0}, {edge, 0, 0}, {0, 0, edge});
        const int mesh = scene_.glb.add_mesh("light", std::span(&g, 1));
        scene_.glb.add_node({{"name", "light"}, {"mesh", mesh}, {"extras", {{"lightmap", false}}}});
    }

    void hide(std::function<bool(Vec3)> where) { hidden_.push_back(std::move(where)); }

    [[nodiscard]] LeakScene finish() {
        scene_.hidden = [hidden = std::move(hidden_)](Vec3 p) {
            for (const auto& inside : hidden)
                if (inside(p)) return true;
            return false;
        };
        return std::move(scene_);
    }

private:
    void place(const char* name, Geometry g, const Pose& pose) {
        for (Vec3& p : g.positions) p = pose.at + pose.turn(p);
        for (Vec3& n : g.normals) n = pose.turn(n);
        scene_.glb.add_node({{"name", name}, {"mesh", scene_.glb.add_mesh(name, std::span(&g, 1))}});
    }

    LeakScene scene_;
    int single_ = 0, double_ = 0;
    std::vector<std::function<bool(Vec3)>> hidden_;
};

// Walls of a room without a floor, of no thickness, seen from within.
void inner_sheets(LeakBuilder& b, Vec3 low, Vec3 high, bool double_sided) {
    const Vec3 d = high - low, x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
    b.sheet("wall -x", low, y, z, double_sided);
    b.sheet("wall +x", low + x, z, y, double_sided);
    b.sheet("wall -z", low, x, y, double_sided);
    b.sheet("wall +z", low + z, y, x, double_sided);
    b.sheet("ceiling", low + y, x, z, double_sided);
}

// A closed house of thick walls and a flat roof over the floor; outer measures.
void thick_shell(LeakBuilder& b, Vec3 low, Vec3 high, float wall, bool double_sided = false) {
    const float bottom = low.y - 0.3f;
    b.solid_box("wall -x", {low.x, bottom, low.z}, {low.x + wall, high.y, high.z}, {}, double_sided);
    b.solid_box("wall +x", {high.x - wall, bottom, low.z}, {high.x, high.y, high.z}, {}, double_sided);
    b.solid_box("wall -z", {low.x + 0.11f, bottom, low.z + 0.23f}, {high.x - 0.11f, high.y, low.z + 0.23f + wall}, {},
                double_sided);
    b.solid_box("wall +z", {low.x + 0.11f, bottom, high.z - 0.23f - wall}, {high.x - 0.11f, high.y, high.z - 0.23f}, {},
                double_sided);
    b.solid_box("roof", {low.x - 0.31f, high.y - 0.1f, low.z - 0.31f}, {high.x + 0.31f, high.y + 0.1f, high.z + 0.31f},
                {}, double_sided);
}

LeakScene crate_on_floor() {
    LeakBuilder b("crate_on_floor", kDaylight);
    b.floor();
    b.solid_box("crate", {-0.67f, 0.0f, -0.58f}, {0.81f, 1.1f, 0.73f});
    return b.finish();
}

LeakScene thin_single_sided_wall() {
    LeakBuilder b("thin_single_sided_wall", kDaylight);
    b.floor();
    const Vec3 low{-1.56f, 0.0f, -1.41f}, high{1.48f, 2.2f, 1.53f};
    inner_sheets(b, low, high, false);
    b.panel({0.05f, 2.2f, 0.03f}, 1.6f, 0.6f);
    // Nobody sees such walls from outside.
    b.hide([=](Vec3 p) { return p.x < low.x || p.x > high.x || p.z < low.z || p.z > high.z || p.y > high.y; });
    return b.finish();
}

LeakScene thin_double_sided_wall() {
    LeakBuilder b("thin_double_sided_wall", kDaylight);
    b.floor();
    inner_sheets(b, {-1.56f, 0.0f, -1.41f}, {1.48f, 2.2f, 1.53f}, true);
    b.panel({0.05f, 2.2f, 0.03f}, 1.6f, 0.6f);
    return b.finish();
}

LeakScene inner_corner() {
    LeakBuilder b("inner_corner", kDaylight);
    b.floor();
    b.solid_box("wall along z", {-1.2f, -0.3f, -1.67f}, {-0.87f, 2.0f, 1.9f});
    b.solid_box("wall along x", {-1.05f, -0.3f, -1.55f}, {1.8f, 2.0f, -1.13f});
    return b.finish();
}

LeakScene outer_corner() {
    LeakBuilder b("outer_corner", kDaylight);
    b.floor();
    b.solid_box("block", {-0.93f, -0.3f, -1.09f}, {0.56f, 1.1f, 0.44f}, turned_about_y({}, 17.0f), true);
    return b.finish();
}

LeakScene intersecting_pipes() {
    LeakBuilder b("intersecting_pipes", kDaylight);
    b.floor();
    b.pipe("upright", 0.55f, -0.4f, 2.6f, turned_about_y({0.13f, 0, 0.08f}, 0.0f));
    b.pipe("lying", 0.42f, -2.3f, 2.3f, turned_about_z({0.0f, 1.17f, 0.21f}, 90.0f));
    b.solid_box("end -x", {-2.45f, -0.3f, -0.7f}, {-2.15f, 2.2f, 1.1f});
    b.solid_box("end +x", {2.15f, -0.3f, -0.7f}, {2.45f, 2.2f, 1.1f});
    b.solid_box("lid", {-0.6f, 2.45f, -0.6f}, {0.9f, 2.65f, 0.8f});
    return b.finish();
}

LeakScene stair() {
    LeakBuilder b("stair", kDaylight);
    b.floor();
    for (int step = 0; step < 6; ++step) {
        const float k = static_cast<float>(step);
        b.solid_box("step", {-0.77f, -0.2f, -1.83f + 0.41f * k}, {0.86f, 1.26f - 0.21f * k, -1.3f + 0.41f * k});
    }
    b.solid_box("cheek", {0.74f, -0.3f, -2.1f}, {1.03f, 1.6f, 1.3f});
    return b.finish();
}

LeakScene rotated_uvs() {
    LeakBuilder b("rotated_uvs", kDaylight);
    b.floor(turned_about_y({}, 31.0f));  // charts follow their own edges: its texels lie askew to all that stands on it
    thick_shell(b, {-1.33f, 0.0f, -1.17f}, {1.27f, 1.9f, 1.36f}, 0.21f);
    b.panel({0.05f, 1.8f, 0.03f}, 1.4f, 0.6f);
    return b.finish();
}

LeakScene door_gap() {
    LeakBuilder b("door_gap", kDaylight);
    b.floor();
    thick_shell(b, {-2.13f, 0.0f, -1.47f}, {2.19f, 2.1f, 1.58f}, 0.22f);
    b.solid_box("divider left", {-0.11f, -0.3f, -1.4f}, {0.03f, 2.1f, 0.17f});
    b.solid_box("divider right", {-0.11f, -0.3f, 0.93f}, {0.03f, 2.1f, 1.5f});
    b.solid_box("lintel", {-0.1f, 1.7f, 0.1f}, {0.02f, 2.1f, 1.0f});
    b.panel({1.1f, 2.0f, 0.1f}, 1.3f, 1.2f);
    return b.finish();
}

LeakScene half_in_floor() {
    LeakBuilder b("half_in_floor", kDaylight);
    b.floor();
    b.ball("ball", {-0.85f, 0.13f, 0.37f}, 0.77f);
    Pose tilted = turned_about_z({1.06f, 0.1f, -0.68f}, 27.0f);
    const Pose turn = turned_about_y({}, 40.0f);
    for (Vec3& axis : tilted.axes) axis = turn.turn(axis);
    b.solid_box("crate", {-0.6f, -0.5f, -0.55f}, {0.6f, 0.5f, 0.55f}, tilted);
    return b.finish();
}

LeakScene wall_in_texel_row() {
    LeakBuilder b("wall_in_texel_row", kDaylight);
    b.floor();
    // Texel centres lie on whole quarters of a metre from the floor's corner: the wall at x = -0.5 is 0.1 m thick in
    // the middle of its row, the other walls of the closed room are anywhere.
    b.solid_box("wall in the row", {-0.55f, -0.3f, -1.71f}, {-0.45f, 2.0f, 1.83f});
    b.solid_box("wall +x", {1.81f, -0.3f, -1.71f}, {2.03f, 2.0f, 1.83f});
    b.solid_box("wall -z", {-0.5f, -0.3f, -1.52f}, {1.96f, 2.0f, -1.31f});
    b.solid_box("wall +z", {-0.5f, -0.3f, 1.37f}, {1.96f, 2.0f, 1.62f});
    b.solid_box("roof", {-0.86f, 1.9f, -1.83f}, {2.34f, 2.1f, 1.93f});
    b.panel({0.7f, 1.9f, 0.02f}, 1.4f, 0.6f);
    return b.finish();
}

LeakScene roof_with_eaves() {
    LeakBuilder b("roof_with_eaves", kDaylight);
    b.floor();
    const float wall = 0.2f, half = 1.27f, top = 1.9f;
    b.solid_box("wall -x", {-half, -0.3f, -1.3f}, {-half + wall, top, 1.3f});
    b.solid_box("wall +x", {half - wall, -0.3f, -1.3f}, {half, top, 1.3f});
    b.solid_box("gable -z", {-half - 0.23f, -0.3f, -1.39f}, {half + 0.23f, top + 0.9f, -1.39f + wall});
    b.solid_box("gable +z", {-half - 0.23f, -0.3f, 1.39f - wall}, {half + 0.23f, top + 0.9f, 1.39f});
    // Slabs from the ridge down to half a metre beyond the walls; they pass through the tops of all walls.
    for (const float side : {-1.0f, 1.0f}) {
        const Pose slope = turned_about_z({0, 2.62f, 0}, -side * 33.0f);
        b.solid_box(side < 0 ? "roof -x" : "roof +x", {side < 0 ? -2.1f : 0.02f, -0.08f, -1.87f},
                    {side < 0 ? -0.02f : 2.1f, 0.05f, 1.87f}, slope);
    }
    b.solid_box("ceiling", {-half + 0.05f, 1.55f, -1.38f}, {half - 0.05f, 1.7f, 1.38f});
    b.solid_box("ridge", {-0.22f, 2.1f, -2.1f}, {0.25f, 3.1f, 2.1f});
    b.panel({0.05f, 1.55f, 0.02f}, 1.4f, 0.6f);
    return b.finish();
}

}  // namespace

std::vector<LeakScene> leak_scenes() {
    std::vector<LeakScene> scenes;
    for (const auto make :
         {crate_on_floor, thin_single_sided_wall, thin_double_sided_wall, inner_corner, outer_corner,
          intersecting_pipes, stair, rotated_uvs, door_gap, half_in_floor, wall_in_texel_row, roof_with_eaves})
        scenes.push_back(make());
    return scenes;
}

Status write_leaks(const std::filesystem::path& folder) {
    for (const LeakScene& scene : leak_scenes()) {
        LUMEL_TRY_STATUS(scene.glb.write(folder / (scene.name + ".glb")));
        const Json sidecar{{"sky", {{"color", {scene.sky.x, scene.sky.y, scene.sky.z}}}}};
        const std::string text = sidecar.dump(2) + "\n";
        LUMEL_TRY_STATUS(write_file(folder / (scene.name + ".lumel.json"), std::as_bytes(std::span(text))));
    }
    return success();
}

}  // namespace lumel::samples
