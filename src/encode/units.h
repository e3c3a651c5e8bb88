// The one place where a factor of pi is applied. Everything inside Lumel is I = E/pi, the radiance that a white
// Lambertian surface sends out; some renderers want irradiance E. The manifest says of every file which it holds.
#pragma once

#include "lumel/vec.h"
#include "math/constants.h"

namespace lumel {

enum class LightUnit { e_over_pi, e };

// As written in manifest.json.
constexpr const char* unit_name(LightUnit unit) { return unit == LightUnit::e ? "E" : "E/pi"; }

// Light (I = E/pi, radiance, or coefficients of either) in the unit that a file holds. Every writer goes through here,
// those of E/pi too.
template <class T>
constexpr T to_file_unit(T irradiance_over_pi, LightUnit unit) {
    return unit == LightUnit::e ? irradiance_over_pi * kPi : irradiance_over_pi;
}

// And back, for readers.
template <class T>
constexpr T from_file_unit(T value, LightUnit unit) {
    return unit == LightUnit::e ? value * kInvPi : value;
}

}  // namespace lumel
