// The types of shading languages, as far as shaders/ uses them: enough to compile its text as C++.
#pragma once

#include <cstdint>

namespace lumel::test {

struct ShaderVec2 {
    float x, y;
    ShaderVec2(float a, float b) : x(a), y(b) {}
};
inline ShaderVec2 operator*(ShaderVec2 a, ShaderVec2 b) { return {a.x * b.x, a.y * b.y}; }
inline ShaderVec2 operator+(ShaderVec2 a, ShaderVec2 b) { return {a.x + b.x, a.y + b.y}; }

// With the swizzles that are used.
struct ShaderVec4 {
    ShaderVec2 xy, zw;
};

struct ShaderUvec2 {
    std::uint32_t x, y;
    ShaderUvec2(std::uint32_t a, std::uint32_t b) : x(a), y(b) {}
};

}  // namespace lumel::test
