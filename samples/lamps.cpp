// Light in many small pieces, or all from one direction: what choosing lights and sampling a sky are measured on.
#include <cmath>

#include "base/try.h"
#include "math/constants.h"
#include "samples.h"

namespace lumel::samples {
namespace {

// The additive recurrence of the plastic number's powers: points of any number spread evenly over a cube.
Vec3 spread(std::uint32_t i) {
    constexpr double kPlastic = 1.2207440846057596;  // of three dimensions: x^4 = x + 1
    Vec3 out;
    double step = 1.0;
    for (std::size_t c = 0; c < 3; ++c) {
        step /= kPlastic;
        const double at = 0.5 + step * (i + 1.0);
        out[c] = static_cast<float>(at - std::floor(at));
    }
    return out;
}

}  // namespace

Status write_lamps(const std::filesystem::path& folder, std::uint32_t lamps) {
    constexpr float kTotalArea = 0.5f, kRadiance = 8.0f;  // m^2; of all lamps together
    constexpr Vec3 kLow{-4, 0, -4}, kHigh{4, 3, 4};
    GlbBuilder glb;
    glb.use_extension("KHR_materials_emissive_strength");
    Geometry room;
    room.material = glb.add_material(make_material("plaster", {0.6f, 0.55f, 0.5f}));
    room.box(kLow, kHigh, true);
    glb.add_node({{"name", "room"}, {"mesh", glb.add_mesh("room", std::span(&room, 1))}});

    Json glow = make_material("glow", {0, 0, 0});
    glow["emissiveFactor"] = {1.0, 1.0, 1.0};
    glow["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", kRadiance}};
    Geometry g;
    g.material = glb.add_material(glow);
    const float edge = std::sqrt(4.0f / std::sqrt(3.0f) * kTotalArea / static_cast<float>(lamps));
    const Vec3 margin{0.4f, 0.4f, 0.4f}, low = kLow + margin, span = kHigh - kLow - margin * 2.0f;
    for (std::uint32_t i = 0; i < lamps; ++i) {
        const Vec3 at = low + spread(i) * span, turn = spread(i + lamps);
        // Facing anywhere: an even direction of the sphere, and two more at right angles to it.
        const float z = 2.0f * turn.x - 1.0f, r = std::sqrt(1.0f - z * z), phi = 2.0f * kPi * turn.y;
        const Vec3 n{r * std::cos(phi), r * std::sin(phi), z};
        const Vec3 u = normalize(cross(n, std::fabs(n.z) < 0.9f ? Vec3{0, 0, 1} : Vec3{1, 0, 0})), v = cross(n, u);
        const auto first = static_cast<std::uint32_t>(g.positions.size());
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            const float angle = 2.0f * kPi * static_cast<float>(corner) / 3.0f;
            g.positions.push_back(at + (u * std::cos(angle) + v * std::sin(angle)) * (edge / std::sqrt(3.0f)));
            g.normals.push_back(n);
            g.uv.push_back({});
            g.indices.push_back(first + corner);
        }
    }
    const int mesh = glb.add_mesh("lamps", std::span(&g, 1));
    glb.add_node({{"name", "lamps"}, {"mesh", mesh}, {"extras", {{"lightmap", false}}}});
    return glb.write(folder / ("lamps_" + std::to_string(lamps) + ".glb"));
}

Status write_plain(const std::filesystem::path& folder) {
    GlbBuilder glb;
    Geometry floor;
    floor.material = glb.add_material(make_material("earth", {0.5f, 0.5f, 0.5f}));
    floor.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
    glb.add_node({{"name", "floor"}, {"mesh", glb.add_mesh("floor", std::span(&floor, 1))}});
    return glb.write(folder / "plain.glb");
}

}  // namespace lumel::samples
