// Many instances of a few houses on a grid: what a large level asks of charts, packing and memory.
#include <cmath>

#include "base/try.h"
#include "io/image_io.h"
#include "samples.h"

namespace lumel::samples {
namespace {

constexpr std::uint32_t kKinds = 4;

// A house with plinth, body, two side wings, chimney and steps; no two kinds alike.
Geometry house(std::uint32_t kind) {
    Geometry g;
    const float w = 3.0f + 0.4f * static_cast<float>(kind), h = 2.4f + 0.7f * static_cast<float>(kind % 3);
    g.box({-w, 0, -w}, {w, 0.3f, w});
    g.box({-w + 0.4f, 0.3f, -w + 0.4f}, {w - 0.4f, h, w - 0.4f});
    g.box({w - 0.4f, 0.3f, -1.0f}, {w - 0.1f, h * 0.7f, 1.0f});
    g.box({-w + 0.1f, 0.3f, -1.2f}, {-w + 0.4f, h * 0.6f, 0.8f});
    g.box({0.3f, h, 0.2f}, {0.8f, h + 1.0f, 0.7f});
    for (int step = 0; step < 2; ++step) {
        const float k = static_cast<float>(step);
        g.box({-0.6f, 0.0f, w + 0.3f * k}, {0.6f, 0.2f - 0.08f * k, w + 0.3f * (k + 1.0f)});
    }
    return g;
}

}  // namespace

Status write_town(const std::filesystem::path& folder, std::uint32_t buildings) {
    GlbBuilder glb;
    int meshes[kKinds];
    for (std::uint32_t kind = 0; kind < kKinds; ++kind) {
        const float k = static_cast<float>(kind);
        Geometry g = house(kind);
        g.material =
            glb.add_material(make_material("house " + std::to_string(kind), {0.75f - 0.1f * k, 0.6f, 0.4f + 0.1f * k}));
        meshes[kind] = glb.add_mesh("house " + std::to_string(kind), std::span(&g, 1));
    }
    const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(buildings))));
    constexpr float kPitch = 13.0f;
    const float extent = kPitch * static_cast<float>(side);
    Geometry ground;
    ground.material = glb.add_material(make_material("ground", {0.35f, 0.35f, 0.33f}));
    // One tile a house: a single quad would be one chart larger than a page.
    ground.quad({-0.5f * kPitch, 0, 0.5f * kPitch}, {kPitch, 0, 0}, {0, 0, -kPitch});
    const int tile = glb.add_mesh("ground", std::span(&ground, 1));
    for (std::uint32_t i = 0; i < buildings; ++i) {
        const float x = kPitch * (static_cast<float>(i % side) + 0.5f) - 0.5f * extent;
        const float z = kPitch * (static_cast<float>(i / side) + 0.5f) - 0.5f * extent;
        const std::string number = std::to_string(i);
        glb.add_node({{"name", "ground " + number}, {"mesh", tile}, {"translation", {x, 0.0f, z}}});
        glb.add_node({{"name", "house " + number},
                      {"mesh", meshes[(i * 7 + i / side * 3) % kKinds]},
                      {"translation", {x, 0.0f, z}}});
    }
    const int sun =
        glb.add_light({{"type", "directional"}, {"name", "sun"}, {"intensity", 5.0}, {"color", {1.0, 0.93, 0.82}}});
    Json sun_node = make_node_looking("sun", {0.0f, 50.0f, 0.0f}, {0.4f, -1.0f, 0.3f});
    sun_node["extensions"]["KHR_lights_punctual"]["light"] = sun;
    glb.add_node(sun_node);
    const Json sidecar{{"sky", {{"color", {0.6, 0.8, 1.2}}}}, {"lights", {{"sun", {{"angle_degrees", 0.53}}}}}};
    const std::string text = sidecar.dump(2) + "\n";
    LUMEL_TRY_STATUS(write_file(folder / "town.lumel.json", std::as_bytes(std::span(text))));
    return glb.write(folder / "town.glb");
}

}  // namespace lumel::samples
