#include "chart/parameterize.h"

#include "chart/eigen_vectors.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace lumel {
namespace {

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
        Attempt best = flatten_whole(mesh_, topology_, triangles, options_.flatten);
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

    // Parts that touch at T-junctions, together where they fit; those on top of others go alone.
    void flatten_islands(std::vector<std::vector<std::uint32_t>> parts) {
        constexpr int kRounds = 3;
        for (int round = 0; parts.size() > 1 && round < kRounds && !cancelled_(); ++round) {
            std::vector<std::uint32_t> all;
            for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
            std::sort(all.begin(), all.end());
            Attempt whole = flatten_planar(mesh_, topology_, all, options_.flatten);
            if (whole.good()) {
                result_.charts.push_back({std::move(all), std::move(whole.uv), {}, true});
                return;
            }
            if (whole.stretched) break;
            std::vector<bool> defect(all.size(), false);
            for (const std::uint32_t i : whole.defects) defect[i] = true;
            const auto misfits = std::stable_partition(parts.begin(), parts.end(), [&](const auto& part) {
                return std::none_of(part.begin(), part.end(),
                                    [&](std::uint32_t t) { return defect[index_in(all, t)]; });
            });
            for (auto part = misfits; part != parts.end(); ++part) flatten(*part, 0);
            parts.erase(misfits, parts.end());
        }
        for (const auto& part : parts) flatten(part, 0);
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
                Attempt whole = flatten_whole(mesh_, topology_, part, options_.flatten);
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

Parameterized parameterize(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& cluster,
                           const ParameterizeOptions& options, const std::function<bool()>& cancelled) {
    Worker worker(mesh, topology, options, cancelled);
    worker.flatten_islands(connected_parts(topology, cluster));
    return worker.take();
}

}  // namespace lumel
