// Trigonometry from polynomials and IEEE square roots: the same bits on every machine and libm.
// Based on: Moshier, Cephes (atan.c, public domain) for the arc tangent.
#pragma once

#include <array>
#include <cmath>

namespace lumel {

struct SinCos {
    float sine, cosine;
};

// sin and cos of 2 pi u, for |u| <= 2^22. Error below 1e-7 absolute; of the sine near zero, 1.2e-7 relative.
// In single precision: every direction that a path takes needs it.
inline SinCos sincos_turn(float u) {
    // Reduce to r in [-1/8, 1/8] turns about the nearest quarter; the difference is exact.
    const float x = u * 4.0f + 0.5f;
    const int whole = static_cast<int>(x);
    const int quarter = whole - (static_cast<float>(whole) > x ? 1 : 0);
    const float r = u - 0.25f * static_cast<float>(quarter);
    // Taylor series in turns; the first coefficient in two parts, for its rounding would count.
    const float r2 = r * r;
    const float s =
        r * 6.28318548f +
        r * (-1.74845553e-7f + r2 * (-41.3417022f + r2 * (81.6052493f + r2 * (-76.7058597f + r2 * 42.0586940f))));
    const float c =
        1.0f + r2 * (-19.7392088f + r2 * (64.9393940f + r2 * (-85.4568172f + r2 * (60.2446414f - r2 * 26.4262568f))));
    // By tables: which quarter it is cannot be foretold, and a wrong guess costs more than all of the above.
    constexpr std::array<float, 2> kSign{1.0f, -1.0f};
    const std::array<float, 2> value{s, c};
    const auto q = static_cast<unsigned>(quarter);
    return {value[q & 1] * kSign[(q >> 1) & 1], value[(q & 1) ^ 1] * kSign[((q + 1) >> 1) & 1]};
}

// Double precision, for geometry in which digits cancel
// ------------------------------------------------------------------

struct SinCosDouble {
    double sine, cosine;
};

// sin and cos of an angle in radians, |angle| <= 2^20. Error below 1e-15 near zero, growing with |angle| as 1e-16
// |angle|.
inline SinCosDouble sincos_radians(double angle) {
    const double quarter = std::floor(angle * 0.636619772367581343076 + 0.5);
    // pi/2 in two parts, the first short enough that its product with `quarter` is exact.
    const double r = (angle - quarter * 1.57079632673412561417) - quarter * 6.07710050650619224932e-11;
    const double x = r * r;
    const double s =
        r * (1 + x * (-1.0 / 6 +
                      x * (1.0 / 120 +
                           x * (-1.0 / 5040 +
                                x * (1.0 / 362880 +
                                     x * (-1.0 / 39916800 + x * (1.0 / 6227020800 + x * (-1.0 / 1307674368000))))))));
    const double c =
        1 + x * (-0.5 + x * (1.0 / 24 +
                             x * (-1.0 / 720 +
                                  x * (1.0 / 40320 + x * (-1.0 / 3628800 +
                                                          x * (1.0 / 479001600 + x * (-1.0 / 87178291200 +
                                                                                      x * (1.0 / 20922789888000))))))));
    switch (static_cast<int>(quarter) & 3) {
        case 0: return {s, c};
        case 1: return {c, -s};
        case 2: return {-s, -c};
        default: return {-c, s};
    }
}

// arc tangent, relative error below 1e-15.
inline double arctangent(double x) {
    constexpr double kHalfPi = 1.57079632679489661923, kQuarterPi = 0.785398163397448309616;
    constexpr double kHalfPiRest = 6.123233995736765886130e-17;  // what kHalfPi lacks
    // Reduce |x| to [0, 0.66] by atan(x) = pi/4 + atan((x-1)/(x+1)) = pi/2 - atan(1/x).
    double t = std::fabs(x), base = 0.0, rest = 0.0;
    if (t > 2.41421356237309504880) {
        t = -1.0 / t;
        base = kHalfPi;
        rest = kHalfPiRest;
    } else if (t > 0.66) {
        t = (t - 1.0) / (t + 1.0);
        base = kQuarterPi;
        rest = 0.5 * kHalfPiRest;
    }
    const double z = t * t;
    const double p =
        (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z -
         1.228866684490136173410e2) *
            z -
        6.485021904942025371773e1;
    const double q =
        ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) * z +
         4.853903996359136964868e2) *
            z +
        1.945506571482613964425e2;
    return std::copysign(base + ((t * (z * p / q) + t) + rest), x);
}

// Angle of the vector (x, y) in [-pi, pi]; 0 for the zero vector.
inline double arctangent2(double y, double x) {
    constexpr double kPiDouble = 3.14159265358979323846;
    if (x == 0.0) return y == 0.0 ? 0.0 : std::copysign(0.5 * kPiDouble, y);
    const double angle = arctangent(y / x);
    if (x > 0.0) return angle;
    return angle + std::copysign(kPiDouble, y);
}

// Arguments are clamped to [-1, 1].
inline double arcsine(double x) {
    const double rest = (1.0 - x) * (1.0 + x);
    return arctangent2(x, rest > 0.0 ? std::sqrt(rest) : 0.0);
}
inline double arccosine(double x) {
    const double rest = (1.0 - x) * (1.0 + x);
    return arctangent2(rest > 0.0 ? std::sqrt(rest) : 0.0, x);
}

}  // namespace lumel
