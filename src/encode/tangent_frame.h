// The tangent frame of encodings that are relative to the surface: a function of the vertex normal alone, the same in
// the encoder and in shaders (never glTF's TANGENT).
//
// The smallest rotation that takes a fixed frame to the normal: smooth but at one direction, which no axis-aligned
// wall, floor or ceiling is near. Frames that switch sides (as Duff's does where z changes its sign) would flip from
// texel to texel on walls along an axis, and filtering would mix what belongs to different frames.
#pragma once

#include "lumel/vec.h"
#include "sh/rotate.h"

namespace lumel {

// Rows T, B, N: tangent = R world. The pole is (2, 3, 6)/7.
inline Rotation tangent_frame(Vec3 normal) {
    constexpr Vec3 kPole{2.0f / 7, 3.0f / 7, 6.0f / 7}, kTangent{6.0f / 7, 2.0f / 7, -3.0f / 7};
    constexpr float kNearest = 1e-4f;  // 0.8 degrees from the pole's back
    const float along = 1.0f + dot(kPole, normal);
    Vec3 tangent = kTangent;
    if (along > kNearest) tangent -= (kPole + normal) * (dot(kTangent, normal) / along);
    tangent = normalize(tangent - normal * dot(tangent, normal));  // roundings near the pole's back
    return {tangent, cross(normal, tangent), normal};
}

constexpr Vec3 to_tangent(const Rotation& frame, Vec3 v) {
    return {dot(frame[0], v), dot(frame[1], v), dot(frame[2], v)};
}
constexpr Vec3 to_world(const Rotation& frame, Vec3 v) { return frame[0] * v.x + frame[1] * v.y + frame[2] * v.z; }
// Back to where it came from.
constexpr Rotation transposed(const Rotation& r) {
    return {Vec3{r[0].x, r[1].x, r[2].x}, Vec3{r[0].y, r[1].y, r[2].y}, Vec3{r[0].z, r[1].z, r[2].z}};
}

}  // namespace lumel
