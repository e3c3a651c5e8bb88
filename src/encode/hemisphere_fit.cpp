#include "encode/hemisphere_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/trig.h"

namespace lumel {
namespace {

constexpr double kPiDouble = std::numbers::pi;

struct Rule {
    std::vector<double> x, w;
};

// Gauss-Legendre on [-1, 1] by Newton's method from Chebyshev's points.
Rule gauss_legendre(std::size_t n) {
    Rule out{std::vector<double>(n), std::vector<double>(n)};
    const auto count = static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) {
        double x = sincos_radians(kPiDouble * (static_cast<double>(i) + 0.75) / (count + 0.5)).cosine, slope = 1.0;
        for (int step = 0; step < 20; ++step) {
            double p0 = 1.0, p1 = x;
            for (std::size_t k = 2; k <= n; ++k) {
                const auto l = static_cast<double>(k);
                const double p2 = ((2 * l - 1) * x * p1 - (l - 1) * p0) / l;
                p0 = p1;
                p1 = p2;
            }
            slope = count * (x * p1 - p0) / (x * x - 1);
            x -= p1 / slope;
        }
        out.x[i] = x;
        out.w[i] = 2.0 / ((1 - x * x) * slope * slope);
    }
    return out;
}

// Integral over the lune of directions above the horizon and above the plane across n of Y(w) max(n.w, 0)/pi. By
// symmetry for n in the plane y = 0: two wedges' edges meet along y, so that the rule is smooth.
std::array<double, 9> lobe_moments(Vec3 n, const Rule& rule) {
    const double z = static_cast<double>(n.z), x = static_cast<double>(n.x), y = static_cast<double>(n.y);
    const double s = std::sqrt(x * x + y * y), angle = arctangent2(s, z);  // between n and n_v
    const double ex = s > 0.0 ? x / s : 1.0, ey = s > 0.0 ? y / s : 0.0;
    // Directions w = sin(t) (sin(a) e + cos(a) n_v) + cos(t) (n_v x e), a from angle - pi/2 to pi/2.
    const double low = angle - 0.5 * kPiDouble, high = 0.5 * kPiDouble;
    std::array<double, 9> out{};
    for (std::size_t i = 0; i < rule.x.size(); ++i) {
        const double a = 0.5 * (low + high) + 0.5 * (high - low) * rule.x[i];
        const SinCosDouble azimuth = sincos_radians(a);
        for (std::size_t k = 0; k < rule.x.size(); ++k) {
            const SinCosDouble t = sincos_radians(0.5 * kPiDouble * (rule.x[k] + 1));
            const double across = t.sine * azimuth.sine, up = t.sine * azimuth.cosine, side = t.cosine;
            const double cosine = across * s + up * z;
            const double weight = 0.25 * (high - low) * kPiDouble * rule.w[i] * rule.w[k] * t.sine * cosine / kPiDouble;
            const Vec3 w{static_cast<float>(across * ex - side * ey), static_cast<float>(across * ey + side * ex),
                         static_cast<float>(up)};
            const ShBasis basis = sh_basis(w);
            for (std::size_t j = 0; j < 9; ++j) out[j] += weight * static_cast<double>(basis[j]);
        }
    }
    return out;
}

std::vector<double> dense(const ZonalMatrix& m) {
    std::vector<double> out(81);
    for (std::size_t j = 0; j < 9; ++j) {
        std::array<float, 9> unit{};
        unit[j] = 1.0f;
        const std::array<float, 9> column = multiply(m, unit);
        for (std::size_t i = 0; i < 9; ++i) out[i * 9 + j] = static_cast<double>(column[i]);
    }
    return out;
}

}  // namespace

HemisphereGrid hemisphere_grid(std::size_t rings, std::size_t steps) {
    HemisphereGrid out;
    const Rule rule = gauss_legendre(rings);
    for (std::size_t i = 0; i < rings; ++i)
        for (std::size_t k = 0; k < steps; ++k) {
            const double z = 0.5 * (rule.x[i] + 1), r = std::sqrt(1 - z * z);
            const SinCosDouble a =
                sincos_radians(2 * kPiDouble * (static_cast<double>(k) + 0.5) / static_cast<double>(steps));
            out.normal.push_back(
                {static_cast<float>(r * a.cosine), static_cast<float>(r * a.sine), static_cast<float>(z)});
            out.weight.push_back(rule.w[i] * kPiDouble / static_cast<double>(steps));
        }
    return out;
}

void solve_positive_definite(std::vector<double> a, std::size_t n, std::vector<double>& b, std::size_t columns) {
    double largest = 0.0;
    for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, a[i * n + i]);
    for (std::size_t i = 0; i < n; ++i) {
        const double pivot = a[i * n + i];
        LUMEL_CHECK(pivot > 1e-12 * largest, i, pivot, largest);
        for (std::size_t r = 0; r < n; ++r) {
            if (r == i) continue;
            const double factor = a[r * n + i] / pivot;
            for (std::size_t c = i; c < n; ++c) a[r * n + c] -= factor * a[i * n + c];
            for (std::size_t c = 0; c < columns; ++c) b[r * columns + c] -= factor * b[i * columns + c];
        }
    }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = 0; c < columns; ++c) b[i * columns + c] /= a[i * n + i];
}

std::vector<std::array<float, 9>> irradiance_weights(const std::vector<Vec3>& normals) {
    const Rule rule = gauss_legendre(24);
    const std::size_t n = normals.size();
    std::vector<double> right(9 * n);
    for (std::size_t k = 0; k < n; ++k) {
        const std::array<double, 9> moments = lobe_moments(normals[k], rule);
        for (std::size_t j = 0; j < 9; ++j) right[j * n + k] = moments[j];
    }
    solve_positive_definite(dense(kHemisphereGram), 9, right, n);
    std::vector<std::array<float, 9>> out(n);
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t j = 0; j < 9; ++j) out[k][j] = static_cast<float>(right[j * n + k]);
    return out;
}

}  // namespace lumel
