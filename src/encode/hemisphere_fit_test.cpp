#include "encode/hemisphere_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lumel {
namespace {

constexpr Vec3 kN7{2.0f / 7, 3.0f / 7, 6.0f / 7};

double integral(std::size_t rings, std::size_t steps, double (*f)(Vec3)) {
    const HemisphereGrid grid = hemisphere_grid(rings, steps);
    double sum = 0;
    for (std::size_t k = 0; k < grid.normal.size(); ++k) sum += grid.weight[k] * f(grid.normal[k]);
    return sum;
}

// Normals are floats: 6e-8 each, of a sum of 2 pi.
TEST(HemisphereGrid, IntegratesPolynomials) {
    EXPECT_NEAR(integral(4, 8, [](Vec3) { return 1.0; }), 2 * M_PI, 1e-12);
    EXPECT_NEAR(integral(4, 8, [](Vec3 n) { return double(n.z); }), M_PI, 1e-6);
    EXPECT_NEAR(integral(4, 8, [](Vec3 n) { return double(n.x) * n.x * n.z * n.z; }), 2 * M_PI / 15, 1e-6);
    EXPECT_NEAR(integral(4, 8, [](Vec3 n) { return double(n.x); }), 0.0, 1e-6);
}

// The clamped cosine has a kink: on 200 x 400 nodes some 1e-5 is left.
TEST(HemisphereGrid, IntegralsOfAClampedCosine) {
    const auto lobe = [](Vec3 n) { return double(std::max(dot(n, kN7), 0.0f)); };
    EXPECT_NEAR(integral(200, 400, lobe), 2.91719317833, 3e-5);
    EXPECT_NEAR(integral(200, 400, [](Vec3 n) { return double(std::max(dot(n, kN7), 0.0f)) * n.x; }), 0.495332024311,
                3e-5);
    EXPECT_NEAR(integral(200, 400, [](Vec3 n) { return double(std::max(dot(n, kN7), 0.0f)) * n.y; }), 0.742998036466,
                3e-5);
    EXPECT_NEAR(integral(200, 400, [](Vec3 n) { return double(std::max(dot(n, kN7), 0.0f)) * n.z; }), 1.82938190869,
                3e-5);
    EXPECT_NEAR(integral(200, 400,
                         [](Vec3 n) {
                             const double c = double(std::max(dot(n, kN7), 0.0f));
                             return c * c;
                         }),
                2.02799280145, 3e-5);
}

TEST(SolvePositiveDefinite, Inverts) {
    std::vector<double> b{1, 0, 0, 1};
    solve_positive_definite({4, 1, 1, 3}, 2, b, 2);
    EXPECT_NEAR(b[0], 3.0 / 11, 1e-15);
    EXPECT_NEAR(b[1], -1.0 / 11, 1e-15);
    EXPECT_NEAR(b[3], 4.0 / 11, 1e-15);
}

// About n_v the lobe is linear, and so are the weights; elsewhere they are the best there are: K's polynomial, which is
// one choice of them, is not closer for any normal.
TEST(IrradianceWeights, AreExactAtTheNormal) {
    const auto weights = irradiance_weights({Vec3{0, 0, 1}})[0];
    for (std::size_t i = 0; i < 9; ++i)
        // z = Y_2/k1, and I = (1/pi) integral of L z. The Gram matrix is near singular: roundings of its floats grow
        // 250 times.
        EXPECT_NEAR(weights[i], i == 2 ? 1 / (M_PI * 0.48860251190291992) : 0.0, 3e-5) << i;
}

TEST(IrradianceWeights, AreTheLeastSquaresOfTheLobe) {
    const auto weights = irradiance_weights({kN7})[0];
    const HemisphereGrid grid = hemisphere_grid(100, 200);
    std::array<double, 9> residual{};  // integral of (lobe/pi - sum of weights Y) Y must vanish
    for (std::size_t k = 0; k < grid.normal.size(); ++k) {
        const ShBasis y = sh_basis(grid.normal[k]);
        double r = std::max(dot(grid.normal[k], kN7), 0.0f) / M_PI;
        for (std::size_t i = 0; i < 9; ++i) r -= double(weights[i]) * y[i];
        for (std::size_t i = 0; i < 9; ++i) residual[i] += grid.weight[k] * r * y[i];
    }
    for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(residual[i], 0.0, 2e-5) << i;  // the kink on the grid
}

// The double integral that kIrradianceFit comes from, by the rules above: weights about many normals, projected on
// polynomials of the normal.
TEST(IrradianceFit, IsTheProjectionOfTheWeights) {
    const HemisphereGrid grid = hemisphere_grid(24, 48);
    const auto weights = irradiance_weights(grid.normal);
    std::vector<double> gram(81), right(81);
    for (std::size_t k = 0; k < grid.normal.size(); ++k) {
        const ShBasis y = sh_basis(grid.normal[k]);
        for (std::size_t i = 0; i < 9; ++i)
            for (std::size_t j = 0; j < 9; ++j) {
                gram[9 * i + j] += grid.weight[k] * double(y[i]) * y[j];
                right[9 * i + j] += grid.weight[k] * double(y[i]) * weights[k][j];
            }
    }
    solve_positive_definite(std::move(gram), 9, right, 9);
    for (std::size_t j = 0; j < 9; ++j) {
        std::array<float, 9> unit{};
        unit[j] = 1;
        const auto column = multiply(kIrradianceFit, unit);
        // Twice a near singular matrix of floats: 250 squared times 6e-8 at worst.
        for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(right[9 * i + j], column[i], 2e-3) << i << " " << j;
    }
}

std::array<float, 4> linear_basis(Vec3 n) { return {1, n.x, n.y, n.z}; }
std::array<float, 4> hlsh_basis(Vec3 n) { return {n.z, 1 - n.z, n.x, n.y}; }

// A single direction of integral 1. Its least squares in closed form; ours goes through the nearest quadratic
// polynomial, which has the same nearest linear one.
TexelLight single_direction() {
    const HemisphereGrid grid = hemisphere_grid(200, 400);
    std::vector<double> gram(81), right(9);
    for (std::size_t k = 0; k < grid.normal.size(); ++k) {
        const ShBasis y = sh_basis(grid.normal[k]);
        const double i_n = std::max(dot(grid.normal[k], kN7), 0.0f) / M_PI;
        for (std::size_t i = 0; i < 9; ++i) {
            right[i] += grid.weight[k] * i_n * y[i];
            for (std::size_t j = 0; j < 9; ++j) gram[9 * i + j] += grid.weight[k] * double(y[i]) * y[j];
        }
    }
    solve_positive_definite(std::move(gram), 9, right, 1);
    TexelLight out{
        directional_light(Vec3{1, 1, 1} * (1 / float(M_PI)), kN7), {}, Vec3{1, 1, 1} * (kN7.z / float(M_PI))};
    for (std::size_t i = 0; i < 9; ++i) out.fit.c[i] = Vec3{1, 1, 1} * float(right[i]);
    return out;
}

TEST(BasisFit, LinearOfASingleDirection) {
    const auto v = BasisFit<4>(linear_basis).nearest(single_direction().fit);
    EXPECT_NEAR(v[0].x, 0.0350815105167, 2e-5);
    EXPECT_NEAR(v[1].x, 0.0752814404987, 2e-5);
    EXPECT_NEAR(v[2].y, 0.112922160748, 2e-5);
    EXPECT_NEAR(v[3].z, 0.225410444709, 2e-5);
}

TEST(BasisFit, ExactAtTheNormalOfASingleDirection) {
    const auto v = BasisFit<4>(hlsh_basis).nearest_exact(single_direction());
    EXPECT_NEAR(v[0].x, 0.2728370453, 1e-6);
    EXPECT_NEAR(v[1].x, 0.0289089654792, 2e-5);
    EXPECT_NEAR(v[2].y, 0.0752814404987, 2e-5);
    EXPECT_NEAR(v[3].z, 0.112922160748, 2e-5);
}

}  // namespace
}  // namespace lumel
