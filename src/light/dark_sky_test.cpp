#include "light/dark_sky.h"

#include <gtest/gtest.h>

namespace lumel {
namespace {

std::uint64_t warnings(const Sky& sky, float sun) {
    Scene scene;
    scene.sky = sky;
    Light light;
    light.shape = LightShape::sun;
    light.intensity = {sun, sun, sun};
    scene.lights.push_back(light);
    Diagnostics diagnostics;
    warn_of_dark_sky(scene, diagnostics);
    return diagnostics.count("dark-sky");
}

Sky even(float radiance) {
    Sky sky;
    sky.color = {radiance, radiance, radiance};
    return sky;
}

Sky even_map(float radiance) {
    Sky sky;
    sky.map = SkyMap{8, 4, std::vector<Vec3>(32, {radiance, radiance, radiance})};
    return sky;
}

TEST(DarkSky, IsWarnedOfBesideASun) {
    // An even sky of radiance L lights a plane with pi L: at 100,000 lux a thousandth is L = 31.8.
    EXPECT_EQ(warnings(even(1.0f), 1e5f), 1u);
    EXPECT_EQ(warnings(even(31.7f), 1e5f), 1u);
    EXPECT_EQ(warnings(even(32.0f), 1e5f), 0u);
    EXPECT_EQ(warnings(even_map(31.7f), 1e5f), 1u);
    EXPECT_EQ(warnings(even_map(32.0f), 1e5f), 0u);
}

TEST(DarkSky, IsNoneWhereItIsMeant) {
    EXPECT_EQ(warnings({}, 1e5f), 0u) << "a black sky is no mistake";
    EXPECT_EQ(warnings(even(1.0f), 0.0f), 0u) << "there is no sun to speak of";
    EXPECT_EQ(warnings(even(0.9f), 14.0f), 0u) << "whatever the unit";
}

}  // namespace
}  // namespace lumel
