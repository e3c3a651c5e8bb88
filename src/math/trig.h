// Sine and cosine of a turn from polynomials: the same bits on every machine and libm.
#pragma once

#include <cmath>

namespace lumel {

struct SinCos {
    float sine, cosine;
};

// sin and cos of 2 pi u, for |u| <= 2^22. Error below 1e-7 absolute.
inline SinCos sincos_turn(float u) {
    // Reduce to r in [-1/8, 1/8] turns about the nearest quarter.
    const float quarter = std::floor(u * 4.0f + 0.5f);
    const double r = (static_cast<double>(u) - 0.25 * static_cast<double>(quarter)) * 6.283185307179586476925;
    const double r2 = r * r;
    const double s = r * (1.0 + r2 * (-1.0 / 6 + r2 * (1.0 / 120 + r2 * (-1.0 / 5040 + r2 * (1.0 / 362880)))));
    const double c = 1.0 + r2 * (-0.5 + r2 * (1.0 / 24 + r2 * (-1.0 / 720 + r2 * (1.0 / 40320 - r2 / 3628800))));
    switch (static_cast<int>(quarter) & 3) {
        case 0: return {static_cast<float>(s), static_cast<float>(c)};
        case 1: return {static_cast<float>(c), static_cast<float>(-s)};
        case 2: return {static_cast<float>(-s), static_cast<float>(-c)};
        default: return {static_cast<float>(-c), static_cast<float>(s)};
    }
}

}  // namespace lumel
