// The set of lights as a path tracer sees it: selection, artist's controls, hits, and expectations of it all together.
#include "light/light_set.h"

#include <gtest/gtest.h>

#include <memory>

#include "light/light_table.h"
#include "math/discrete.h"
#include "support/closed_forms.h"
#include "support/light_checks.h"
#include "support/sky_maps.h"
#include "support/world_builder.h"

namespace lumel {
namespace {

constexpr Vec3 kUp{0, 1, 0};

struct Fixture {
    test::World world;
    std::unique_ptr<LightSet> lights;

    explicit Fixture(test::WorldBuilder& builder) : world(builder.build()) {
        lights = std::make_unique<LightSet>(world.scene, world.geometry, world.surfaces());
    }
};

Light point_light(Vec3 position, Vec3 intensity) {
    Light light;
    light.position = position;
    light.intensity = intensity;
    return light;
}

Light rectangle_light(Vec3 center, float half, Vec3 radiance) {
    Light light;
    light.shape = LightShape::rectangle;
    light.position = center;
    light.half_u = {half, 0, 0};
    light.half_v = {0, 0, half};
    light.direction = {0, -1, 0};
    light.intensity = radiance;
    return light;
}

Light sun_light(float diameter) {
    Light light;
    light.shape = LightShape::sun;
    light.direction = normalize({0.3f, -1, 0.2f});
    light.intensity = {3, 7, 5};
    light.angular_diameter = diameter;
    return light;
}

test::Moments local_irradiance(const LightSet& lights, Vec3 point, Vec3 normal, bool bounced, int count = 400000,
                               const LightTable* table = nullptr) {
    test::Random random(1);
    test::Moments moments;
    for (int i = 0; i < count; ++i) {
        const float u = random.unit();
        const LightSample s = lights.sample_local({point, normal, table}, u, random.pair(), bounced);
        moments.add(s.distance > 0.0f ? double{s.weight.y} * std::max(0.0f, dot(s.direction, normal)) : 0.0);
    }
    return moments;
}

TEST(LightSet, OfADarkSceneIsEmpty) {
    test::WorldBuilder builder;
    builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    Light off = point_light({0, 1, 0}, {0, 0, 0});
    Light none = point_light({0, 1, 0}, {1, 1, 1});
    none.bake = LightBake::none;
    Light no_area = rectangle_light({0, 1, 0}, 0.0f, {1, 1, 1});
    builder.scene().lights = {off, none, no_area};
    builder.scene().sky.map = test::one_pixel_sky(8, 4, 1, 1, {0, 0, 0});
    const Fixture f(builder);
    EXPECT_TRUE(f.lights->empty());
    EXPECT_FALSE(f.lights->has_local());
    EXPECT_FALSE(f.lights->has_sky());
    EXPECT_EQ(f.lights->sample_local({{0, 0, 0}, kUp}, 0.5f, {0.5f, 0.5f}, false).distance, 0.0f);
}

TEST(LightSet, KnowsWhatItHolds) {
    test::WorldBuilder builder;
    builder.scene().lights = {sun_light(0.1f), point_light({0, 1, 0}, {1, 1, 1}), sun_light(0.0f)};
    builder.scene().sky.color = {1, 1, 1};
    const Fixture f(builder);
    EXPECT_FALSE(f.lights->empty());
    EXPECT_EQ(f.lights->sun_count(), 2u);
    EXPECT_TRUE(f.lights->has_sky());
    EXPECT_TRUE(f.lights->has_local());
    EXPECT_FALSE(f.lights->has_shapes());  // a point without a radius cannot be hit
}

// Points, spots, area lights and emissive triangles together: the irradiance is the sum of the closed forms.
void add_everything(test::WorldBuilder& builder) {
    Material material;
    material.emission = {1, 3, 2};
    builder.add_quad({-1, 2.5f, 1}, {1, 0, 0}, {0, 0, 0.5f}, builder.add_material(material));
    Light spot = point_light({-1, 2, 0.5f}, {10, 30, 20});
    spot.shape = LightShape::spot;
    spot.direction = normalize({1, -1.5f, 0});
    spot.inner_cone = 0.4f;
    spot.outer_cone = 0.9f;
    spot.radius = 0.2f;
    Light disc = rectangle_light({1, 1, -1}, 0.3f, {4, 2, 1});
    disc.shape = LightShape::disc;
    Light sphere = point_light({-0.5f, 1.2f, -0.5f}, {1, 5, 2});
    sphere.shape = LightShape::sphere;
    sphere.radius = 0.25f;
    builder.scene().lights = {point_light({0.5f, 2, 0.5f}, {3, 8, 5}), spot,
                              rectangle_light({0, 1.5f, 0}, 0.4f, {2, 6, 3}), disc, sphere};
}

double exact_everything(const Scene& scene, Vec3 p) {
    double sum = 0;
    const std::vector<Light>& l = scene.lights;
    sum += closed_form::point_light(p, kUp, l[0].position, l[0].intensity.y);
    sum += closed_form::point_light(p, kUp, l[1].position, l[1].intensity.y) *
           closed_form::spot_factor(l[1].direction, closed_form::Vec(p) - l[1].position, 0.4f, 0.9f);
    sum += closed_form::rectangle_light(p, kUp, l[2].position, {0, 0, 0.4f}, {0.4f, 0, 0}, l[2].intensity.y) +
           closed_form::rectangle_light(p, kUp, l[2].position, {0.4f, 0, 0}, {0, 0, 0.4f}, l[2].intensity.y);
    sum += closed_form::parallel_disc_light(0.3f, l[3].position.y - p.y,
                                            std::hypot(l[3].position.x - p.x, l[3].position.z - p.z), l[3].intensity.y);
    sum += closed_form::sphere_light(p, kUp, l[4].position, 0.25f, l[4].intensity.y);
    sum += closed_form::polygon_light(p, kUp, {{-1, 2.5, 1}, {0, 2.5, 1}, {0, 2.5, 1.5}, {-1, 2.5, 1.5}}, 3.0);
    return sum;
}

// Group g gets g + 1 shares, whatever it can bring.
LightTable lopsided_table(const LightSet& lights) {
    const auto groups = static_cast<std::uint32_t>(lights.groups().size());
    EXPECT_GE(groups, 5u);
    LightTable table;
    for (std::uint32_t g = 1; g <= groups; ++g)
        table.ends.push_back(static_cast<std::uint32_t>(std::uint64_t{kUnits} * g * (g + 1) / (groups * (groups + 1))));
    return table;
}

TEST(LightSet, ChoosesAmongAllKindsWithoutBias) {
    test::WorldBuilder builder;
    add_everything(builder);
    const Fixture f(builder);
    const LightTable table = lopsided_table(*f.lights);
    for (const LightTable* choice : {static_cast<const LightTable*>(nullptr), &table})
        for (const Vec3 point : {Vec3{0, 0, 0}, Vec3{0.4f, 0.2f, 0.9f}})
            EXPECT_TRUE(test::mean_agrees(local_irradiance(*f.lights, point, kUp, false, 400000, choice),
                                          exact_everything(f.world.scene, point), 1e-4, 4));
}

// Nearest hit of a ray with the emissive quad of add_everything and all shapes along it.
template <class Add>
void meet_everything(const Fixture& f, const Receiver& receiver, Vec3 direction, Add&& add) {
    const Vec3 origin = receiver.position;
    f.lights->shapes_along(receiver, direction, kInfiniteDistance, false, add);
    for (std::uint32_t t = 0; t < f.world.geometry.triangle_count(); ++t) {
        const auto [a, b, c] = f.world.geometry.corners(t);
        const Vec3 e1 = b - a, e2 = c - a, p = cross(direction, e2), s = origin - a, q = cross(s, e1);
        const float det = dot(e1, p), b1 = dot(s, p) / det, b2 = dot(direction, q) / det, distance = dot(e2, q) / det;
        if (!(b1 >= 0) || !(b2 >= 0) || b1 + b2 > 1 || distance <= 0) continue;
        const bool back = dot(direction, f.world.geometry.geometric_normal(t)) > 0;
        add(f.lights->emissive(receiver, t, b1, b2, direction, distance, back, false));
    }
}

// Multiple importance sampling over the whole set: right only if every hit's density includes the choice of its light.
test::Moments by_samples_and_hits(const Fixture& f, const Receiver& receiver) {
    const Frame frame(kUp);
    test::Random random(5);
    test::Moments moments;
    for (int i = 0; i < 400000; ++i) {
        double sum = 0;
        const float u = random.unit();
        const LightSample s = f.lights->sample_local(receiver, u, random.pair(), false);
        const double cosine = s.direction.y;
        if (s.distance > 0.0f && cosine > 0)
            sum += s.weight.y * cosine * (s.pdf > 0 ? s.pdf / (s.pdf + cosine * kInvPi) : 1.0);
        const Vec3 local = CosineHemisphere::sample(random.pair());
        meet_everything(f, receiver, frame.to_world(local), [&](const LightHit& hit) {
            sum += hit.radiance.y * local.z / (double{hit.pdf} + CosineHemisphere::pdf(local.z));
        });
        moments.add(sum);
    }
    return moments;
}

TEST(LightSet, DensitiesOfHitsAreThoseOfTheSamples) {
    test::WorldBuilder builder;
    add_everything(builder);
    const Fixture f(builder);
    const Vec3 point{0.1f, 0.1f, 0.2f};
    const LightTable table = lopsided_table(*f.lights);
    for (const Receiver& receiver : {Receiver{point, kUp, nullptr}, Receiver{point, kUp, &table}})
        EXPECT_TRUE(
            test::mean_agrees(by_samples_and_hits(f, receiver), exact_everything(f.world.scene, point), 1e-4, 2));
}

TEST(LightSet, EmissiveSamplesNameTheirTriangle) {
    test::WorldBuilder builder;
    builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
    Material material;
    material.emission = {1, 3, 2};
    builder.add_quad({-1, 2.5f, 1}, {1, 0, 0}, {0, 0, 0.5f}, builder.add_material(material));
    const Fixture f(builder);
    bool seen[2] = {false, false};
    for (int i = 0; i < 100; ++i) {
        const LightSample s =
            f.lights->sample_local({{0, 0, 0}, kUp}, static_cast<float>(i) / 100, {0.3f, 0.4f}, false);
        ASSERT_TRUE(s.triangle == 2 || s.triangle == 3) << s.triangle;
        seen[s.triangle - 2] = true;
    }
    EXPECT_TRUE(seen[0] && seen[1]);
    EXPECT_EQ(f.lights->emissive({{0, 0, 0}, kUp}, 0, 0.2f, 0.2f, {0, -1, 0}, 1, false, false).radiance, Vec3{});
}

TEST(LightSet, PowersBeyondAllMeasureDoNotBreakTheChoice) {
    test::WorldBuilder builder;
    Material material;
    material.emission = {1e12f, 1e12f, 1e12f};
    const auto bright = builder.add_material(material);
    builder.add_quad({0, 1, 0}, {1e20f, 0, 0}, {0, 0, 1e20f}, bright);  // of infinite area
    builder.add_quad({0, 2, 0}, {1e15f, 0, 0}, {0, 0, 1e15f}, bright);  // area times radiance is infinite in float
    builder.scene().lights = {point_light({0, 3, 0}, {1, 1, 1})};
    const Fixture f(builder);
    for (const float u : {0.0f, 0.5f, 0.9999999f})
        EXPECT_GE(f.lights->sample_local({{0, 0, 0}, kUp}, u, {0.3f, 0.4f}, false).distance, 0.0f);
}

TEST(LightSet, OccludersDoNotEmit) {
    test::WorldBuilder builder;
    Material material;
    material.emission = {1, 3, 2};
    builder.add_quad({-1, 2.5f, 1}, {1, 0, 0}, {0, 0, 0.5f}, builder.add_material(material));
    builder.scene().instances[0].node_class = NodeClass::occluder;
    const Fixture f(builder);
    EXPECT_TRUE(f.lights->empty());
    EXPECT_EQ(f.lights->emissive({{0, 0, 0}, kUp}, 0, 0.2f, 0.2f, {0, 1, 0}, 1, false, false).radiance, Vec3{});
}

TEST(LightSet, ADimLightIsChosenNowAndThenBesideABrightOne) {
    test::WorldBuilder builder;
    builder.scene().lights = {point_light({0, 1, 0}, {1e9f, 1e9f, 1e9f}),
                              point_light({0, 1, 0}, {1e-9f, 1e-9f, 1e-9f})};
    const Fixture f(builder);
    // Its share is the last unit of 2^24: nothing that a ray cannot hit is ever left out.
    const LightSample s = f.lights->sample_local({{0, 0, 0}, kUp}, 0x1.fffffep-1f, {0.5f, 0.5f}, false);
    EXPECT_NEAR(s.weight.y / (1e-9 * 0x1p24), 1.0, 1e-6);
}

TEST(ArtistControls, DecideWhichLayersALightReaches) {
    for (const bool is_sun : {true, false}) {
        test::WorldBuilder builder;
        Light light = is_sun ? sun_light(0.2f) : rectangle_light({0, 2, 0}, 0.5f, {3, 7, 5});
        light.bake = LightBake::indirect;
        light.indirect_scale = 2.0f;
        light.indirect_color = {1, 0.5f, 0.25f};
        builder.scene().lights = {light};
        const Fixture f(builder);
        const Vec2 u{0.4f, 0.6f};
        const auto sample = [&](bool bounced) {
            return is_sun ? f.lights->sample_sun(0, u, bounced)
                          : f.lights->sample_local({{0, 0, 0}, kUp}, 0.5f, u, bounced);
        };
        EXPECT_EQ(sample(false).weight, Vec3{});
        EXPECT_EQ(sample(false).distance, 0.0f);
        const LightSample bounced = sample(true);
        EXPECT_NEAR(bounced.weight.x / bounced.weight.y, 2 * 3.0 / 7.0, 1e-6);
        EXPECT_NEAR(bounced.weight.z / bounced.weight.x, 0.25 * 5.0 / 3.0, 1e-6);
        const auto radiance = [&](bool b) {
            Vec3 sum{};
            if (is_sun) return f.lights->sun(0, bounced.direction, b).radiance;
            f.lights->shapes_along({{0, 0, 0}, kUp}, bounced.direction, 10, b,
                                   [&](const LightHit& hit) { sum += hit.radiance; });
            return sum;
        };
        EXPECT_EQ(radiance(false), Vec3{});
        EXPECT_NEAR(radiance(true).y / (bounced.weight.y * bounced.pdf), 1.0, 1e-5);
    }
}

TEST(Shapes, AreMetOnlyBeforeTheSurfaceBehindThem) {
    test::WorldBuilder builder;
    builder.scene().lights = {rectangle_light({0, 2, 0}, 0.5f, {3, 7, 5}), rectangle_light({0, 3, 0}, 0.5f, {3, 7, 5})};
    const Fixture f(builder);
    const auto count = [&](float max_distance) {
        int n = 0;
        f.lights->shapes_along({{0, 0, 0}, kUp}, kUp, max_distance, false, [&](const LightHit&) { ++n; });
        return n;
    };
    EXPECT_EQ(count(1.9f), 0);
    EXPECT_EQ(count(2.5f), 1);
    EXPECT_EQ(count(kInfiniteDistance), 2);
}

TEST(Sky, OfConstantColourHasRadianceButNoSamples) {
    test::WorldBuilder builder;
    builder.scene().sky.color = {0.7f, 0.9f, 1.3f};
    const Fixture f(builder);
    EXPECT_EQ(f.lights->sample_sky({0.5f, 0.5f}).distance, 0.0f);
    const LightHit hit = f.lights->sky(normalize({1, 2, 3}));
    EXPECT_EQ(hit.radiance, (Vec3{0.7f, 0.9f, 1.3f}));
    EXPECT_EQ(hit.pdf, 0.0f);
}

TEST(Sky, GradientGivesTheClosedFormByEitherWay) {
    test::WorldBuilder builder;
    builder.scene().sky.map = test::gradient_sky(256, 128, 1.0f, 0.8f);
    const Fixture f(builder);
    const auto sample = [&](Vec2 u) { return f.lights->sample_sky(u); };
    const auto meet = [&](Vec3 d) { return f.lights->sky(d); };
    for (const Vec3 normal : {kUp, normalize({1, 0, 0.3f}), normalize({0.3f, -1, 0.2f})}) {
        // 1e-4: linear interpolation between rows of 1.4 degrees.
        const double expected = closed_form::gradient_sky(normal, 1.0, 0.8);
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_light(sample, normal), expected, 1e-4, 9, 1e-4));
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_rays(meet, normal), expected, 1e-4, 9, 1e-4));
        EXPECT_TRUE(test::mean_agrees(test::irradiance_by_both(sample, meet, normal), expected, 1e-4, 9, 1e-4));
    }
}

