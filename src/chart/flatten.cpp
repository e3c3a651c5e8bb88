#include "chart/flatten.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "chart/align.h"
#include "chart/arap.h"
#include "chart/eigen_vectors.h"
#include "chart/lscm.h"

namespace lumel {
namespace {

// The grid of float coordinates at the chart's far end, with a few bits to spare.
double uv_rounding(const std::vector<UvTriangle>& uv) {
    float largest = 0.0f;
    for (const UvTriangle& t : uv)
        for (const Vec2 p : t) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    return largest * 0x1p-20;
}

// Flipped triangles, and of every overlapping pair the smaller one. More than all of them are never listed.
std::vector<std::uint32_t> find_defects(const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                                        const std::vector<UvTriangle>& uv) {
    const double rounding = uv_rounding(uv);
    std::vector<bool> defect(uv.size(), false);
    for (std::size_t i = 0; i < uv.size(); ++i) defect[i] = uv_cross(uv[i]) <= 0.0;
    const std::size_t enough = 4 * uv.size();
    for (const auto& [a, b] : find_overlaps(uv, {rounding, rounding, 0.0}, enough).pairs) {
        if (defect[a] || defect[b]) continue;
        defect[topology.area[triangles[a]] < topology.area[triangles[b]] ? a : b] = true;
    }
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < uv.size(); ++i)
        if (defect[i]) out.push_back(i);
    return out;
}

// ---- Maps -----------------------------------------------------------------------------------------------------------

// Conformal map, the two vertices furthest apart along the longer axis of the projection pinned.
std::optional<Uvs> conformal(const Patch& patch, const Uvs& projected) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : projected) mean += p;
    mean /= static_cast<double>(projected.size());
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    for (const Eigen::Vector2d& p : projected) covariance += (p - mean) * (p - mean).transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
    axes.computeDirect(covariance);
    const Eigen::Vector2d axis = axes.eigenvectors().col(1);
    std::uint32_t low = 0, high = 0;
    for (std::uint32_t i = 1; i < projected.size(); ++i) {
        if (axis.dot(projected[i]) < axis.dot(projected[low])) low = i;
        if (axis.dot(projected[i]) > axis.dot(projected[high])) high = i;
    }
    if (low == high) return std::nullopt;
    return lscm(patch, low, projected[low], high, projected[high]);
}

std::vector<UvTriangle> in_files_precision(const Patch& patch, const Uvs& uv) {
    std::vector<UvTriangle> out(patch.triangles.size());
    for (std::size_t t = 0; t < out.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector2d& p = uv[patch.triangles[t][k]];
            out[t][k] = {static_cast<float>(p.x()), static_cast<float>(p.y())};
        }
    return out;
}

// To the area of the surface, so that lengths are metres. False: the image has none.
bool scale_to_surface(const Patch& patch, Uvs& uv) {
    const double area = area_2d(patch, uv);
    if (!(area > 0.0)) return false;
    const double scale = std::sqrt(area_3d(patch) / area);
    for (Eigen::Vector2d& p : uv) p *= scale;
    return true;
}

}  // namespace

Attempt attempt(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                const Patch& patch, Uvs uv, double max_stretch) {
    Attempt out;
    if (!scale_to_surface(patch, uv)) return out;
    align_to_box(uv);
    out.uv = in_files_precision(patch, uv);
    out.stretch = l2_stretch(mesh, triangles, out.uv);
    out.stretched = out.stretch > max_stretch;
    if (!out.stretched) out.defects = find_defects(topology, triangles, out.uv);
    return out;
}

Attempt flatten_planar(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                       const FlattenOptions& options) {
    const Eigen::Vector3d normal = mean_normal(topology, triangles);
    if (!is_planar(topology, triangles, normal, options.planar_cos)) return {};
    const Patch patch = make_patch(mesh, topology, triangles);
    return attempt(mesh, topology, triangles, patch, project(patch, normal), options.max_stretch);
}

Attempt flatten_whole(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                      const FlattenOptions& options) {
    const Patch patch = make_patch(mesh, topology, triangles);
    const Eigen::Vector3d normal = mean_normal(topology, triangles);
    const Uvs projected = project(patch, normal);
    const auto judge = [&](const Uvs& uv) {
        return attempt(mesh, topology, triangles, patch, uv, options.max_stretch);
    };
    if (triangles.size() == 1) {  // always its own exact chart, however thin
        Attempt exact = judge(projected);
        exact.stretched = false;
        exact.defects.clear();
        return exact;
    }
    Attempt best;
    const auto keep_better = [&](Attempt other) {
        if (other.stretched || (!best.stretched && best.defects.size() <= other.defects.size())) return;
        best = std::move(other);
    };
    if (!is_planar(topology, triangles, normal, options.planar_cos)) {
        if (std::optional<Uvs> uv = conformal(patch, projected); uv && scale_to_surface(patch, *uv)) {
            Uvs relaxed = *uv;
            relax_as_rigid(patch, options.relax_steps, relaxed);
            keep_better(judge(relaxed));
            if (!best.good()) keep_better(judge(*uv));
        }
    }
    if (!best.good()) keep_better(judge(projected));
    return best;
}

double l2_stretch(const Mesh& mesh, const std::vector<std::uint32_t>& triangles, const std::vector<UvTriangle>& uv) {
    const double rounding = uv_rounding(uv);
    double weighted = 0.0, area_3d = 0.0, area_uv = 0.0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const Triangle& v = mesh.triangles[triangles[i]];
        const Eigen::Vector3d p0 = to_double(mesh.positions[v[0]]), e1 = to_double(mesh.positions[v[1]]) - p0,
                              e2 = to_double(mesh.positions[v[2]]) - p0;
        const double u1 = double{uv[i][1].x} - uv[i][0].x, v1 = double{uv[i][1].y} - uv[i][0].y;
        const double u2 = double{uv[i][2].x} - uv[i][0].x, v2 = double{uv[i][2].y} - uv[i][0].y;
        const double determinant = u1 * v2 - u2 * v1;
        const double area = 0.5 * e1.cross(e2).norm();
        area_3d += area;
        area_uv += 0.5 * std::abs(determinant);
        // dP/du and dP/dv; multiplied by the area of the image so that a sliver's infinity has its own small weight.
        const Eigen::Vector3d du = e1 * v2 - e2 * v1, dv = e2 * u1 - e1 * u2;
        if (area == 0.0) continue;
        const double longest = std::max({e1.norm(), e2.norm(), (e2 - e1).norm()});
        if (2.0 * area <= 4.0 * rounding * longest) {  // thinner than the grid: its stretch would be that of rounding
            weighted += area;
            continue;
        }
        if (determinant == 0.0) return std::numeric_limits<double>::infinity();
        weighted += area * 0.5 * (du.squaredNorm() + dv.squaredNorm()) / (determinant * determinant);
    }
    return area_3d > 0.0 ? std::sqrt(weighted / area_3d * (area_uv / area_3d)) : 1.0;
}

bool is_injective(const std::vector<UvTriangle>& uv) {
    const double rounding = uv_rounding(uv);
    return std::all_of(uv.begin(), uv.end(), [](const UvTriangle& t) { return uv_cross(t) > 0.0; }) &&
           find_overlaps(uv, {rounding, rounding, 0.0}, 0).complete;
}

}  // namespace lumel
