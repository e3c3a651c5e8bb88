// Inputs of cases.glsl: light of random lamps as an encoding solves it, normals of the upper hemisphere.
#pragma once

#include <array>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

#include "encode/encodings.h"
#include "sh/zonal.h"

namespace lumel::test {

// Encodings by their number in test_decode.
inline constexpr std::array<std::pair<std::string_view, unsigned>, 22> kDecodes{{{"irradiance", 0},
                                                                                 {"irradz-ahd", 1},
                                                                                 {"irradz-hhd", 2},
                                                                                 {"irradz-hhd-closed", 2},
                                                                                 {"irradz-ahd-rgb", 3},
                                                                                 {"irradz-hhd-rgb", 4},
                                                                                 {"l1-mono", 5},
                                                                                 {"l1-linear", 6},
                                                                                 {"l1-linear-fit", 6},
                                                                                 {"l1-hazel", 7},
                                                                                 {"l1-hazel-fit", 7},
                                                                                 {"l1-hhd", 8},
                                                                                 {"zh3-hallucinated", 9},
                                                                                 {"zh3", 10},
                                                                                 {"hlsh", 11},
                                                                                 {"h4", 12},
                                                                                 {"h6", 13},
                                                                                 {"l2", 14},
                                                                                 {"ahd", 15},
                                                                                 {"rnm", 16},
                                                                                 {"ambient-cube", 17},
                                                                                 {"sg5", 18}}};
inline constexpr unsigned kOthers = 22;  // of test_other

class Random {
public:
    float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    // Of the upper hemisphere.
    Vec3 up() {
        const float z = (*this)(), turn = 6.2831853f * (*this)(), r = std::sqrt(1.0f - z * z);
        return {r * std::cos(turn), r * std::sin(turn), z};
    }

private:
    std::mt19937 engine_{7};
};

// A hemisphere light and up to three lamps from above, coloured, of brightness 1e-3 to 1e3.
inline TexelLight random_light(Random& uniform) {
    const float brightness = std::pow(10.0f, 6.0f * uniform() - 3.0f);
    const Vec3 ambient = Vec3{uniform(), uniform(), uniform()} * (0.3f * brightness);
    RadianceSh<Vec3, 9> sh = hemisphere_light(ambient, Vec3{0, 0, 1});
    Vec3 irradiance = ambient;
    const int lamps = static_cast<int>(4.0f * uniform());
    for (int k = 0; k < lamps; ++k) {
        const Vec3 d = uniform.up(), color = Vec3{uniform(), uniform(), uniform()} * brightness;
        const auto lamp = directional_light(color, d);
        for (std::size_t i = 0; i < 9; ++i) sh.c[i] += lamp.c[i];
        irradiance += color * d.z;
    }
    return {sh, fit_irradiance(sh), irradiance};
}

inline Numbers solved(const Encoding& encoding, const TexelLight& light) {
    Numbers out{};
    encoding.solve(std::span(&light, 1), std::span(&out, 1));
    return out;
}

}  // namespace lumel::test
