#include "chart/patch.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/union_find.h"
#include "chart/eigen_vectors.h"

namespace lumel {
namespace {}  // namespace

std::uint32_t index_in(const std::vector<std::uint32_t>& sorted, std::uint32_t triangle) {
    const auto it = std::lower_bound(sorted.begin(), sorted.end(), triangle);
    return it != sorted.end() && *it == triangle ? static_cast<std::uint32_t>(it - sorted.begin()) : kNone;
}

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

Patch make_patch(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& triangles,
                 const std::vector<std::uint32_t>& cuts) {
    UnionFind corners(3 * triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t twin = topology.twin[3 * triangles[i] + k];
            if (twin == kNone || std::binary_search(cuts.begin(), cuts.end(), 3 * triangles[i] + k)) continue;
            const std::uint32_t j = index_in(triangles, twin / 3);
            if (j == kNone) continue;
            corners.unite(3 * i + k, next_edge(3 * j + twin % 3));
            corners.unite(next_edge(3 * i + k), 3 * j + twin % 3);
        }
    }
    Patch patch;
    std::vector<std::uint32_t> number(3 * triangles.size(), kNone);
    patch.triangles.resize(triangles.size());
    for (std::uint32_t c = 0; c < number.size(); ++c) {
        std::uint32_t& n = number[corners.find(c)];
        if (n == kNone) {
            n = static_cast<std::uint32_t>(patch.positions.size());
            patch.positions.push_back(to_double(mesh.positions[mesh.triangles[triangles[c / 3]][c % 3]]));
        }
        patch.triangles[c / 3][c % 3] = n;
    }
    return patch;
}

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

}  // namespace lumel
