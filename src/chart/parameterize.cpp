#include "chart/parameterize.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "chart/align.h"
#include "chart/lscm.h"

namespace lumel {
namespace {

Eigen::Vector3d to_double(Vec3 v) { return {v.x, v.y, v.z}; }
double cross2(Eigen::Vector2d a, Eigen::Vector2d b) { return a.x() * b.y() - a.y() * b.x(); }

// ---- Clusters -------------------------------------------------------------------------------------------------------

// Position of a triangle in a sorted list, or kNone.
std::uint32_t index_in(const std::vector<std::uint32_t>& sorted, std::uint32_t triangle) {
    const auto it = std::lower_bound(sorted.begin(), sorted.end(), triangle);
    return it != sorted.end() && *it == triangle ? static_cast<std::uint32_t>(it - sorted.begin()) : kNone;
}

// Splits a sorted list of triangles into its edge-connected parts, in order of their first triangles.
std::vector<std::vector<std::uint32_t>> connected_parts(const MeshTopology& topology,
                                                        const std::vector<std::uint32_t>& triangles) {
    std::vector<std::vector<std::uint32_t>> parts;
    std::vector<bool> taken(triangles.size(), false);
    std::vector<std::uint32_t> stack;
    for (std::uint32_t first = 0; first < triangles.size(); ++first) {
        if (taken[first]) continue;
        taken[first] = true;
        stack.assign(1, first);
        parts.emplace_back();
        while (!stack.empty()) {
            const std::uint32_t t = triangles[stack.back()];
            stack.pop_back();
            parts.back().push_back(t);
            for (std::uint32_t e = 3 * t; e < 3 * t + 3; ++e) {
                if (topology.twin[e] == kNone) continue;
                const std::uint32_t other = index_in(triangles, topology.twin[e] / 3);
                if (other == kNone || taken[other]) continue;
                taken[other] = true;
                stack.push_back(other);
            }
        }
        std::sort(parts.back().begin(), parts.back().end());
    }
    return parts;
}

Eigen::Vector3d mean_normal(const MeshTopology& topology, const std::vector<std::uint32_t>& triangles) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::uint32_t t : triangles) sum += topology.area[t] * to_double(topology.normal[t]);
    return sum.norm() > 0.0 ? Eigen::Vector3d(sum.normalized()) : to_double(topology.normal[triangles[0]]);
}

bool is_planar(const MeshTopology& topology, const std::vector<std::uint32_t>& triangles, const Eigen::Vector3d& normal,
               double planar_cos) {
    return std::all_of(triangles.begin(), triangles.end(),
                       [&](std::uint32_t t) { return normal.dot(to_double(topology.normal[t])) >= planar_cos; });
}

// The triangles as a patch with vertices of its own. Corners are one vertex where they meet across an inner edge, so a
// point where two fans touch stays two vertices.
Patch make_patch(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles) {
    std::vector<std::uint32_t> root(3 * triangles.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t c) {
        while (root[c] != c) c = root[c] = root[root[c]];
        return c;
    };
    const auto unite = [&](std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        root[std::max(a, b)] = std::min(a, b);
    };
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t twin = topology.twin[3 * triangles[i] + k];
            if (twin == kNone) continue;
            const std::uint32_t j = index_in(triangles, twin / 3);
            if (j == kNone) continue;
            unite(3 * i + k, next_edge(3 * j + twin % 3));
            unite(next_edge(3 * i + k), 3 * j + twin % 3);
        }
    }
    Patch patch;
    std::vector<std::uint32_t> number(root.size(), kNone);
    patch.triangles.resize(triangles.size());
    for (std::uint32_t c = 0; c < root.size(); ++c) {
        std::uint32_t& n = number[find(c)];
        if (n == kNone) {
            n = static_cast<std::uint32_t>(patch.positions.size());
            patch.positions.push_back(to_double(mesh.positions[mesh.triangles[triangles[c / 3]][c % 3]]));
        }
        patch.triangles[c / 3][c % 3] = n;
    }
    return patch;
}

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

using Uvs = std::vector<Eigen::Vector2d>;  // per vertex of a patch

