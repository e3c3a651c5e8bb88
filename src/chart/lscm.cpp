#include "chart/lscm.h"

#include "chart/eigen_vectors.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace lumel {
namespace {

using Triplet = Eigen::Triplet<double, int>;

// Collects the quadratic form over the unknowns, pinned ones moved to the right-hand side.
class Assembly {
public:
    Assembly(std::size_t vertices, std::uint32_t pin_a, const Eigen::Vector2d& uv_a, std::uint32_t pin_b,
             const Eigen::Vector2d& uv_b)
        : unknown_(2 * vertices, -1), fixed_(2 * vertices, 0.0) {
        fixed_[2 * pin_a] = uv_a.x(), fixed_[2 * pin_a + 1] = uv_a.y();
        fixed_[2 * pin_b] = uv_b.x(), fixed_[2 * pin_b + 1] = uv_b.y();
        for (std::size_t i = 0; i < unknown_.size(); ++i)
            if (i / 2 != pin_a && i / 2 != pin_b) unknown_[i] = count_++;
        right_ = Eigen::VectorXd::Zero(count_);
    }

    // Adds `value` at (i, j) of the matrix; the caller adds (j, i) too.
    void add(std::size_t i, std::size_t j, double value) {
        if (unknown_[i] < 0) return;
        if (unknown_[j] < 0)
            right_[unknown_[i]] -= value * fixed_[j];
        else if (unknown_[i] >= unknown_[j])  // the lower half is enough
            entries_.emplace_back(unknown_[i], unknown_[j], value);
    }

    [[nodiscard]] std::optional<std::vector<Eigen::Vector2d>> solve() const {
        Eigen::SparseMatrix<double> matrix(count_, count_);
        matrix.setFromTriplets(entries_.begin(), entries_.end());
        // The area terms cancel exactly on inner edges; without them u and v meet on the border only.
        matrix.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0.0; });
        Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver(matrix);
        if (solver.info() != Eigen::Success) return std::nullopt;
        const Eigen::VectorXd x = solver.solve(right_);
        if (solver.info() != Eigen::Success || !x.allFinite()) return std::nullopt;
        std::vector<Eigen::Vector2d> uv(unknown_.size() / 2);
        const auto value = [&](std::size_t i) { return unknown_[i] < 0 ? fixed_[i] : x[unknown_[i]]; };
        for (std::size_t v = 0; v < uv.size(); ++v) uv[v] = {value(2 * v), value(2 * v + 1)};
        return uv;
    }

private:
    std::vector<int> unknown_;
    std::vector<double> fixed_;
    std::vector<Triplet> entries_;
    Eigen::VectorXd right_;
    int count_ = 0;
};

void add_triangle(Assembly& assembly, const Patch& patch, std::size_t t) {
    const std::array<Eigen::Vector2d, 3> p = lay_flat(patch, t);
    const std::array<std::uint32_t, 3>& v = patch.triangles[t];
    const double twice_area = cross2(p[1] - p[0], p[2] - p[0]);
    for (int k = 0; k < 3; ++k) {
        const std::size_t i = v[k], j = v[(k + 1) % 3];
        // Dirichlet energy: half the cotangent of the angle opposite to edge (i, j).
        const Eigen::Vector2d& o = p[(k + 2) % 3];
        const double w = 0.5 * (p[k] - o).dot(p[(k + 1) % 3] - o) / twice_area;
        for (std::size_t c = 0; c < 2; ++c) {
            assembly.add(2 * i + c, 2 * i + c, w), assembly.add(2 * j + c, 2 * j + c, w);
            assembly.add(2 * i + c, 2 * j + c, -w), assembly.add(2 * j + c, 2 * i + c, -w);
        }
        // Minus the area of the image: half the sum of u_i v_j - u_j v_i over its edges.
        assembly.add(2 * i, 2 * j + 1, -0.5), assembly.add(2 * j + 1, 2 * i, -0.5);
        assembly.add(2 * j, 2 * i + 1, 0.5), assembly.add(2 * i + 1, 2 * j, 0.5);
    }
}

}  // namespace

std::array<Eigen::Vector2d, 3> lay_flat(const Patch& patch, std::size_t triangle) {
    constexpr double kThinnest = 1e-4;  // altitude over base
    const std::array<std::uint32_t, 3>& v = patch.triangles[triangle];
    const Eigen::Vector3d e1 = patch.positions[v[1]] - patch.positions[v[0]],
                          e2 = patch.positions[v[2]] - patch.positions[v[0]];
    const double base = std::max(e1.norm(), 1e-30);
    const double x = e2.dot(e1) / base, y = e1.cross(e2).norm() / base;
    return {Eigen::Vector2d{0, 0}, Eigen::Vector2d{base, 0},
            Eigen::Vector2d{x, std::max(y, kThinnest * std::max(base, std::abs(x)))}};
}

std::optional<std::vector<Eigen::Vector2d>> lscm(const Patch& patch, std::uint32_t pin_a, const Eigen::Vector2d& uv_a,
                                                 std::uint32_t pin_b, const Eigen::Vector2d& uv_b) {
    Assembly assembly(patch.positions.size(), pin_a, uv_a, pin_b, uv_b);
    for (std::size_t t = 0; t < patch.triangles.size(); ++t) add_triangle(assembly, patch, t);
    return assembly.solve();
}

}  // namespace lumel
