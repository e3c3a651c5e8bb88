// The sample of the README: a small gallery with a window wall, columns, a sphere and a lamp. It shows what a lightmap
// is for: sunlight that turns corners, colour that bleeds, a smooth shape, instances, an emitter.
#include "samples.h"

#include <cmath>
#include <fstream>

#include "base/try.h"
#include "io/image_io.h"

namespace lumel::samples {
namespace {

constexpr float kWidth = 9.0f, kHeight = 3.6f, kDepth = 6.0f, kWall = 0.3f;

// 8-bit planks: stripes of slightly different browns, half a metre a repeat.
std::vector<std::byte> planks_png() {
    constexpr std::uint32_t kSize = 64;
    std::vector<std::uint8_t> pixels;
    for (std::uint32_t y = 0; y < kSize; ++y)
        for (std::uint32_t x = 0; x < kSize; ++x) {
            const std::uint32_t plank = x / 16;
            const bool gap = x % 16 == 0 || (y + plank * 24) % 64 == 0;
            const float shade = gap ? 0.55f : 0.85f + 0.05f * static_cast<float>((plank * 7 + 3) % 4);
            for (const float base : {186.0f, 140.0f, 96.0f}) pixels.push_back(static_cast<std::uint8_t>(base * shade));
        }
    return encode_png(kSize, kSize, 3, pixels);
}

// A wall along +x or -z with three openings, 0.3 m thick, as closed boxes.
void window_wall(Geometry& g) {
    const float z0 = kDepth, z1 = kDepth + kWall;
    const auto slab = [&](float x0, float x1, float y0, float y1) { g.box({x0, y0, z0}, {x1, y1, z1}); };
    slab(-kWall, kWidth + kWall, 0.0f, 0.5f);
    slab(-kWall, kWidth + kWall, 2.9f, kHeight);
    float x = -kWall;
    for (int window = 0; window < 3; ++window) {
        const float start = 0.9f + 2.6f * static_cast<float>(window);
        slab(x, start, 0.5f, 2.9f);
        x = start + 2.0f;
    }
    slab(x, kWidth + kWall, 0.5f, 2.9f);
}

void column(Geometry& g, float x, float z) {
    const Vec2 profile[] = {{0.34f, 0.0f}, {0.34f, 0.12f}, {0.26f, 0.2f},   {0.22f, 1.6f},
                            {0.2f, 3.2f},  {0.3f, 3.4f},   {0.34f, kHeight}};
    g.revolve({x, 0.0f, z}, profile, 24);
}

}  // namespace

Status write_gallery(const std::filesystem::path& folder) {
    GlbBuilder glb;
    const int plaster = glb.add_material(make_material("plaster", {0.78f, 0.76f, 0.72f}));
    const int red = glb.add_material(make_material("red wall", {0.62f, 0.09f, 0.06f}));
    const int blue = glb.add_material(make_material("blue plinth", {0.12f, 0.22f, 0.5f}));
    const int white = glb.add_material(make_material("white stone", {0.85f, 0.85f, 0.83f}));
    Json floor_material = make_material("planks", {1, 1, 1});
    floor_material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", glb.add_png_texture(planks_png())}};
    const int planks = glb.add_material(floor_material);
    Json lamp_material = make_material("lamp", {0.8f, 0.8f, 0.8f});
    lamp_material["emissiveFactor"] = {1.0, 0.78, 0.5};
    lamp_material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", 60.0}};
    glb.use_extension("KHR_materials_emissive_strength");
    const int lamp = glb.add_material(lamp_material);

    Geometry floor, walls, red_wall, windows, columns, sphere, plinth, bench, lantern;
    floor.material = planks;
    floor.quad({0, 0, kDepth}, {kWidth, 0, 0}, {0, 0, -kDepth}, 2.0f);
    walls.material = plaster;
    walls.quad({0, 0, 0}, {kWidth, 0, 0}, {0, kHeight, 0});                                  // back
    walls.quad({kWidth, 0, 0}, {0, 0, kDepth}, {0, kHeight, 0});                             // right
    walls.quad({0, kHeight, 0}, {kWidth, 0, 0}, {0, 0, kDepth});                             // ceiling
    walls.box({-kWall, kHeight, -kWall}, {kWidth + kWall, kHeight + 0.2f, kDepth + kWall});  // roof
    walls.box({-kWall, 0, -kWall}, {kWidth + kWall, kHeight, -0.001f});  // outer shells keep light out
    walls.box({kWidth + 0.001f, 0, 0}, {kWidth + kWall, kHeight, kDepth});
    walls.box({-kWall, 0, 0}, {-0.001f, kHeight, kDepth});
    red_wall.material = red;
    red_wall.quad({0, 0, kDepth}, {0, 0, -kDepth}, {0, kHeight, 0});
    windows.material = plaster;
    window_wall(windows);
    columns.material = white;
    column(columns, 3.0f, 2.0f);
    sphere.material = white;
    sphere.sphere({0, 1.35f, 0}, 0.45f, 12, 24);
    plinth.material = blue;
    plinth.box({-0.4f, 0.0f, -0.4f}, {0.4f, 0.9f, 0.4f});
    bench.material = red;
    bench.box({-0.8f, 0.38f, -0.2f}, {0.8f, 0.46f, 0.2f});
    bench.box({-0.7f, 0.0f, -0.15f}, {-0.6f, 0.38f, 0.15f});
    bench.box({0.6f, 0.0f, -0.15f}, {0.7f, 0.38f, 0.15f});
    lantern.material = lamp;
    lantern.box({-0.12f, -0.18f, -0.12f}, {0.12f, 0.18f, 0.12f});

    const auto mesh = [&](const char* name, const Geometry& g) { return glb.add_mesh(name, std::span(&g, 1)); };
    const auto place = [&](const char* name, int m, Vec3 t) {
        glb.add_node({{"name", name}, {"mesh", m}, {"translation", {t.x, t.y, t.z}}});
    };
    place("floor", mesh("floor", floor), {});
    place("walls", mesh("walls", walls), {});
    place("red wall", mesh("red wall", red_wall), {});
    place("windows", mesh("windows", windows), {});
    const int column_mesh = mesh("column", columns);
    place("column left", column_mesh, {});
    place("column right", column_mesh, {3.2f, 0, 0});
    place("sphere", mesh("sphere", sphere), {4.6f, 0, 3.2f});
    place("plinth", mesh("plinth", plinth), {4.6f, 0, 3.2f});
    const int bench_mesh = mesh("bench", bench);
    place("bench left", bench_mesh, {1.8f, 0, 4.2f});
    place("bench right", bench_mesh, {7.3f, 0, 4.2f});
    place("lantern", mesh("lantern", lantern), {1.2f, 2.4f, 0.9f});

    const int sun =
        glb.add_light({{"type", "directional"}, {"name", "sun"}, {"intensity", 60.0}, {"color", {1.0, 0.93, 0.82}}});
    Json sun_node = make_node_looking("sun", {4, 8, 12}, {0.35f, -0.62f, -0.7f});
    sun_node["extensions"]["KHR_lights_punctual"]["light"] = sun;
    glb.add_node(sun_node);
    const int lens = glb.add_perspective_camera(0.9f);
    for (const auto& [name, eye, target] : {std::tuple{"entrance", Vec3{8.4f, 1.7f, 5.4f}, Vec3{2.6f, 1.2f, 1.2f}},
                                            std::tuple{"corner", Vec3{0.6f, 1.6f, 5.2f}, Vec3{6.5f, 1.1f, 1.0f}}}) {
        Json camera = make_node_looking(name, eye, target - eye);
        camera["camera"] = lens;
        glb.add_node(camera);
    }
    LUMEL_TRY_STATUS(glb.write(folder / "gallery.glb"));

    const Json sidecar{{"sky", {{"color", {1.4, 2.0, 3.0}}}}, {"lights", {{"sun", {{"angle_degrees", 0.53}}}}}};
    const std::string text = sidecar.dump(2) + "\n";
    return write_file(folder / "gallery.lumel.json", std::as_bytes(std::span(text)));
}

}  // namespace lumel::samples