// Orthographic projection along `normal`: exact for planar patches.
Uvs project(const Patch& patch, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
    Uvs uv;
    uv.reserve(patch.positions.size());
    for (const Eigen::Vector3d& p : patch.positions) {
        const Eigen::Vector3d d = p - patch.positions[0];
        uv.emplace_back(d.dot(u), d.dot(v));
    }
    return uv;
}

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

double area_3d(const Patch& patch) {
    double area = 0.0;
    for (const auto& t : patch.triangles)
        area +=
            0.5 *
            (patch.positions[t[1]] - patch.positions[t[0]]).cross(patch.positions[t[2]] - patch.positions[t[0]]).norm();
    return area;
}

double area_2d(const Patch& patch, const Uvs& uv) {
    double area = 0.0;
    for (const auto& t : patch.triangles) area += 0.5 * cross2(uv[t[1]] - uv[t[0]], uv[t[2]] - uv[t[0]]);
    return area;
}

// The map scaled to the area of the surface and turned into its smallest box, in the file's precision.
std::vector<UvTriangle> finish(const Patch& patch, Uvs uv) {
    const double area = area_2d(patch, uv);
    if (!(area > 0.0)) return {};
    const double scale = std::sqrt(area_3d(patch) / area);
    for (Eigen::Vector2d& p : uv) p *= scale;
    align_to_box(uv);
    std::vector<UvTriangle> out(patch.triangles.size());
    for (std::size_t t = 0; t < out.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector2d& p = uv[patch.triangles[t][k]];
            out[t][k] = {static_cast<float>(p.x()), static_cast<float>(p.y())};
        }
    return out;
}

// One way to lay out a cluster, and what is wrong with it.
struct Attempt {
    std::vector<UvTriangle> uv;
    std::vector<std::uint32_t> defects;  // positions in the cluster of triangles without which it may be injective
    bool stretched = true;

    [[nodiscard]] bool good() const { return !stretched && defects.empty(); }
};

Attempt attempt(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                std::vector<UvTriangle> uv, const ParameterizeOptions& options) {
    Attempt out;
    out.uv = std::move(uv);
    if (out.uv.empty()) return out;
    out.stretched = l2_stretch(mesh, triangles, out.uv) > options.max_stretch;
    if (!out.stretched) out.defects = find_defects(topology, triangles, out.uv);
    return out;
}

// The cluster as one chart if it can be; else the more hopeful of the ways that were tried.
Attempt flatten_whole(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                      const ParameterizeOptions& options) {
    const Patch patch = make_patch(mesh, topology, triangles);
    const Eigen::Vector3d normal = mean_normal(topology, triangles);
    const Uvs projected = project(patch, normal);
    Attempt best;
    if (!is_planar(topology, triangles, normal, options.planar_cos)) {
        if (const std::optional<Uvs> uv = conformal(patch, projected))
            best = attempt(mesh, topology, triangles, finish(patch, *uv), options);
        if (best.good()) return best;
    }
    Attempt flat = attempt(mesh, topology, triangles, finish(patch, projected), options);
    if (triangles.size() == 1) {  // always its own exact chart, however thin
        flat.stretched = false;
        flat.defects.clear();
    }
    if (flat.good() || best.stretched || (!flat.stretched && flat.defects.size() < best.defects.size())) return flat;
    return best;
}

// ---- Splitting ------------------------------------------------------------------------------------------------------

Eigen::Vector3d centroid(const Mesh& mesh, std::uint32_t t) {
    const Triangle& v = mesh.triangles[t];
    return (to_double(mesh.positions[v[0]]) + to_double(mesh.positions[v[1]]) + to_double(mesh.positions[v[2]])) / 3.0;
}

