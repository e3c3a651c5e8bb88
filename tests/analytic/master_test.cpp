// The master of texels whose light is known on paper: all nine coefficients, occlusion, its direction and the sky's
// part.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "math/constants.h"
#include "sh/basis.h"
#include "support/charted_scene.h"

namespace lumel {
namespace {

constexpr auto kDirect = static_cast<std::size_t>(Layer::direct), kSky = static_cast<std::size_t>(Layer::sky);
constexpr Vec3 kTilted{0.36f, 0.8f, 0.48f};  // unit

std::uint32_t add_square(test::SceneBuilder& b, Vec3 normal, bool double_sided) {
    const Vec3 u = normalize(cross({0, 0, 1}, normal)), v = cross(normal, u);
    return b.object("square", b.material({0.5f, 0.5f, 0.5f}, {}, double_sided),
                    [&](Mesh& m) { test::add_quad(m, (u + v) * -0.5f, u, v); });
}

void add_sun(test::SceneBuilder& b, Vec3 towards_it, Vec3 illuminance) {
    Light& sun = b.light(LightShape::sun);
    sun.direction = towards_it * -1.0f;
    sun.intensity = illuminance;
}

PathOptions direct_only(std::uint32_t samples) {
    PathOptions path;
    path.samples = samples;
    path.bounces = 0;
    return path;
}

// A sun without size is one direction: its coefficients are its illuminance times the basis there, in the world's
// frame.
TEST(Master, ASunIsItsDirection) {
    Context context(1);
    test::SceneBuilder b;
    add_square(b, kTilted, false);
    const Vec3 towards = normalize(Vec3{0.5f, 0.7f, -0.2f}), illuminance{3, 2, 1};
    add_sun(b, towards, illuminance);
    const test::ChartedScene scene(b.build(), 8, context);
    const RadianceSums sums = scene.gather(direct_only(64));
    const ShBasis basis = sh_basis(towards);
    ASSERT_GT(sums.size(), 40u);
    for (std::size_t t = 0; t < sums.size(); ++t)
        for (std::size_t c = 0; c < 3; ++c) {
            const LayerMoments& direct = sums.layers[t][kDirect];
            for (std::size_t i = 0; i < kShCoefficients; ++i)
                ASSERT_NEAR(direct.sh[i][c], illuminance[c] * basis[i], 1e-5f) << t << " " << i;
            ASSERT_NEAR(direct.irradiance[c], illuminance[c] * dot(towards, kTilted) * kInvPi, 1e-5f);
        }
}

// An even sky over half of the sphere: zonal about the normal, by band 2 pi k0, pi k1 and 0.
TEST(Master, AnEvenSkyIsZonalAboutTheNormal) {
    Context context(1);
    test::SceneBuilder b;
    add_square(b, kTilted, false);
    const Vec3 radiance{1, 2, 4};
    b.scene().sky.color = radiance;
    const test::ChartedScene scene(b.build(), 8, context);
    const RadianceSums sums = scene.gather(direct_only(1024));
    const ShBasis about = sh_basis(kTilted);
    std::array<double, kShCoefficients> mean{};
    double irradiance = 0.0, from_master = 0.0;
    for (std::size_t t = 0; t < sums.size(); ++t) {
        const LayerMoments& sky = sums.layers[t][kSky];
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < kShCoefficients; ++i)
                mean[i] += static_cast<double>(sky.sh[i][c] / radiance[c]) / (3.0 * static_cast<double>(sums.size()));
        irradiance += static_cast<double>(sky.irradiance.x) / static_cast<double>(sums.size());
        for (std::size_t i = 0; i < kShCoefficients; ++i) {
            constexpr float kBands[] = {1.0f, 2.0f / 3, 2.0f / 3, 2.0f / 3, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f};
            from_master += static_cast<double>(kBands[i] * sky.sh[i].x * about[i]) / static_cast<double>(sums.size());
        }
    }
    // Some sixty texels of 1024 stratified samples: noise of 1e-3.
    constexpr double kNoise = 5e-3;
    EXPECT_NEAR(mean[0], 2.0 * M_PI * static_cast<double>(kSh0), kNoise);
    for (std::size_t i = 1; i < 4; ++i)  // Y_i(normal) sqrt(4 pi / 3) is its coordinate, up to sign
        EXPECT_NEAR(mean[i], M_PI * static_cast<double>(kSh1) * static_cast<double>(about[i] / kSh1), kNoise) << i;
    for (std::size_t i = 4; i < kShCoefficients; ++i) EXPECT_NEAR(mean[i], 0.0, kNoise) << i;
    EXPECT_NEAR(irradiance, 1.0, kNoise);
    EXPECT_NEAR(from_master, irradiance, kNoise);
}

// With --two-sided the coefficients are of the whole sphere, and the irradiance is the mean of the sides'.
TEST(Master, TwoSidedTexelsHoldTheLightOfTheWholeSphere) {
    Context context(1);
    test::SceneBuilder b;
    add_square(b, {0, 1, 0}, true);
    add_sun(b, {0, 1, 0}, {4, 4, 4});
    add_sun(b, {0, -1, 0}, {2, 2, 2});
    const test::ChartedScene scene(b.build(), 8, context);
    PathOptions path = direct_only(256);
    const ShBasis up = sh_basis({0, 1, 0}), down = sh_basis({0, -1, 0});
    for (const bool two_sided : {false, true}) {
        path.two_sided = two_sided;
        const RadianceSums sums = scene.gather(path);
        ASSERT_GT(sums.size(), 40u);
        const float below = two_sided ? 2.0f : 0.0f;
        for (std::size_t t = 0; t < sums.size(); ++t) {
            const LayerMoments& direct = sums.layers[t][kDirect];
            for (std::size_t i = 0; i < kShCoefficients; ++i)
                ASSERT_NEAR(direct.sh[i].x, 4.0f * up[i] + below * down[i], 1e-5f) << two_sided << " " << t << " " << i;
            ASSERT_NEAR(direct.irradiance.x, (two_sided ? 3.0f : 4.0f) * kInvPi, 1e-5f);
        }
    }
}

// A floor before a long wall, 2 m high: what of the hemisphere is free within the reach, where it is on average, and
// how much sky is above the wall. On the disc below the hemisphere, where the cosine is even, a wall at distance d is
// met within the reach R beyond the line x = d / R.
TEST(Master, AWallOccludesByItsDistance) {
    Context context(1);
    test::SceneBuilder b;
    const auto grey = b.material({0.5f, 0.5f, 0.5f});
    b.object("floor", grey, [](Mesh& m) { test::add_quad(m, {-3, 0, 0.5f}, {3, 0, 0}, {0, 0, -1}); });
    b.object("wall", grey, [](Mesh& m) { test::add_quad(m, {0, 0, -40}, {0, 0, 80}, {0, 2, 0}); });  // faces -x
    b.scene().sky.color = {1, 1, 1};
    const test::ChartedScene scene(b.build(), 4, context);
    PathOptions path = direct_only(1024);
    path.ao_distance = 1.0f;
    const RadianceSums sums = scene.gather(path);
    std::size_t compared = 0, beyond = 0;
    double open = 0.0, bent = 0.0, sky = 0.0;
    for (std::size_t t = 0; t < sums.size(); ++t) {
        const Vec3 p = scene.texels.position[t];
        if (p.y > 1e-3f || p.x > -0.25f) continue;  // of the floor, and not so near that the texel's width matters
        const double d = -static_cast<double>(p.x), height = 2.0;
        const double free = d >= 1.0 ? 1.0 : 1.0 - (std::acos(d) - d * std::sqrt(1.0 - d * d)) / M_PI;
        const double lean = d >= 1.0 ? 0.0 : -2.0 / (3.0 * M_PI) * std::pow(1.0 - d * d, 1.5);
        const double above = 0.5 * (1.0 + d / std::sqrt(d * d + height * height));
        // Of 1024 samples, estimated by their weights: a few hundredths at most.
        EXPECT_NEAR(static_cast<double>(sums.ambient_occlusion[t]), free, 0.03) << d;
        EXPECT_NEAR(static_cast<double>(sums.bent_normal[t].x), lean, 0.03) << d;
        EXPECT_NEAR(static_cast<double>(sums.sky_visibility[t]), above, 0.03) << d;
        open += static_cast<double>(sums.ambient_occlusion[t]) - free;
        bent += static_cast<double>(sums.bent_normal[t].x) - lean;
        sky += static_cast<double>(sums.sky_visibility[t]) - above;
        beyond += d >= 1.0;
        ++compared;
    }
    ASSERT_GT(compared, 30u);
    EXPECT_GT(beyond, 15u);
    const auto n = static_cast<double>(compared);
    EXPECT_NEAR(open / n, 0.0, 5e-3);
    EXPECT_NEAR(bent / n, 0.0, 5e-3);
    EXPECT_NEAR(sky / n, 0.0, 5e-3);
}

}  // namespace
}  // namespace lumel
