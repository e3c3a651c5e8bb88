#include "chart/arap.h"

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>

namespace lumel {
namespace {

using Uvs = std::vector<Eigen::Vector2d>;

// A triangle laid flat: its edges k -> k + 1 and half the cotangent of the angle opposite to each.
struct FlatTriangle {
    std::array<Eigen::Vector2d, 3> edge;
    std::array<double, 3> weight;
};

FlatTriangle flat_triangle(const Patch& patch, std::size_t t) {
    const std::array<Eigen::Vector2d, 3> p = lay_flat(patch, t);
    const double twice_area = p[1].x() * p[2].y();
    FlatTriangle out;
    for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector2d &a = p[k], &b = p[(k + 1) % 3], &o = p[(k + 2) % 3];
        out.edge[k] = b - a;
        out.weight[k] = 0.5 * (a - o).dot(b - o) / twice_area;
    }
    return out;
}

class Relaxation {
public:
    explicit Relaxation(const Patch& patch) : patch_(patch) {
        for (std::size_t t = 0; t < patch.triangles.size(); ++t) flat_.push_back(flat_triangle(patch, t));
        factor();
    }

    [[nodiscard]] bool solvable() const { return solver_.info() == Eigen::Success; }

    // One rotation per triangle, then positions. Returns the energy before the step.
    double step(Uvs& uv) {
        // Vertex 0 stays where it is; its row is left out.
        Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(static_cast<Eigen::Index>(uv.size()), 2);
        double energy = 0.0;
        for (std::size_t t = 0; t < flat_.size(); ++t) energy += add_rotated(t, uv, right);
        const auto free = static_cast<Eigen::Index>(uv.size()) - 1;
        const Eigen::MatrixX2d solved = solver_.solve(right.bottomRows(free));
        for (std::size_t i = 1; i < uv.size(); ++i)
            uv[i] = uv[0] + solved.row(static_cast<Eigen::Index>(i) - 1).transpose();
        return energy;
    }

private:
    void factor() {
        std::vector<Eigen::Triplet<double, int>> entries;
        const auto add = [&](std::uint32_t i, std::uint32_t j, double value) {
            if (i >= j && j > 0) entries.emplace_back(static_cast<int>(i) - 1, static_cast<int>(j) - 1, value);
        };
        for (std::size_t t = 0; t < flat_.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t i = patch_.triangles[t][k], j = patch_.triangles[t][(k + 1) % 3];
                const double w = flat_[t].weight[k];
                add(i, i, w), add(j, j, w), add(i, j, -w), add(j, i, -w);
            }
        const auto free = static_cast<Eigen::Index>(patch_.positions.size()) - 1;
        Eigen::SparseMatrix<double> matrix(free, free);
        matrix.setFromTriplets(entries.begin(), entries.end());
        solver_.compute(matrix);
    }

    // The rotation (c, s) that brings the flat triangle nearest to its map, and what it asks of the corners. The
    // origin of positions is vertex 0's.
    double add_rotated(std::size_t t, const Uvs& uv, Eigen::MatrixX2d& right) const {
        const FlatTriangle& f = flat_[t];
        const std::array<std::uint32_t, 3>& v = patch_.triangles[t];
        double c = 0.0, s = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector2d e = uv[v[(k + 1) % 3]] - uv[v[k]];
            c += f.weight[k] * f.edge[k].dot(e);
            s += f.weight[k] * (f.edge[k].x() * e.y() - f.edge[k].y() * e.x());
        }
        const double norm = std::sqrt(c * c + s * s);
        if (norm > 0.0)
            c /= norm, s /= norm;
        else
            c = 1.0, s = 0.0;
        double energy = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector2d& p = f.edge[k];
            const Eigen::Vector2d turned(c * p.x() - s * p.y(), s * p.x() + c * p.y());
            energy += f.weight[k] * (uv[v[(k + 1) % 3]] - uv[v[k]] - turned).squaredNorm();
            right.row(v[(k + 1) % 3]) += f.weight[k] * turned.transpose();
            right.row(v[k]) -= f.weight[k] * turned.transpose();
        }
        return energy;
    }

    const Patch& patch_;
    std::vector<FlatTriangle> flat_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver_;
};

}  // namespace

void relax_as_rigid(const Patch& patch, int steps, std::vector<Eigen::Vector2d>& uv) {
    if (uv.size() < 4) return;  // one triangle is laid flat as it is
    Relaxation relaxation(patch);
    if (!relaxation.solvable()) return;
    Uvs moved = uv;
    double last = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double energy = relaxation.step(moved);
        if (i > 0 && energy > 0.99 * last) break;
        last = energy;
    }
    for (const Eigen::Vector2d& p : moved)
        if (!p.allFinite()) return;
    uv = std::move(moved);
}

}  // namespace lumel