// Halves the area across the longest axis of the centroids.
std::vector<std::vector<std::uint32_t>> halve(const Mesh& mesh, const MeshTopology& topology,
                                              const std::vector<std::uint32_t>& triangles) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::uint32_t t : triangles) mean += centroid(mesh, t);
    mean /= static_cast<double>(triangles.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const std::uint32_t t : triangles)
        covariance += (centroid(mesh, t) - mean) * (centroid(mesh, t) - mean).transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(covariance);
    const Eigen::Vector3d axis = axes.eigenvectors().col(2);

    std::vector<std::uint32_t> order = triangles;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const double pa = axis.dot(centroid(mesh, a)), pb = axis.dot(centroid(mesh, b));
        return pa != pb ? pa < pb : a < b;
    });
    const double total = std::accumulate(order.begin(), order.end(), 0.0,
                                         [&](double s, std::uint32_t t) { return s + topology.area[t]; });
    std::size_t cut = 0;
    for (double area = 0.0; cut + 1 < order.size() && area < 0.5 * total; ++cut) area += topology.area[order[cut]];
    std::vector<std::vector<std::uint32_t>> halves{{order.begin(), order.begin() + static_cast<std::ptrdiff_t>(cut)},
                                                   {order.begin() + static_cast<std::ptrdiff_t>(cut), order.end()}};
    for (auto& half : halves) std::sort(half.begin(), half.end());
    return halves;
}

// Takes a few triangles out of a cluster: the rest, and those.
std::vector<std::vector<std::uint32_t>> peel(const std::vector<std::uint32_t>& triangles,
                                             const std::vector<std::uint32_t>& positions) {
    std::vector<std::vector<std::uint32_t>> groups(2);
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        groups[std::binary_search(positions.begin(), positions.end(), i) ? 1 : 0].push_back(triangles[i]);
    return groups;
}

// Groups triangles by the side of a box that they face.
std::vector<std::vector<std::uint32_t>> box_sides(const MeshTopology& topology,
                                                  const std::vector<std::uint32_t>& triangles) {
    std::vector<std::vector<std::uint32_t>> sides(6);
    for (const std::uint32_t t : triangles) {
        const Vec3 n = topology.normal[t];
        const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
        const std::size_t axis = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
        sides[2 * axis + (n[axis] < 0.0f ? 1 : 0)].push_back(t);
    }
    std::erase_if(sides, [](const auto& side) { return side.empty(); });
    return sides;
}

class Worker {
public:
    Worker(const Mesh& mesh, const MeshTopology& topology, const ParameterizeOptions& options,
           const std::function<bool()>& cancelled)
        : mesh_(mesh), topology_(topology), options_(options), cancelled_(cancelled) {}

    void flatten(const std::vector<std::uint32_t>& triangles, int splits) {
        if (cancelled_()) return;
        Attempt best = flatten_whole(mesh_, topology_, triangles, options_);
        if (best.good()) {
            result_.charts.push_back({triangles, std::move(best.uv)});
        } else if (splits == options_.max_splits) {
            ++result_.fallbacks;
            flatten_by_box(triangles);
        } else if (!best.stretched && 4 * best.defects.size() <= triangles.size()) {
            flatten_parts(peel(triangles, best.defects), splits + 1);
        } else {
            flatten_parts(halve(mesh_, topology_, triangles), splits + 1);
        }
    }

    Parameterized take() { return std::move(result_); }

private:
    void flatten_parts(const std::vector<std::vector<std::uint32_t>>& groups, int splits) {
        for (const auto& group : groups)
            for (const auto& part : connected_parts(topology_, group)) flatten(part, splits);
    }

    // The last resort: what faces one side of a box is projected on it, or every triangle goes alone.
    void flatten_by_box(const std::vector<std::uint32_t>& triangles) {
        for (const auto& side : box_sides(topology_, triangles)) {
            for (const auto& part : connected_parts(topology_, side)) {
                Attempt whole = flatten_whole(mesh_, topology_, part, options_);
                if (whole.good())
                    result_.charts.push_back({part, std::move(whole.uv)});
                else
                    for (const std::uint32_t t : part) flatten({t}, options_.max_splits);
            }
        }
    }

    const Mesh& mesh_;
    const MeshTopology& topology_;
    const ParameterizeOptions& options_;
    const std::function<bool()>& cancelled_;
    Parameterized result_;
};

}  // namespace

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

Parameterized parameterize(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& cluster,
                           const ParameterizeOptions& options, const std::function<bool()>& cancelled) {
    Worker worker(mesh, topology, options, cancelled);
    worker.flatten(cluster, 0);
    return worker.take();
}

}  // namespace lumel
