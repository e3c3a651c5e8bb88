// L1/L0 for the same two shaders as l1.cpp, with numbers that are fitted over the upper hemisphere of normals, exact at
// n_v, instead of projected over the sphere, half of which no normal of the surface sees.
#include <algorithm>
#include <cmath>

#include "encode/encodings.h"
#include "encode/hemisphere_fit.h"
#include "encode/l1.h"

namespace lumel {
namespace {

// Linear: I = R0 (1 + 2 e.n), |e| <= 1
// --------------------------------------------------------------------------------------
// In the basis 1 - z, x, y about I_z z all three have the same norm over the hemisphere and no products, so that the
// nearest storable numbers are the nearest in plain distance. |e| <= 1 reads x^2 + y^2 <= (3 c - I_z)(c + I_z), with c
// the number of 1 - z: a hyperbola in (c, hypot(x, y)).

struct Ambient {
    float c, x, y;
};

std::array<float, 4> basis(Vec3 n) { return {n.z, 1.0f - n.z, n.x, n.y}; }
const BasisFit<4>& linear_fit() {
    static const BasisFit<4> fit(basis);
    return fit;
}

Ambient nearest_storable(float iz, Ambient wanted) {
    const float radius = std::sqrt(wanted.x * wanted.x + wanted.y * wanted.y);
    const auto bound = [iz](float c) { return std::sqrt(std::max(0.0f, (3.0f * c - iz) * (c + iz))); };
    const float least = iz / 3.0f;
    if (wanted.c >= least && radius <= bound(wanted.c)) return wanted;
    // The distance to the hyperbola's branch has one minimum along it: golden-section search.
    constexpr float kGolden = 0.61803399f;
    constexpr int kSteps = 16;
    const auto distance = [&](float c) {
        const float dc = c - wanted.c, dr = bound(c) - radius;
        return dc * dc + dr * dr;
    };
    float low = least, high = std::max(wanted.c, least) + radius;
    float c1 = high - kGolden * (high - low), c2 = low + kGolden * (high - low);
    float d1 = distance(c1), d2 = distance(c2);
    for (int i = 0; i < kSteps; ++i) {
        const bool left = d1 < d2;
        (left ? high : low) = left ? c2 : c1;
        const float c = left ? high - kGolden * (high - low) : low + kGolden * (high - low), d = distance(c);
        const float keep_c = left ? c1 : c2, keep_d = left ? d1 : d2;
        c1 = left ? c : keep_c;
        d1 = left ? d : keep_d;
        c2 = left ? keep_c : c;
        d2 = left ? keep_d : d;
    }
    const float c = 0.5f * (low + high), scale = radius > 0.0f ? bound(c) / radius : 0.0f;
    return {c, wanted.x * scale, wanted.y * scale};
}

Numbers solve_linear(const TexelLight& light) {
    const std::array<Vec3, 4> v = linear_fit().nearest_exact(light);
    L1Texel out;
    for (std::size_t c = 0; c < 3; ++c) {
        const float iz = light.irradiance[c];
        const Ambient a = nearest_storable(iz, {v[1][c], v[2][c], v[3][c]});
        if (!(a.c > 0.0f)) continue;
        out.l0[c] = a.c;
        out.l1n[c] = Vec3{a.x, a.y, iz - a.c} / (2.0f * a.c);
    }
    return to_numbers(out);
}

// Hazel: I = R0 h(e; n), |e| <= 1
// ---------------------------------------------------------------------------------------
// h is a power of the cosine between cube and identity: its first three bands, which are closed forms of r = |e|, hold
// it well enough to search by. R0 follows from I_z.

std::array<float, 9> hazel_bands(Vec3 e) {
    const float r = std::min(length(e), 1.0f), p = 1.0f + 2.0f * r;
    const float first = 2.0f * p / ((1.0f + r) * (p + 2.0f));
    const float second = 4.0f * p / ((1.0f + r) * (p + 2.0f) * (p + 3.0f));
    constexpr float k4Pi = 4.0f * kPi;
    return {k4Pi * kSh0,
            -k4Pi * kSh1 * first * e.y,
            k4Pi * kSh1 * first * e.z,
            -k4Pi * kSh1 * first * e.x,
            k4Pi * kSh2 * second * e.x * e.y,
            -k4Pi * kSh2 * second * e.y * e.z,
            k4Pi * kSh20 * second * (3.0f * e.z * e.z - r * r),
            -k4Pi * kSh2 * second * e.x * e.z,
            k4Pi * kSh22 * second * (e.x * e.x - e.y * e.y)};
}

using Band = std::array<float, 9>;

// I/I_z of the model at e, minus the target.
Band residual(Vec3 e, const Band& target) {
    Band out = hazel_bands(e);
    const float scale = 1.0f / evaluate_hazel(1.0f, e, {0, 0, 1});
    for (std::size_t i = 0; i < 9; ++i) out[i] = out[i] * scale - target[i];
    return out;
}

float squared(const Band& r) { return dot_coefficients(r, multiply(kHemisphereGram, r)); }

// Upper half of the ball: there h is at least a third of its mean at n_v.
Vec3 storable(Vec3 e) {
    e.z = std::max(e.z, 0.0f);
    const float r = length(e);
    return r > 1.0f ? e / r : e;
}

// (J'GJ + damping diag) x = -J'Gr for three unknowns, by Cramer's rule.
Vec3 damped_step(const std::array<Band, 3>& jacobian, const Band& r, float damping) {
    std::array<Vec3, 3> a;
    Vec3 right;
    const Band gr = multiply(kHemisphereGram, r);
    for (std::size_t i = 0; i < 3; ++i) {
        const Band g = multiply(kHemisphereGram, jacobian[i]);
        for (std::size_t k = 0; k < 3; ++k) a[i][k] = dot_coefficients(g, jacobian[k]);
        a[i][i] = a[i][i] * (1.0f + damping) + 1e-12f;
        right[i] = -dot_coefficients(jacobian[i], gr);
    }
    const float whole = dot(a[0], cross(a[1], a[2]));
    if (!(std::fabs(whole) > 0.0f)) return {};
    // The matrix is symmetric: its rows are its columns.
    return Vec3{dot(right, cross(a[1], a[2])), dot(a[0], cross(right, a[2])), dot(a[0], cross(a[1], right))} / whole;
}

// Levenberg-Marquardt from the projected vector.
Vec3 fit_hazel(Vec3 e, const Band& target) {
    constexpr int kSteps = 12;
    constexpr float kDifference = 1e-3f, kConverged = 1e-4f;
    Band r = residual(e, target);
    float error = squared(r), damping = 1e-2f;
    for (int step = 0; step < kSteps; ++step) {
        std::array<Band, 3> jacobian;
        for (std::size_t i = 0; i < 3; ++i) {
            Vec3 moved = e;
            const float difference = e[i] > 0.0f ? -kDifference : kDifference;  // inwards
            moved[i] += difference;
            jacobian[i] = residual(moved, target);
            for (std::size_t k = 0; k < 9; ++k) jacobian[i][k] = (jacobian[i][k] - r[k]) / difference;
        }
        const Vec3 next = storable(e + damped_step(jacobian, r, damping));
        const Band at_next = residual(next, target);
        const float next_error = squared(at_next);
        if (!(next_error < error)) {
            damping *= 8.0f;
            continue;
        }
        const bool done = error - next_error < kConverged * error;
        e = next;
        r = at_next;
        error = next_error;
        damping *= 0.2f;
        if (done) break;
    }
    return e;
}

Numbers solve_hazel(const TexelLight& light) {
    const L1Texel start = encode_l1(linear_part(light.radiance));
    L1Texel out;
    for (std::size_t c = 0; c < 3; ++c) {
        const float iz = light.irradiance[c];
        if (!(iz > 0.0f)) continue;
        Band target;
        for (std::size_t i = 0; i < 9; ++i) target[i] = light.fit.c[i][c] / iz;
        out.l1n[c] = fit_hazel(storable(start.l1n[c]), target);
        out.l0[c] = iz / evaluate_hazel(1.0f, out.l1n[c], {0, 0, 1});
    }
    return to_numbers(out);
}

// The mean of two powers of a cosine is none: the vector is mixed by light, and L0 follows from I_z, which adds up.
Numbers blend_hazel(const Numbers& a, float weight_a, const Numbers& b, float weight_b) {
    constexpr Vec3 kUp{0, 0, 1};
    const L1Texel x = l1_texel(a), y = l1_texel(b);
    L1Texel out = l1_texel(blend_l1(a, weight_a, b, weight_b));
    for (std::size_t c = 0; c < 3; ++c) {
        const float iz =
            weight_a * evaluate_hazel(x.l0[c], x.l1n[c], kUp) + weight_b * evaluate_hazel(y.l0[c], y.l1n[c], kUp);
        const float of_one = evaluate_hazel(1.0f, out.l1n[c], kUp);
        if (of_one > 0.0f) out.l0[c] = iz / of_one;
    }
    return to_numbers(out);
}

Vec3 decode_linear(const Numbers& numbers, Vec3 n) { return evaluate_l1_linear(l1_texel(numbers), n); }
Vec3 decode_hazel(const Numbers& numbers, Vec3 n) { return evaluate_l1_hazel(l1_texel(numbers), n); }

}  // namespace

const Encoding kL1LinearFit{"l1-linear-fit",
                            "L1/L0 fitted over the hemisphere for linear evaluation",
                            kL1Fields,
                            rotate_l1,
                            true,
                            15,
                            detail::solve_each<solve_linear>,
                            decode_linear,
                            blend_l1};
const Encoding kL1HazelFit{"l1-hazel-fit",
                           "L1/L0 fitted over the hemisphere for Hazel's evaluation",
                           kL1Fields,
                           rotate_l1,
                           true,
                           99,
                           detail::solve_each<solve_hazel>,
                           decode_hazel,
                           blend_hazel};

}  // namespace lumel
