#include "chart/segment.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>

#include "base/union_find.h"
#include "chart/crease.h"
#include "chart/eigen_vectors.h"
#include "chart/normal_cone.h"

namespace lumel {
namespace {

// ---- Flat regions ---------------------------------------------------------------------------------------------------

// Grows a region from the largest triangles over edges whose other side has the normal of the region's first triangle.
std::vector<std::uint32_t> flat_regions(const MeshTopology& topology, const SegmentOptions& options,
                                        std::uint32_t& region_count) {
    std::vector<std::uint32_t> seeds(topology.triangle_count());
    std::iota(seeds.begin(), seeds.end(), 0u);
    std::sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
        return topology.area[a] != topology.area[b] ? topology.area[a] > topology.area[b] : a < b;
    });
    std::vector<std::uint32_t> region(topology.triangle_count(), kNone), stack;
    region_count = 0;
    for (const std::uint32_t seed : seeds) {
        if (region[seed] != kNone || topology.area[seed] == 0.0) continue;
        const Eigen::Vector3d normal = to_double(topology.normal[seed]);
        stack.assign(1, seed);
        region[seed] = region_count;
        while (!stack.empty()) {
            const std::uint32_t t = stack.back();
            stack.pop_back();
            for (std::uint32_t e = 3 * t; e < 3 * t + 3; ++e) {
                if (topology.twin[e] == kNone) continue;
                const std::uint32_t other = topology.twin[e] / 3;
                if (region[other] != kNone || normal.dot(to_double(topology.normal[other])) < options.planar_cos)
                    continue;
                region[other] = region_count;
                stack.push_back(other);
            }
        }
        ++region_count;
    }
    return region;
}

// ---- Merging --------------------------------------------------------------------------------------------------------

struct Border {
    double smooth = 0.0, crease = 0.0;  // lengths
    std::uint32_t ticket = 0;           // of the queue entry that stands for this pair
};

struct Cluster {
    Eigen::Vector3d normal_sum = Eigen::Vector3d::Zero();  // area-weighted
    NormalCone cone;
    std::uint32_t version = 0;
    std::map<std::uint32_t, Border> borders;  // by neighbour
};

struct Candidate {
    double cost;
    std::uint32_t a, b, ticket;
    std::uint32_t version_a, version_b;
    bool operator<(const Candidate& o) const {  // the queue's top is the cheapest; tickets are unique
        return cost != o.cost ? cost > o.cost : ticket > o.ticket;
    }
};

class Merger {
public:
    Merger(const Mesh& mesh, const MeshTopology& topology, const SegmentOptions& options,
           const std::vector<std::uint32_t>& region, std::uint32_t region_count)
        : options_(options), clusters_(region_count), sets_(region_count) {
        add_triangles(topology, region);
        add_borders(mesh, topology, region);
    }

    void run(const std::function<bool()>& cancelled) {
        for (std::uint32_t a = 0; a < clusters_.size(); ++a)
            for (auto& [b, border] : clusters_[a].borders)
                if (a < b) enqueue(a, b);
        for (std::size_t step = 0; !queue_.empty(); ++step) {
            if (step % 1024 == 0 && cancelled()) return;
            const Candidate best = queue_.top();
            queue_.pop();
            settle(best);
        }
    }

    std::uint32_t find(std::uint32_t c) { return sets_.find(c); }

private:
    void add_triangles(const MeshTopology& topology, const std::vector<std::uint32_t>& region) {
        for (std::uint32_t t = 0; t < region.size(); ++t) {
            if (region[t] == kNone) continue;
            clusters_[region[t]].normal_sum += topology.area[t] * to_double(topology.normal[t]);
        }
        // A flat region is a cone of its own small spread around the mean.
        for (Cluster& c : clusters_) c.cone.axis = c.normal_sum.normalized();
        for (std::uint32_t t = 0; t < region.size(); ++t) {
            if (region[t] == kNone) continue;
            NormalCone& cone = clusters_[region[t]].cone;
            cone.cosine = std::min(cone.cosine, cone.axis.dot(to_double(topology.normal[t]).normalized()));
        }
        for (Cluster& c : clusters_) c.cone.sine = std::sqrt(std::max(0.0, 1.0 - c.cone.cosine * c.cone.cosine));
    }

