// An emissive square lights a black one: form factors of Howell's catalogue, and Lambert's polygon texel by texel.
#include <gtest/gtest.h>

#include "baked_page.h"
#include "support/closed_forms.h"

namespace lumel {
namespace {

constexpr Vec3 kRadiance{1, 2, 3};
const test::Square kReceiver{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};  // the unit square, facing up

// The emitter takes no texels: the page is the receiver's.
void expect_form_factor(Vec3 corner, Vec3 u, Vec3 v, std::uint32_t samples, double form_factor, double quadrature) {
    test::SceneBuilder builder;
    kReceiver.add_to(builder, builder.material({0, 0, 0}));
    builder.object(
        "emitter", builder.material({0, 0, 0}, kRadiance), [&](Mesh& mesh) { test::add_quad(mesh, corner, u, v); }, {},
        NodeClass::volume);
    const auto texels = test::bake_texels(builder.build(), test::Square::options(samples));
    ASSERT_EQ(texels.size(), test::Square::kTexels * test::Square::kTexels);

    const std::vector<closed_form::Vec> polygon{corner, corner + u, corner + u + v, corner + v};
    const auto form_factor_of = [&](const test::BakedTexel& texel) {
        return kReceiver.mean_over(texel, [&](Vec3 p) {
            return closed_form::polygon_light(p, kReceiver.normal(), polygon, 1.0) / closed_form::kPi;
        });
    };
    const auto expected = [&](const test::BakedTexel& texel) {
        const double i = form_factor_of(texel);
        return std::array<double, 3>{i * kRadiance.x, i * kRadiance.y, i * kRadiance.z};
    };
    test::expect_texels(texels, expected, 0.003);

    // The expectation itself: its mean is the form factor, up to the rule of 64 points a texel.
    double mean = 0;
    for (const test::BakedTexel& texel : texels) mean += form_factor_of(texel) / static_cast<double>(texels.size());
    EXPECT_NEAR(mean, form_factor, quadrature);
}

TEST(FacingSquares, OneApart) { expect_form_factor({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 512, 0.19982489569838746, 1e-5); }

TEST(FacingSquares, ATenthApart) {
    expect_form_factor({0, 0.1f, 0}, {1, 0, 0}, {0, 0, 1}, 512, 0.8269945223972565, 1e-4);
}

// The irradiance has a kink at the shared edge, where every direction meets the emitter at once.
TEST(FacingSquares, SharingAnEdge) {
    expect_form_factor({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1024, 0.20004377607540316, 1e-3);
}

}  // namespace
}  // namespace lumel