// Six maps with one bright pixel, one for each face of a cube; rotation turns them counter-clockwise seen from above.
TEST(Sky, OnePixelShinesFromWhereTheConventionSays) {
    struct Case {
        float u, v;
        Vec3 direction;
    };
    const std::vector<Case> cases{{0.5f, 0.5f, {1, 0, 0}},   {0.0f, 0.5f, {-1, 0, 0}}, {0.75f, 0.5f, {0, 0, 1}},
                                  {0.25f, 0.5f, {0, 0, -1}}, {0.5f, 0.0f, {0, 1, 0}},  {0.5f, 0.999f, {0, -1, 0}}};
    for (const Case& c : cases)
        for (const float quarter_turns : {0.0f, 1.0f}) {
            test::WorldBuilder builder;
            const auto x = static_cast<std::uint32_t>(c.u * 64), y = static_cast<std::uint32_t>(c.v * 32);
            builder.scene().sky.map = test::one_pixel_sky(64, 32, x, y, {1, 1, 1});
            builder.scene().sky.rotation = quarter_turns * 0.5f * kPi;
            const Fixture f(builder);
            // Counter-clockwise seen from above: x goes to -z, z goes to x.
            const Vec3 d = c.direction;
            const Vec3 expected = quarter_turns == 0.0f ? d : Vec3{d.z, d.y, -d.x};
            EXPECT_GT(f.lights->sky(expected).radiance.y, 0.2f)
                << c.u << " " << c.v;  // the corner of its tent: a quarter
            EXPECT_GT(dot(f.lights->sample_sky({0.5f, 0.5f}).direction, expected), 0.98f) << c.u << " " << c.v;
            EXPECT_EQ(f.lights->sky(-expected).radiance.y, 0.0f);
        }
}

TEST(Sky, SamplesAreMetWithTheirDensityUnderRotation) {
    test::WorldBuilder builder;
    builder.scene().sky.map = test::random_sky(32, 16, 1);
    builder.scene().sky.rotation = 0.7f;
    const Fixture f(builder);
    test::Random random(1);
    int different = 0;
    for (int i = 0; i < 50000; ++i) {
        const LightSample s = f.lights->sample_sky(random.pair());
        const LightHit hit = f.lights->sky(s.direction);
        if (std::fabs(hit.pdf / s.pdf - 1) > 1e-5) ++different;  // on a pixel's edge, by rounding
        if (s.weight.y > 0) {
            ASSERT_NEAR(hit.radiance.y, s.weight.y * s.pdf, 1e-3 * hit.radiance.y + 1e-3);
        }
    }
    EXPECT_LE(different, 10);
}

}  // namespace
}  // namespace lumel
