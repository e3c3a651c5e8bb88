// A cone that bounds unit normals, kept by cosines and sines so that no trigonometric function is called.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

namespace lumel {

struct NormalCone {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    double cosine = 1.0, sine = 0.0;  // of the half angle
};

// The smallest cone around both, or nothing where its half angle would pass 90 degrees.
inline std::optional<NormalCone> cone_union(const NormalCone& a, const NormalCone& b) {
    const double cos_phi = std::clamp(a.axis.dot(b.axis), -1.0, 1.0);
    const Eigen::Vector3d across = b.axis - cos_phi * a.axis;
    const double sin_phi = across.norm();
    // One inside the other: phi + theta_inner <= theta_outer.
    const auto contains = [&](const NormalCone& outer, const NormalCone& inner) {
        const double sine = sin_phi * inner.cosine + cos_phi * inner.sine;
        const double cosine = cos_phi * inner.cosine - sin_phi * inner.sine;
        return sine >= 0.0 && cosine >= outer.cosine;
    };
    if (contains(a, b)) return a;
    if (contains(b, a)) return b;
    // theta = (theta_a + phi + theta_b) / 2 by the addition and half-angle formulas.
    const double sin_ap = a.sine * cos_phi + a.cosine * sin_phi, cos_ap = a.cosine * cos_phi - a.sine * sin_phi;
    const double sin_sum = sin_ap * b.cosine + cos_ap * b.sine, cos_sum = cos_ap * b.cosine - sin_ap * b.sine;
    if (sin_ap <= 0.0 || sin_sum <= 0.0 || sin_phi < 1e-12) return std::nullopt;
    NormalCone out;
    out.cosine = std::sqrt(std::max(0.0, 0.5 * (1.0 + cos_sum)));
    out.sine = std::sqrt(std::max(0.0, 0.5 * (1.0 - cos_sum)));
    // Turn a's axis towards b's by theta - theta_a.
    const double turn_cos = out.cosine * a.cosine + out.sine * a.sine;
    const double turn_sin = out.sine * a.cosine - out.cosine * a.sine;
    out.axis = (turn_cos * a.axis + (turn_sin / sin_phi) * across).normalized();
    return out;
}

}  // namespace lumel
