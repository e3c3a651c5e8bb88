// Numbers for JSON files.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "io/json_read.h"
#include "lumel/vec.h"

namespace lumel {

// The double whose shortest text is that of the float: 0.1f is written as 0.1, and still reads back as the same float.
inline double json_number(float value) {
    std::array<char, 32> text{};
    std::to_chars(text.data(), text.data() + text.size() - 1, value);
    return std::strtod(text.data(), nullptr);
}

inline Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

inline Json json_array(Vec3 v) { return Json::array({json_number(v.x), json_number(v.y), json_number(v.z)}); }
inline Json json_array(Vec2 v) { return Json::array({json_number(v.x), json_number(v.y)}); }

}  // namespace lumel
