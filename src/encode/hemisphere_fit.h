// Integrals over the normals of a hemisphere: a quadrature rule, least squares of irradiance in any basis, and what the
// master's nine coefficients say of the irradiance about a given normal. Made once, in double precision.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/check.h"
#include "encode/texel_light.h"

namespace lumel {

// Nodes over the upper hemisphere with weights that add up to 2 pi: Gauss-Legendre in z, even steps about it. Exact for
// polynomials of degree below both 2 rings and `steps`.
struct HemisphereGrid {
    std::vector<Vec3> normal;
    std::vector<double> weight;
};
HemisphereGrid hemisphere_grid(std::size_t rings, std::size_t steps);

// Solves the symmetric positive definite n x n system a x = b for `columns` right sides, all row by row, in place of b.
// A pivot below 1e-12 of the largest diagonal entry is our bug: the basis is linearly dependent.
void solve_positive_definite(std::vector<double> a, std::size_t n, std::vector<double>& b, std::size_t columns);

// Per normal the nine weights of radiance coefficients that give I there: the least squares, over directions above the
// horizon, of the cosine lobe. Exact about n_v, where the lobe is linear.
std::vector<std::array<float, 9>> irradiance_weights(const std::vector<Vec3>& normals);

// Numbers v_j of I(n) = sum of v_j basis_j(n).
template <std::size_t J>
class BasisFit {
public:
    using Basis = std::array<float, J> (*)(Vec3 n);

    explicit BasisFit(Basis basis) : at_normal_(basis({0, 0, 1})) {
        const HemisphereGrid grid = hemisphere_grid(24, 48);
        std::vector<double> gram(J * J), right(J * (9 + 1));
        for (std::size_t k = 0; k < grid.normal.size(); ++k) {
            const std::array<float, J> b = basis(grid.normal[k]);
            const ShBasis y = sh_basis(grid.normal[k]);
            for (std::size_t i = 0; i < J; ++i) {
                const double w = grid.weight[k] * static_cast<double>(b[i]);
                for (std::size_t j = 0; j < J; ++j) gram[i * J + j] += w * static_cast<double>(b[j]);
                for (std::size_t j = 0; j < 9; ++j) right[i * 10 + j] += w * static_cast<double>(y[j]);
            }
        }
        for (std::size_t i = 0; i < J; ++i) right[i * 10 + 9] = static_cast<double>(at_normal_[i]);
        solve_positive_definite(std::move(gram), J, right, 10);
        double gain = 0.0;
        for (std::size_t i = 0; i < J; ++i) gain += right[i * 10 + 9] * static_cast<double>(at_normal_[i]);
        for (std::size_t i = 0; i < J; ++i) {
            for (std::size_t j = 0; j < 9; ++j) weights_[i][j] = static_cast<float>(right[i * 10 + j]);
            to_normal_[i] = static_cast<float>(right[i * 10 + 9] / gain);
        }
    }

    // Least squares over the upper hemisphere.
    [[nodiscard]] std::array<Vec3, J> nearest(const IrradianceSh<Vec3, 9>& fit) const {
        std::array<Vec3, J> out;
        for (std::size_t i = 0; i < J; ++i) out[i] = dot_coefficients(weights_[i], fit.c);
        return out;
    }
    // The same among those that are exact at n_v.
    [[nodiscard]] std::array<Vec3, J> nearest_exact(const TexelLight& light) const {
        std::array<Vec3, J> out = nearest(light.fit);
        Vec3 missing = light.irradiance;
        for (std::size_t i = 0; i < J; ++i) missing -= out[i] * at_normal_[i];
        for (std::size_t i = 0; i < J; ++i) out[i] += missing * to_normal_[i];
        return out;
    }

private:
    std::array<std::array<float, 9>, J> weights_{};
    std::array<float, J> at_normal_, to_normal_{};
};

}  // namespace lumel
