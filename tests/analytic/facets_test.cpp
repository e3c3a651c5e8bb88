// A coarse smooth-shaded sphere is lit as the smooth sphere that its normals describe: texels show the light of their
// vertex normal, and none of the edges of the facets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "baked_page.h"
#include "math/constants.h"
#include "support/meshes.h"

namespace lumel {
namespace {

constexpr std::uint32_t kRings = 6;                    // 12 x 6 quads: facets turn by 30 degrees from one to the next
constexpr double kTexelsPerMetre = 24;                 // of a sphere of radius 1: 2.4 degrees a texel
constexpr double kTexelAngle = 1.0 / kTexelsPerMetre;  // radians

Mesh smooth_sphere() {
    Mesh mesh = test::sphere(kRings, 1.0f);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.normals[v] = normalize(mesh.positions[v]);
    return mesh;
}

// The sphere alone, black, so that all its light comes straight from the sun or the sky.
std::vector<test::BakedTexel> bake_sphere(test::SceneBuilder& builder, std::uint32_t samples) {
    const std::uint32_t black = builder.material({0, 0, 0});
    builder.object("sphere", black, [](Mesh& mesh) {
        mesh = smooth_sphere();
        mesh.primitives.clear();
    });
    BakeOptions options;
    options.texels_per_metre = kTexelsPerMetre;
    options.samples = samples;
    options.bounces = 0;
    options.uv1 = Uv1Choice::ignore;
    return test::bake_texels(builder.build(), options);
}

// The facet through which the ray along `normal` leaves the sphere: its quad, by longitude and latitude.
int facet_of(Vec3 normal) {
    const double ring = std::acos(std::clamp(double{normal.z}, -1.0, 1.0)) * kRings / double{kPi};
    const double turn = (std::atan2(double{normal.y}, double{normal.x}) / double{kPi} + 1.0) * kRings;
    return static_cast<int>(ring) * 1000 + static_cast<int>(turn);
}

// Texels side by side on one chart, one on each side of an edge of facets, both within `wanted`.
template <class Wanted>
std::vector<std::pair<const test::BakedTexel*, const test::BakedTexel*>> across_edges(
    const std::vector<test::BakedTexel>& texels, Wanted&& wanted) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, const test::BakedTexel*> at;
    for (const test::BakedTexel& texel : texels) at[{texel.x, texel.y}] = &texel;
    std::vector<std::pair<const test::BakedTexel*, const test::BakedTexel*>> out;
    for (const test::BakedTexel& a : texels)
        for (const auto& [dx, dy] : {std::pair{1u, 0u}, std::pair{0u, 1u}}) {
            const auto b = at.find({a.x + dx, a.y + dy});
            if (b == at.end() || b->second->chart != a.chart || !wanted(a) || !wanted(*b->second)) continue;
            if (facet_of(a.normal) != facet_of(b->second->normal)) out.emplace_back(&a, b->second);
        }
    return out;
}

TEST(Facets, ASunShowsNoneOnACoarseSphere) {
    constexpr double kLux = 1000;
    const Vec3 towards = normalize({0.5f, 0.3f, 0.8f});
    test::SceneBuilder builder;
    Light& sun = builder.light(LightShape::sun);
    sun.direction = -towards;
    sun.intensity = Vec3{1, 1, 1} * static_cast<float>(kLux);
    const auto texels = bake_sphere(builder, 64);
    ASSERT_GT(texels.size(), 5000u);

    const double full = kLux / double{kPi};
    const auto expected = [&](const test::BakedTexel& texel) {
        return full * std::max(0.0, double{dot(texel.normal, towards)});
    };
    // Beyond 20 degrees from the terminator all of the facet faces the sun, or none of it does: vertex normals and the
    // facet's differ by up to half of the 30 degrees in either direction.
    const auto is_clear = [&](const test::BakedTexel& texel) { return std::abs(dot(texel.normal, towards)) > 0.35f; };
    // The normal is that of one point of a texel, which lies up to half a texel from the mean of its points (at rims of
    // charts): an error of that angle times the sine to the sun. Facets' own normals would be 15 degrees off.
    const double tolerance = full * 0.5 * kTexelAngle;
    double worst = 0.0, worst_step = 0.0;
    for (const test::BakedTexel& texel : texels)
        if (is_clear(texel)) worst = std::max(worst, std::abs(double{texel.irradiance.y} - expected(texel)));
    EXPECT_LT(worst, tolerance) << "of " << full;

    const auto pairs = across_edges(texels, is_clear);
    ASSERT_GT(pairs.size(), 300u);
    for (const auto& [a, b] : pairs) {
        // Neighbours are a texel apart, on their facets, which are up to cos 21 degrees nearer: never 30 degrees.
        EXPECT_LT(length(a->normal - b->normal), 2.5f * static_cast<float>(kTexelAngle));
        const double step = double{a->irradiance.y} - double{b->irradiance.y} - (expected(*a) - expected(*b));
        worst_step = std::max(worst_step, std::abs(step));
    }
    EXPECT_LT(worst_step, tolerance) << "of " << full;
    RecordProperty("worst", std::to_string(worst / full));
    RecordProperty("worst_step", std::to_string(worst_step / full));
}

TEST(Facets, AnEvenSkyShowsNoneOnACoarseSphere) {
    test::SceneBuilder builder;
    builder.scene().sky.color = {1, 1, 1};
    const auto texels = bake_sphere(builder, 256);
    ASSERT_GT(texels.size(), 5000u);
    double worst = 0.0, worst_step = 0.0;
    for (const test::BakedTexel& texel : texels) worst = std::max(worst, std::abs(double{texel.irradiance.y} - 1.0));
    const auto pairs = across_edges(texels, [](const test::BakedTexel&) { return true; });
    ASSERT_GT(pairs.size(), 500u);
    for (const auto& [a, b] : pairs)
        worst_step = std::max(worst_step, std::abs(double{a->irradiance.y} - double{b->irradiance.y}));
    // A facet hides from points at its edges what is below it: 15 degrees take (1 - cos 15)/2 = 1.7 % of the light of
    // the hemisphere. Starts lie on the sphere but for its fourth order (0.26^4 = 0.5 %, of the radius), from where it
    // is the lens of that height that hides some, and noise is nothing, for all that is seen is 1.
    EXPECT_LT(worst, 0.005);
    EXPECT_LT(worst_step, 0.005);
    RecordProperty("worst", std::to_string(worst));
    RecordProperty("worst_step", std::to_string(worst_step));
}

}  // namespace
}  // namespace lumel
