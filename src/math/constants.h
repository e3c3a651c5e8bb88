// Numbers that more than one module needs.
#pragma once

namespace lumel {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kTwoPi = 6.28318530717958647693f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInvTwoPi = 0.15915494309189533577f;
inline constexpr float kFloatEpsilon = 5.96046448e-8f;  // half an ulp of 1: the unit roundoff of float
// Accumulated rounding of n operations (Higham; pbrt 6.8).
constexpr float gamma_bound(int n) {
    return (static_cast<float>(n) * kFloatEpsilon) / (1.0f - static_cast<float>(n) * kFloatEpsilon);
}

}  // namespace lumel
