// An emissive square lights a black one: form factors of Howell's catalogue, and Lambert's polygon texel by texel.
#include <gtest/gtest.h>

#include "baked_page.h"
#include "support/closed_forms.h"

namespace lumel {
namespace {

constexpr Vec3 kRadiance{1, 2, 3};
constexpr double kMeanTolerance = 0.003;

// The receiver is the unit square, facing up. The emitter takes no texels: the page is the receiver's.
void expect_form_factor(Vec3 corner, Vec3 u, Vec3 v, std::uint32_t edge, std::uint32_t samples, double form_factor) {
    const test::Square receiver{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, edge};
    test::SceneBuilder builder;
    receiver.add_to(builder, builder.material({0, 0, 0}));
    builder.object(
        "emitter", builder.material({0, 0, 0}, kRadiance), [&](Mesh& mesh) { test::add_quad(mesh, corner, u, v); }, {},
        NodeClass::volume);
    const auto texels = test::bake_texels(builder.build(), receiver.options(samples));
    ASSERT_EQ(texels.size(), edge * edge);

    const std::vector<closed_form::Vec> polygon{corner, corner + u, corner + u + v, corner + v};
    const auto expected = [&](const test::BakedTexel& texel) {
        const double i = receiver.mean_over(texel, [&](Vec3 p) {
            return closed_form::polygon_light(p, receiver.normal(), polygon, 1.0) / closed_form::kPi;
        });
        return std::array<double, 3>{i * kRadiance.x, i * kRadiance.y, i * kRadiance.z};
    };
    test::expect_texels(texels, expected, kMeanTolerance);

    // The page as a whole receives the form factor. Texels gather from their middle, which leaves out a part of second
    // order in their size over the distance: 4e-4 at 1/16, 7e-4 at 1/3.
    double mean = 0;
    for (const test::BakedTexel& texel : texels) mean += texel.irradiance.x / static_cast<double>(texels.size());
    EXPECT_NEAR(mean / (form_factor * kRadiance.x), 1.0, kMeanTolerance);
}

TEST(FacingSquares, OneApart) { expect_form_factor({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 16, 512, 0.19982489569838746); }

TEST(FacingSquares, ATenthApart) {
    expect_form_factor({0, 0.1f, 0}, {1, 0, 0}, {0, 0, 1}, 32, 256, 0.8269945223972565);
}

// The irradiance has a kink at the shared edge, where every direction meets the emitter at once.
TEST(FacingSquares, SharingAnEdge) {
    expect_form_factor({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 16, 1024, 0.20004377607540316);
}

}  // namespace
}  // namespace lumel