    void add_borders(const Mesh& mesh, const MeshTopology& topology, const std::vector<std::uint32_t>& region) {
        for (std::uint32_t e = 0; e < topology.twin.size(); ++e) {
            const std::uint32_t twin = topology.twin[e];
            if (twin == kNone || region[e / 3] == region[twin / 3]) continue;
            Border& border = clusters_[region[e / 3]].borders[region[twin / 3]];
            // The twin counts its own side, so that both sides see the same lengths.
            (is_crease(mesh, topology, options_.crease, e) ? border.crease : border.smooth) +=
                edge_length(mesh, std::min(e, twin));
        }
    }

    // Puts the pair in the queue if it may merge.
    void enqueue(std::uint32_t a, std::uint32_t b) {
        Border& border = clusters_[a].borders.at(b);
        border.ticket = clusters_[b].borders.at(a).ticket = 0;
        if (border.smooth <= border.crease) return;
        const std::optional<NormalCone> cone = cone_union(clusters_[a].cone, clusters_[b].cone);
        if (!cone || cone->cosine < options_.cone_cos) return;
        const Eigen::Vector3d &sum_a = clusters_[a].normal_sum, &sum_b = clusters_[b].normal_sum;
        const double error = sum_a.norm() + sum_b.norm() - (sum_a + sum_b).norm();
        border.ticket = clusters_[b].borders.at(a).ticket = ++last_ticket_;
        queue_.push(
            {error / (border.smooth * border.smooth), a, b, last_ticket_, clusters_[a].version, clusters_[b].version});
    }

    // Merges the pair if the entry is up to date, else prices it anew.
    void settle(const Candidate& c) {
        const std::uint32_t a = find(c.a), b = find(c.b);
        if (a == b) return;
        const auto border = clusters_[a].borders.find(b);
        if (border == clusters_[a].borders.end() || border->second.ticket != c.ticket) return;
        if (a == c.a && b == c.b && clusters_[a].version == c.version_a && clusters_[b].version == c.version_b)
            merge(a, b);
        else
            enqueue(a, b);
    }

    void merge(std::uint32_t a, std::uint32_t b) {
        if (clusters_[a].borders.size() < clusters_[b].borders.size()) std::swap(a, b);
        Cluster &keep = clusters_[a], &gone = clusters_[b];
        keep.cone = *cone_union(keep.cone, gone.cone);
        keep.normal_sum += gone.normal_sum;
        ++keep.version;
        sets_.absorb(a, b);
        keep.borders.erase(b);
        for (const auto& [other, border] : gone.borders)
            if (other != a) move_border(b, a, other, border);
        gone.borders.clear();
    }

    // The border between `from` and `other` becomes one of `to`.
    void move_border(std::uint32_t from, std::uint32_t to, std::uint32_t other, const Border& border) {
        const auto [mine, fresh] = clusters_[to].borders.try_emplace(other, border);
        if (!fresh) {
            mine->second.smooth += border.smooth;
            mine->second.crease += border.crease;
            if (mine->second.ticket == 0) mine->second.ticket = border.ticket;
        }
        clusters_[other].borders.erase(from);
        clusters_[other].borders[to] = mine->second;
        // A pair that could not merge before its border grew may do so now.
        if (mine->second.ticket == 0 && !fresh) enqueue(to, other);
    }

    const SegmentOptions& options_;
    std::vector<Cluster> clusters_;
    UnionFind sets_;
    std::priority_queue<Candidate> queue_;
    std::uint32_t last_ticket_ = 0;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> segment(const Mesh& mesh, const MeshTopology& topology,
                                                const SegmentOptions& options, const std::function<bool()>& cancelled) {
    std::uint32_t region_count = 0;
    const std::vector<std::uint32_t> region = flat_regions(topology, options, region_count);
    Merger merger(mesh, topology, options, region, region_count);
    merger.run(cancelled);

    std::vector<std::uint32_t> number(region_count, kNone);
    std::vector<std::vector<std::uint32_t>> clusters;
    for (std::uint32_t t = 0; t < region.size(); ++t) {
        if (region[t] == kNone) continue;
        std::uint32_t& n = number[merger.find(region[t])];
        if (n == kNone) {
            n = static_cast<std::uint32_t>(clusters.size());
            clusters.emplace_back();
        }
        clusters[n].push_back(t);
    }
    return clusters;
}

}  // namespace lumel
