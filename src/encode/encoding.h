// One interface of all encodings: what a texel of a lightmap stores of the light that arrives there, and what a shader
// makes of it. Each encoding is one row of functions; list_encodings() has them all.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "encode/texel_light.h"

namespace lumel {

inline constexpr std::size_t kMaxNumbers = 27;
using Numbers = std::array<float, kMaxNumbers>;  // of one texel, in the order of the encoding's fields

// What a number is, which decides how a texture stores it.
enum class FieldKind : std::uint8_t {
    light,         // not negative, no upper bound: half, or BC6H
    signed_light,  // of either sign: half, or signed BC6H
    ratio,         // [-1, 1]: 8 bits of 0.5 + 0.5 x
    unit,          // [0, 1]: 8 bits
};
struct Field {
    const char* name;  // of the channel in files: "I.R"
    FieldKind kind;
};

// How numbers are stored: in floats as solved, in halves, or as a GPU's textures do (half, and 8 bits for ratios).
enum class Storage : std::uint8_t { exact, half, texture };

struct Encoding {
    const char* name;
    const char* about;  // one line
    std::span<const Field> fields;
    // Numbers are solved and decoded in the tangent frame of the texel. Files of an encoding that has `rotate` are in
    // the world frame; rotate takes them there and back.
    void (*rotate)(Numbers& numbers, const Rotation& rotation);
    bool keeps_irradiance;  // I at n_v is that of the light, but for what the encoding cannot hold
    // Arithmetic of one lookup, RGB, normal given: add, multiply, multiply-add, minimum, maximum, select 1; division,
    // square root, exponential, logarithm 4.
    int decode_operations;

    void (*solve)(std::span<const TexelLight> light, std::span<Numbers> out);
    // I = E/pi for a unit normal of the tangent frame. Linear models may be negative where the light is not.
    Vec3 (*decode)(const Numbers& numbers, Vec3 normal);
    // weight_a a + weight_b b of two light sets: in linear SH, then solved again where the numbers are not linear.
    Numbers (*blend)(const Numbers& a, float weight_a, const Numbers& b, float weight_b);
};

// Ordered by numbers per texel within the models that are meant for use, then those that are there to compare with.
std::span<const Encoding* const> list_encodings();
// nullptr where there is none of that name.
const Encoding* find_encoding(std::string_view name);

// Rounds what is stored. Errors: half 2^-11 of the number (2^-25 near zero), 8 bits half a step of 1/255 (of 2/255 for
// ratios).
void quantise(const Encoding& encoding, Storage storage, Numbers& numbers);

// Bytes of a texel, uncompressed, in a storage; textures have one of 8 bits for each four ratios and units, and three
// channels of half (six bytes) for each three lights.
std::size_t bytes_per_texel(const Encoding& encoding, Storage storage);

namespace detail {

// A function of one texel as one of many.
template <Numbers (*kSolve)(const TexelLight&)>
void solve_each(std::span<const TexelLight> light, std::span<Numbers> out) {
    for (std::size_t i = 0; i < light.size(); ++i) out[i] = kSolve(light[i]);
}

// Where the numbers are linear in the light.
Numbers blend_numbers(const Numbers& a, float weight_a, const Numbers& b, float weight_b);

inline Vec3 vec3_at(const Numbers& n, std::size_t i) { return {n[i], n[i + 1], n[i + 2]}; }
inline void store_vec3(Numbers& n, std::size_t i, Vec3 v) {
    n[i] = v.x;
    n[i + 1] = v.y;
    n[i + 2] = v.z;
}

}  // namespace detail
}  // namespace lumel
