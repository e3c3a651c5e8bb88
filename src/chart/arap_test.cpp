#include "chart/arap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "chart/flatten.h"
#include "support/meshes.h"

namespace lumel {
namespace {

struct Relaxed {
    double before, after;  // L2 stretch
};

// Relaxes the map that `uv` gives for each vertex of the patch.
template <class Map>
Relaxed relax(const Mesh& mesh, const Map& map) {
    const MeshTopology topology = build_topology(mesh);
    std::vector<std::uint32_t> all;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (topology.area[t] > 0.0) all.push_back(t);
    const Patch patch = make_patch(mesh, topology, all);
    Uvs uv;
    for (const Eigen::Vector3d& p : patch.positions) uv.push_back(map(p));
    const Attempt before = attempt(mesh, topology, all, patch, uv, 100.0);
    relax_as_rigid(patch, 200, uv);
    const Attempt after = attempt(mesh, topology, all, patch, uv, 100.0);
    EXPECT_TRUE(after.good());
    return {before.stretch, after.stretch};
}

// A quarter of a tube, drawn as it looks from the middle: what unrolls has an isometry, and the energy is zero there
// alone.
TEST(Arap, UnrollsATube) {
    const Mesh mesh = test::cylinder(16, 0.25f, 1.0f, 2.0f);
    const Relaxed r = relax(mesh, [](const Eigen::Vector3d& p) { return Eigen::Vector2d(p.y() - p.x(), p.z()); });
    EXPECT_GT(r.before, 1.005);
    EXPECT_LT(r.after, 1.0005);
}

// Half a sphere. The equidistant map (radius = angle r) is known to be good. It is true to length along meridians and
// stretches circles by r / sin r: its L2 stretch is the root of (1 + m) / 2 (pi^2 / 8), where pi^2 / 8 is the area of
// the disc over that of the half sphere and m the mean of (sin r / r)^2, the integral of sin^3 r / r^2 dr from 0 to pi
// / 2. The relaxed map is about as good: the energies are not the same, hence half a per cent.
TEST(Arap, AHemisphereIsNoWorseThanTheEquidistantMap) {
    const Mesh mesh = test::surface(48, 16, [](float u, float v) {
        const float phi = test::turn_angle(u), r = 1.5707963f * (1.0f - v);
        return Vec3{std::sin(r) * std::cos(phi), std::cos(r), -std::sin(r) * std::sin(phi)};
    });
    const auto equidistant = [](const Eigen::Vector3d& p) {
        const double out = std::hypot(p.x(), p.z()), angle = std::atan2(out, p.y());
        return out > 0.0 ? Eigen::Vector2d(angle * p.x() / out, -angle * p.z() / out) : Eigen::Vector2d(0.0, 0.0);
    };
    const Relaxed r = relax(mesh, equidistant);
    EXPECT_NEAR(r.before, 1.0211, 0.002) << "facets of 6 degrees";
    EXPECT_LT(r.after, r.before + 0.005);
}

}  // namespace
}  // namespace lumel
