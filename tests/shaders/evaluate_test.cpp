// shaders/*.glsl as C++ against the library's own decode, and against known answers of an independent double-precision
// program.
#include <gtest/gtest.h>

#include "encode/hhd.h"
#include "encode/specular.h"
#include "shaders/case_inputs.h"
#include "shaders/library.h"
#include "texture/light_codes.h"

namespace lumel {
namespace {

namespace glsl = test::glsl;

constexpr Vec3 kN7{2.0f / 7, 3.0f / 7, 6.0f / 7};
const glsl::vec3 kN7Glsl(kN7.x, kN7.y, kN7.z), kUp(0, 0, 1);

Vec3 to_vec(glsl::vec3 v) { return {v.x, v.y, v.z}; }
glsl::vec3 to_glsl(Vec3 v) { return {v.x, v.y, v.z}; }
float largest(Vec3 v) { return max_component(max(v, -v)); }

glsl::LumelSh to_sh(const Numbers& n) {
    const auto at = [&](std::size_t i) { return glsl::vec3(n[3 * i], n[3 * i + 1], n[3 * i + 2]); };
    return {at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8)};
}

glsl::LumelSh to_sh(const RadianceSh<Vec3, 9>& sh) {
    Numbers n{};
    for (std::size_t i = 0; i < 9; ++i) detail::store_vec3(n, 3 * i, sh.c[i]);
    return to_sh(n);
}

// One channel of test vector LK.
glsl::LumelSh known_sh() {
    constexpr std::array<float, 9> kLk{3, -.4f, .9f, -.6f, .25f, -.3f, .35f, -.15f, .2f};
    RadianceSh<Vec3, 9> sh;
    for (std::size_t i = 0; i < 9; ++i) sh.c[i] = Vec3{1, 1, 1} * kLk[i];
    return to_sh(sh);
}

void expect_vec(glsl::vec3 a, Vec3 b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(ShaderDecode, CoversEveryEncoding) {
    ASSERT_EQ(list_encodings().size(), test::kDecodes.size());
    for (const auto& [name, which] : test::kDecodes) EXPECT_NE(find_encoding(name), nullptr) << name;
}

// 1e-5 of what is summed: bands of linear models cancel where they are far larger than what they add up to.
TEST(ShaderDecode, EqualsTheLibrary) {
    for (const auto& [name, which] : test::kDecodes) {
        const Encoding& encoding = *find_encoding(name);
        test::Random uniform;
        double worst = 0.0;
        for (int texel = 0; texel < 400; ++texel) {
            Numbers numbers = test::solved(encoding, test::random_light(uniform));
            // As solved, in halves, and as textures hold them.
            if (texel % 3 != 0) quantise(encoding, texel % 3 == 1 ? Storage::half : Storage::texture, numbers);
            const float scale = 1e-6f + *std::ranges::max_element(numbers);
            for (int k = 0; k < 20; ++k) {
                const Vec3 n = k == 0 ? Vec3{0, 0, 1} : uniform.up();
                const Vec3 ours = to_vec(glsl::test_decode(which, to_sh(numbers), to_glsl(n)));
                const Vec3 theirs = encoding.decode(numbers, n);
                const double error = static_cast<double>(largest(ours - theirs) / std::max(scale, largest(theirs)));
                ASSERT_TRUE(is_finite(ours)) << name;
                worst = std::max(worst, error);
            }
        }
        EXPECT_LT(worst, 1e-5) << name;
    }
}

// L1 and its HHD are evaluated in the world frame; the library does so in the tangent frame.
TEST(ShaderDecode, WorldFrameSaysTheSame) {
    test::Random uniform;
    for (const Encoding* encoding : {&kL1Hhd, &kL1Mono}) {
        for (int texel = 0; texel < 400; ++texel) {
            const Vec3 normal = uniform.up(), n_ts = uniform.up();
            const Rotation frame = tangent_frame(normal);
            const Numbers tangent = test::solved(*encoding, test::random_light(uniform));
            Numbers world = tangent;
            encoding->rotate(world, transposed(frame));
            const glsl::LumelSh a = to_sh(world);
            const glsl::vec3 n_v = to_glsl(normal), n = to_glsl(to_world(frame, n_ts));
            const Vec3 ours = to_vec(encoding == &kL1Hhd ? glsl::lumel_l1_hhd(a.l0, a.l1, a.l2, a.l3, n_v, n)
                                                         : glsl::lumel_l1_mono(a.l0, a.l1, n_v, n));
            const Vec3 theirs = encoding->decode(tangent, n_ts);
            ASSERT_TRUE(is_finite(ours)) << encoding->name;
            // Rotations there and back round a few times.
            EXPECT_LT(largest(ours - theirs), 2e-5f * (1e-6f + largest(theirs) + world[0])) << encoding->name;
        }
    }
}

// Codes as their bytes over 255, saturated colours among them.
TEST(ShaderStorage, IsTheCodersOwn) {
    const auto sample = [](PixelBytes code) {
        const auto at = [&](std::size_t i) { return static_cast<float>(code[i]) / 255.0f; };
        return glsl::vec4(at(0), at(1), at(2), at(3));
    };
    const auto expect_equal = [](const char* name, glsl::vec3 ours, Vec3 theirs) {
        ASSERT_TRUE(is_finite(to_vec(ours))) << name;
        EXPECT_LT(largest(to_vec(ours) - theirs), 1e-5f * largest(theirs)) << name;
    };
    test::Random uniform;
    for (int i = 0; i < 3000; ++i) {
        Vec3 light = uniform.up();
        light = max(light, light * -1.0f);
        if (i % 3 == 0) light[static_cast<std::size_t>(i / 3 % 3)] = 0.0f;
        const PixelBytes m = encode_rgbm(light), d = encode_rgbd(light), luv = encode_logluv(light * 8.0f);
        expect_equal("rgbm", glsl::lumel_decode_rgbm(sample(m), 2.0f), decode_rgbm(m) * 2.0f);
        expect_equal("rgbd", glsl::lumel_decode_rgbd(sample(d), 2.0f), decode_rgbd(d) * 2.0f);
        expect_equal("logluv", glsl::lumel_decode_logluv(sample(luv), 2.0f), decode_logluv(luv) * 2.0f);
    }
}

TEST(ShaderTangentFrame, IsTheEncoders) {
    test::Random uniform;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 normal = uniform.up() * (i % 2 == 0 ? 1.0f : -1.0f), v = uniform.up();
        if (dot(normal, kN7) < -0.99f) continue;  // where the frame turns too fast for equal roundings
        // 1 + pole.n >= 0.01 divides, which magnifies rounding a hundredfold.
        expect_vec(glsl::lumel_to_tangent(to_glsl(normal), to_glsl(v)), to_tangent(tangent_frame(normal), v), 2e-5f);
    }
}

TEST(ShaderKnownAnswers, Hhd) {
    const auto check = [](float b_c, glsl::vec3 b, float iz, float ambient, float directional, Vec3 d) {
        const glsl::LumelHhd hhd = glsl::lumel_solve_hhd(b_c, b, kUp);
        EXPECT_NEAR(hhd.iz, iz, 1e-6f);
        EXPECT_NEAR(hhd.ambient, ambient, 1e-6f);
        EXPECT_NEAR(hhd.directional, directional, 1e-6f);
        expect_vec(hhd.direction, d, 1e-6f);
    };
    check(2.5f, {.6f, -.3f, 1.6f}, 1.6f, 0.681178001125f, 1.13764399775f,
          {0.527405762424f, -0.263702881212f, 0.807653361414f});
    check(1, {.9f, .3f, .8f}, 0.8f, 0, 1.2409673646f, {0.725240667623f, 0.241746889208f, 0.64465837122f});
    check(2, {.1f, 0, .3f}, 0.3f, 0.3f, 0.1f, {1, 0, 0});
    check(2, {.5f, 0, -.4f}, 0, 0, 0.5f, {1, 0, 0});
    const glsl::LumelHhd ring = glsl::lumel_solve_hhd_ring(2, {.1f, 0, .3f}, kUp);
    EXPECT_NEAR(ring.ring, 1.3f, 1e-6f);
    EXPECT_NEAR(glsl::lumel_evaluate_hhd(ring, kUp, kN7Glsl), 0.520283914423f, 1e-6f);
}

TEST(ShaderKnownAnswers, TheSplitIsTheWhole) {
    const glsl::LumelHhd hhd = glsl::lumel_solve_hhd(2.5f, {.6f, -.3f, 1.6f}, kUp);
    EXPECT_NEAR(glsl::lumel_evaluate_hhd_split(hhd.iz, hhd.direction * hhd.directional, kUp, kN7Glsl),
                glsl::lumel_evaluate_hhd(hhd, kUp, kN7Glsl), 1e-6f);
}

TEST(ShaderKnownAnswers, L1) {
    const glsl::vec3 l1n(.3f / 1.3f, .2f / 1.3f, .4f / 1.3f), back(-kN7.x, -kN7.y, -kN7.z);
    EXPECT_NEAR(glsl::lumel_hazel(1.3f, l1n, kN7Glsl), 2.60472031178f, 2e-6f);
    EXPECT_NEAR(glsl::lumel_hazel(1.3f, l1n, back), 0.540528873337f, 2e-6f);
    EXPECT_NEAR(glsl::lumel_hazel(.5f, {0, 0, .5f}, kUp), 1.16666666667f, 1e-6f);
    const glsl::vec3 l0(1.3f, 1.3f, 1.3f);
    EXPECT_NEAR(glsl::lumel_l1_linear(l0, l1n, l1n, l1n, kN7Glsl).x, 2.32857142857f, 1e-6f);
    EXPECT_NEAR(glsl::lumel_l1_linear(l0, l1n, l1n, l1n, back).x, 0.271428571429f, 1e-6f);
}

TEST(ShaderKnownAnswers, IrradZ) {
    const glsl::vec2 d(0.727272727273f, 0.454545454545f);
    expect_vec(glsl::lumel_from_hemi_octahedral(d), kN7, 1e-6f);
    const glsl::vec3 n(-1.0f / 3, 2.0f / 3, 2.0f / 3), iz(1.7f, 1.7f, 1.7f);
    EXPECT_NEAR(glsl::lumel_irradz_ahd(iz, .37f, d, n).x, 1.581f, 2e-6f);
    EXPECT_NEAR(glsl::lumel_irradz_hhd(iz, .37f, d, n).x, 1.47616666667f, 2e-6f);
}

TEST(ShaderKnownAnswers, Probes) {
    const glsl::LumelSh sh = known_sh();
    EXPECT_NEAR(glsl::lumel_sh_irradiance(sh, kN7Glsl).x, 1.28818365433f, 2e-6f);
    const glsl::LumelLinearSh p2 = glsl::lumel_sh_tangent_quadratic(sh, kN7Glsl);
    expect_vec({p2.l1.x, p2.l2.x, p2.l3.x}, {0.0914621589682f, 0.0224052100485f, -0.0699776083069f}, 1e-6f);
    const glsl::LumelLinearSh p = glsl::lumel_multiply_hemisphere_linear(sh, kN7Glsl);
    EXPECT_NEAR(p.l0.x, 1.98249986782f, 2e-6f);
    expect_vec({p.l1.x, p.l2.x, p.l3.x}, {-0.770313145605f, 1.6767133129f, -0.735112218541f}, 2e-6f);
    const auto check = [&](float c, float ambient, Vec3 linear, float iz) {
        const glsl::LumelHlsh hlsh = glsl::lumel_hlsh_from_cone(sh, kN7Glsl, c);
        EXPECT_NEAR(hlsh.ambient.x, ambient, 2e-6f);
        expect_vec({hlsh.x.x, hlsh.y.x, hlsh.z.x}, linear, 2e-6f);
        EXPECT_NEAR(hlsh.iz.x, iz, 2e-6f);
    };
    check(0, 0.486215100561f, {0.299901559531f, 0.310657532699f, 0.680334026542f}, 1.28818365433f);
    check(.5f, 0.184233108246f, {0.278415650284f, 0.357147658968f, 0.745577641098f}, 1.05591026883f);
    EXPECT_NEAR(glsl::lumel_cone_cosine(.3f, .8f), 0.790569415042f, 1e-6f);
    EXPECT_EQ(glsl::lumel_cone_cosine(.9f, .8f), 0.0f);
}

TEST(ShaderProbes, ConeMultiplyIsTheGramMatrix) {
    test::Random uniform;
    for (const float c : {0.0f, 0.5f, -1.0f, 0.9f}) {
        const RadianceSh<Vec3, 9> sh = test::random_light(uniform).radiance;
        const auto theirs = multiply(cone_gram(static_cast<double>(c)), sh.c);
        const glsl::LumelSh a = glsl::lumel_multiply_cone(to_sh(sh), c);
        const std::array<glsl::vec3, 9> ours{a.l0, a.l1, a.l2, a.l3, a.l4, a.l5, a.l6, a.l7, a.l8};
        for (std::size_t i = 0; i < 9; ++i) expect_vec(ours[i], theirs[i], 1e-5f * largest(sh.c[0]));
    }
}

// A probe in light from above, of linear bands alone, is that light again; HHD of it is exact for one hemisphere light.
TEST(ShaderProbes, HhdOfAHemisphereLight) {
    const glsl::LumelLinearSh flat =
        glsl::lumel_multiply_hemisphere_linear(to_sh(hemisphere_light(Vec3{1, 2, 3}, kN7)), kN7Glsl);
    // Projected twice: its own l0 and l1 come back, since band 2 of it is zero and G holds bands 0 and 1 of a plane:
    // 1/2 sqrt(pi) + sqrt3/4 sqrt(3 pi)/2 = 7/8 sqrt(pi).
    EXPECT_NEAR(flat.l0.x, 0.875f * 1.77245385f, 2e-6f);
    const glsl::vec3 i = glsl::lumel_linear_sh_hhd(flat, kN7Glsl, kN7Glsl);
    EXPECT_NEAR(i.y / i.x, 2.0f, 1e-5f);
    EXPECT_NEAR(i.x, 1.0f, 2e-6f) << "I(n_v) is kept";
}

TEST(ShaderBounce, IsTheOtherHalf) {
    const glsl::vec3 one(1, 1, 1), side(1, 0, 0);
    EXPECT_EQ(glsl::lumel_self_bounce(one, one, kUp, kUp).x, 0.0f);
    EXPECT_EQ(glsl::lumel_self_bounce(one, one, kUp, side).x, 0.5f);
}

TEST(ShaderSpecular, IsTheLibrarys) {
    for (const float r : {0.0f, 0.3f, 0.8f, 1.0f}) {
        EXPECT_NEAR(glsl::lumel_widened_alpha(0.15f, r), widened_alpha(0.15f, r), 1e-6f);
        EXPECT_NEAR(glsl::lumel_adjusted_smoothness(0.6f, r), adjusted_smoothness(0.6f, r), 1e-6f);
    }
    EXPECT_NEAR(glsl::lumel_widened_alpha(0.15f, 0.8f), 0.461711994756f, 1e-6f);
    EXPECT_EQ(glsl::lumel_highlight_fade(0, 0.1f, 0.3f, 0.7f), 0.0f);
    EXPECT_EQ(glsl::lumel_highlight_fade(1, 0.1f, 0.3f, 0.7f), 1.0f);
    EXPECT_EQ(glsl::lumel_highlight_fade(1, 0.9f, 0.3f, 0.7f), 0.0f);
}

// One lamp of I-units C = 2 along N7: E facing it is 2 pi, r is 1.
TEST(ShaderSpecular, OneLampIsItself) {
    const auto lamp = directional_light(Vec3{2, 2, 2}, kN7);
    const Numbers n = test::solved(kL1Linear, {lamp, fit_irradiance(lamp), Vec3{2, 2, 2} * kN7.z});
    const glsl::LumelSh a = to_sh(n);
    const glsl::LumelHighlight light = glsl::lumel_l1_highlight(a.l0, a.l1, a.l2, a.l3);
    expect_vec(light.direction, kN7, 1e-6f);
    EXPECT_NEAR(light.irradiance.x, 2 * kPi, 1e-5f);
    EXPECT_NEAR(light.spread, 1.0f, 1e-6f);
    // At the mirror direction D = 1/(pi a^2), the visibility of n.l = n.v = c is 1/(4 c sqrt(c^2 (1 - a^2) + a^2)).
    const float alpha = 0.3f, c = kN7.z, a2 = alpha * alpha, f0 = 1.0f;
    const float expected = f0 * 2 * kPi * c / (kPi * a2) / (4 * c * std::sqrt(c * c * (1 - a2) + a2));
    EXPECT_NEAR(glsl::lumel_highlight(light, {1, 1, 1}, alpha, kUp, {-kN7.x, -kN7.y, kN7.z}).x, expected, 1e-4f);
}

// B-splines reproduce straight lines: sampled with hardware's bilinear filter, so do the taps.
TEST(ShaderBicubic, KeepsStraightLines) {
    for (const float u : {0.21f, 0.5f, 0.63f}) {
        const glsl::LumelTaps t = glsl::lumel_bicubic_taps({u, 0.4f}, {64, 32});
        EXPECT_NEAR(t.w00 + t.w10 + t.w01 + t.w11, 1.0f, 1e-6f);
        EXPECT_NEAR(t.x0 * (t.w00 + t.w01) + t.x1 * (t.w10 + t.w11), u, 1e-6f);
        EXPECT_NEAR(t.y0 * (t.w00 + t.w10) + t.y1 * (t.w01 + t.w11), 0.4f, 1e-6f);
    }
}

}  // namespace
}  // namespace lumel
