#include "chart/join.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "chart/arap.h"
#include "chart/eigen_vectors.h"

namespace lumel {
namespace {

// x -> R x + offset.
struct RigidMotion {
    double c = 1.0, s = 0.0;
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();

    [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
        return Eigen::Vector2d(c * p.x() - s * p.y(), s * p.x() + c * p.y()) + offset;
    }
};

// An edge between two charts: its ends in the chart that stays and in the one that is moved.
struct CommonEdge {
    std::uint32_t moved_edge, kept_edge;
    std::array<Eigen::Vector2d, 2> kept, moved;
    double length;
    std::uint32_t run = 0;
};

// Least squares over the ends of the edges of one run, weighted by length.
RigidMotion fit(const std::vector<CommonEdge>& edges, std::uint32_t run) {
    double weight = 0.0, c = 0.0, s = 0.0;
    Eigen::Vector2d kept = Eigen::Vector2d::Zero(), moved = Eigen::Vector2d::Zero();
    for (const CommonEdge& e : edges) {
        if (e.run != run) continue;
        weight += 2.0 * e.length;
        for (std::size_t k = 0; k < 2; ++k) kept += e.length * e.kept[k], moved += e.length * e.moved[k];
    }
    kept /= weight, moved /= weight;
    for (const CommonEdge& e : edges) {
        if (e.run != run) continue;
        for (std::size_t k = 0; k < 2; ++k) {
            const Eigen::Vector2d p = e.moved[k] - moved, q = e.kept[k] - kept;
            c += e.length * p.dot(q);
            s += e.length * (p.x() * q.y() - p.y() * q.x());
        }
    }
    RigidMotion motion;
    const double norm = std::sqrt(c * c + s * s);
    if (norm > 0.0) motion.c = c / norm, motion.s = s / norm;
    motion.offset = kept - motion(moved);
    return motion;
}

// Root mean square distance of the two sides of a run, and how long it is.
struct Gap {
    double distance = 0.0, length = 0.0;
};

// Of all runs, by their number.
std::vector<Gap> gaps_of(const std::vector<CommonEdge>& edges, const RigidMotion& motion) {
    std::vector<Gap> gaps(edges.size());
    for (const CommonEdge& e : edges) {
        Gap& gap = gaps[e.run];
        gap.length += e.length;
        for (std::size_t k = 0; k < 2; ++k)
            gap.distance += 0.5 * e.length * (motion(e.moved[k]) - e.kept[k]).squaredNorm();
    }
    for (Gap& gap : gaps)
        if (gap.length > 0.0) gap.distance = std::sqrt(gap.distance / gap.length);
    return gaps;
}

}  // namespace

// ---- One component --------------------------------------------------------------------------------------------------

class ComponentJoiner {
public:
    ComponentJoiner(ChartJoiner& all, const std::vector<std::uint32_t>& pieces) : all_(all), pieces_(pieces) {
        for (const std::uint32_t p : pieces) budget_ += static_cast<double>(chart(p).triangles.size());
        budget_ = all.options_.work * budget_ + kFreeWork;
    }

    void run(const std::function<bool()>& cancelled) {
        for (const std::uint32_t a : pieces_)
            for (const auto& [b, border] : all_.pieces_[a].borders)
                if (a < b) enqueue(a, b, border);
        while (!queue_.empty() && budget_ > 0.0 && !cancelled()) {
            const Candidate best = queue_.top();
            queue_.pop();
            if (all_.pieces_[best.a].version != best.version_a || all_.pieces_[best.b].version != best.version_b)
                continue;
            try_pair(best.a, best.b, cancelled);
        }
    }

private:
    static constexpr double kFreeWork = 2000.0;  // triangles: small components are tried to the end

    static constexpr double kExactCost = 0.25;  // of an attempt without relaxing
    static constexpr double kLookCost = 0.01;   // of looking for the common edges of a chart

    struct Candidate {
        double smooth;
        std::uint32_t a, b, version_a, version_b;
        bool operator<(const Candidate& o) const {  // the queue's top is the longest
            return smooth != o.smooth ? smooth < o.smooth : std::tie(a, b) > std::tie(o.a, o.b);
        }
    };

    [[nodiscard]] FlatChart& chart(std::uint32_t p) { return all_.pieces_[p].chart; }

    void enqueue(std::uint32_t a, std::uint32_t b, const ChartJoiner::Border& border) {
        if (border.smooth > border.crease)
            queue_.push({border.smooth, a, b, all_.pieces_[a].version, all_.pieces_[b].version});
    }

    void try_pair(std::uint32_t a, std::uint32_t b, const std::function<bool()>& cancelled) {
        const auto key = [&](std::uint32_t p) { return std::pair(chart(p).triangles.size(), p); };
        if (key(a) < key(b)) std::swap(a, b);
        budget_ -= kLookCost * static_cast<double>(chart(b).triangles.size());
        std::vector<CommonEdge> edges = common_edges(a, b);
        const std::uint32_t longest = number_runs(edges);
        const RigidMotion motion = fit(edges, longest);
        const std::vector<Gap> gaps = gaps_of(edges, motion);
        const double most = all_.options_.max_gap * gaps[longest].length;
        if (gaps[longest].distance > most) return;
        // Other runs that come about as near are taken to meet as well. Those of a long thin tube do, too, but cannot:
        // where the map of all is none, the longest alone may have one.
        const auto cuts_beyond = [&](const auto& meets) {
            std::vector<std::uint32_t> cuts;
            for (const CommonEdge& e : edges)
                if (!meets(e.run)) cuts.push_back(e.moved_edge), cuts.push_back(e.kept_edge);
            return cuts;
        };
        const auto some = cuts_beyond([&](std::uint32_t run) { return gaps[run].distance <= most; });
        std::optional<FlatChart> joined = join(a, b, some, motion, cancelled);
        // Only a run of its size closes a ring; what is tried for crumbs beside it is mostly in vain.
        double beside = 0.0;
        for (std::uint32_t run = 0; run < gaps.size(); ++run)
            if (run != longest && gaps[run].distance <= most) beside = std::max(beside, gaps[run].length);
        if (!joined && budget_ > 0.0 && beside >= 0.5 * gaps[longest].length) {
            const auto all = cuts_beyond([&](std::uint32_t run) { return run == longest; });
            joined = join(a, b, all, motion, cancelled);
        }
        if (joined) replace(a, b, std::move(*joined));
    }

    // Edges of b whose other side is in a.
    std::vector<CommonEdge> common_edges(std::uint32_t a, std::uint32_t b) {
        std::vector<CommonEdge> edges;
        const FlatChart &kept = chart(a), &moved = chart(b);
        for (std::size_t i = 0; i < moved.triangles.size(); ++i)
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t edge = 3 * moved.triangles[i] + k, twin = all_.topology_.twin[edge];
                if (twin == kNone || !all_.same_component(all_.piece_of_triangle_[twin / 3], a)) continue;
                if (all_.find(all_.piece_of_triangle_[twin / 3]) != a) continue;
                const UvTriangle& uv = kept.uv[index_in(kept.triangles, twin / 3)];
                const std::uint32_t t = twin % 3;
                edges.push_back({edge,
                                 twin,
                                 {to_double(uv[(t + 1) % 3]), to_double(uv[t])},
                                 {to_double(moved.uv[i][k]), to_double(moved.uv[i][(k + 1) % 3])},
                                 edge_length(all_.mesh_, edge)});
            }
        return edges;
    }

    // Edges that hang together at their ends are a run. Returns the longest.
    std::uint32_t number_runs(std::vector<CommonEdge>& edges) const {
        struct End {
            std::uint32_t point, edge;
        };
        std::vector<End> ends;
        for (std::uint32_t i = 0; i < edges.size(); ++i) {
            const std::uint32_t e = edges[i].moved_edge;
            ends.push_back({all_.topology_.point[corner_vertex(all_.mesh_, e)], i});
            ends.push_back({all_.topology_.point[corner_vertex(all_.mesh_, next_edge(e))], i});
        }
        std::sort(ends.begin(), ends.end(),
                  [](const End& x, const End& y) { return std::tie(x.point, x.edge) < std::tie(y.point, y.edge); });
        UnionFind runs(edges.size());
        for (std::size_t i = 1; i < ends.size(); ++i)
            if (ends[i].point == ends[i - 1].point) runs.unite(ends[i].edge, ends[i - 1].edge);
        std::vector<double> length(edges.size(), 0.0);
        std::uint32_t longest = 0;
        for (std::uint32_t i = 0; i < edges.size(); ++i) length[edges[i].run = runs.find(i)] += edges[i].length;
        for (std::uint32_t i = 0; i < edges.size(); ++i)
            if (length[i] > length[longest]) longest = i;
        return longest;
    }

    // Both charts as one that stays cut along some common edges, or nothing where that is no valid map.
    std::optional<FlatChart> join(std::uint32_t a, std::uint32_t b, const std::vector<std::uint32_t>& cuts,
                                  const RigidMotion& motion, const std::function<bool()>& cancelled) {
        if (cancelled()) return std::nullopt;
        FlatChart out;
        const FlatChart &kept = chart(a), &moved = chart(b);
        std::merge(kept.triangles.begin(), kept.triangles.end(), moved.triangles.begin(), moved.triangles.end(),
                   std::back_inserter(out.triangles));
        std::merge(kept.cuts.begin(), kept.cuts.end(), moved.cuts.begin(), moved.cuts.end(),
                   std::back_inserter(out.cuts));
        out.cuts.insert(out.cuts.end(), cuts.begin(), cuts.end());
        std::sort(out.cuts.begin(), out.cuts.end());
        out.islands = kept.islands || moved.islands;
        const Patch patch = make_patch(all_.mesh_, all_.topology_, out.triangles, out.cuts);
        Uvs uv;
        const bool exact = !place(kept, moved, motion, patch, out.triangles, uv);
        budget_ -= static_cast<double>(out.triangles.size()) * (exact ? kExactCost : 1.0);
        if (!exact) {
            if (out.islands) return std::nullopt;  // relaxing would not keep them where they are
            relax_as_rigid(patch, all_.options_.relax_steps, uv);
            if (cancelled()) return std::nullopt;
        }
        Attempt result =
            attempt(all_.mesh_, all_.topology_, out.triangles, patch, std::move(uv), all_.options_.max_stretch);
        if (!result.good()) return std::nullopt;
        out.uv = std::move(result.uv);
        return out;
    }

    // The kept chart where it is and the moved one beside it; common vertices in the middle. Returns whether any two
    // sides differ by more than rounding, so that relaxing is needed.
    bool place(const FlatChart& kept, const FlatChart& moved, const RigidMotion& motion, const Patch& patch,
               const std::vector<std::uint32_t>& triangles, Uvs& uv) const {
        uv.assign(patch.positions.size(), Eigen::Vector2d::Zero());
        std::vector<std::uint32_t> count(uv.size(), 0);
        std::size_t i = 0, j = 0;
        std::vector<std::array<Eigen::Vector2d, 3>> corners(triangles.size());
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            const bool stays = i < kept.triangles.size() && kept.triangles[i] == triangles[t];
            const UvTriangle& from = stays ? kept.uv[i++] : moved.uv[j++];
            for (std::size_t k = 0; k < 3; ++k) {
                corners[t][k] = stays ? to_double(from[k]) : motion(to_double(from[k]));
                uv[patch.triangles[t][k]] += corners[t][k];
                ++count[patch.triangles[t][k]];
            }
        }
        for (std::size_t v = 0; v < uv.size(); ++v) uv[v] /= count[v];
        double extent = 0.0, gap = 0.0;
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                extent = std::max(extent, corners[t][k].cwiseAbs().maxCoeff());
                gap = std::max(gap, (corners[t][k] - uv[patch.triangles[t][k]]).norm());
            }
        return gap > 1e-5 * extent;
    }

    void replace(std::uint32_t a, std::uint32_t b, FlatChart joined) {
        auto &keep = all_.pieces_[a], &gone = all_.pieces_[b];
        keep.chart = std::move(joined);
        gone.chart = {};
        ++keep.version, ++gone.version;
        all_.sets_.absorb(a, b);
        keep.borders.erase(b);
        for (const auto& [other, border] : gone.borders) {
            if (other == a) continue;
            ChartJoiner::Border& mine = keep.borders[other];
            mine.smooth += border.smooth, mine.crease += border.crease;
            all_.pieces_[other].borders.erase(b);
            all_.pieces_[other].borders[a] = mine;
        }
        gone.borders.clear();
        for (const auto& [other, border] : keep.borders) enqueue(a, other, border);
    }

    ChartJoiner& all_;
    const std::vector<std::uint32_t>& pieces_;
    std::priority_queue<Candidate> queue_;
    double budget_ = 0.0;
};

// ---- All of a mesh --------------------------------------------------------------------------------------------------

ChartJoiner::ChartJoiner(const Mesh& mesh, const MeshTopology& topology, std::vector<FlatChart> charts,
                         const JoinOptions& options)
    : mesh_(mesh),
      topology_(topology),
      options_(options),
      pieces_(charts.size()),
      piece_of_triangle_(topology.triangle_count(), kNone),
      sets_(charts.size()),
      component_of_(charts.size()) {
    for (std::uint32_t p = 0; p < charts.size(); ++p) {
        for (const std::uint32_t t : charts[p].triangles) piece_of_triangle_[t] = p;
        pieces_[p].chart = std::move(charts[p]);
    }
    add_borders();
    find_components();
}

void ChartJoiner::add_borders() {
    for (std::uint32_t e = 0; e < topology_.twin.size(); ++e) {
        const std::uint32_t twin = topology_.twin[e];
        if (twin == kNone) continue;
        const std::uint32_t a = piece_of_triangle_[e / 3], b = piece_of_triangle_[twin / 3];
        if (a == kNone || b == kNone || a == b) continue;
        Border& border = pieces_[a].borders[b];
        // The twin counts its own side, so that both sides see the same lengths.
        (is_crease(mesh_, topology_, options_.crease, e) ? border.crease : border.smooth) +=
            edge_length(mesh_, std::min(e, twin));
    }
}

void ChartJoiner::find_components() {
    std::vector<std::uint32_t> stack;
    std::vector<bool> taken(pieces_.size(), false);
    for (std::uint32_t first = 0; first < pieces_.size(); ++first) {
        if (taken[first]) continue;
        taken[first] = true;
        stack.assign(1, first);
        components_.emplace_back();
        while (!stack.empty()) {
            const std::uint32_t p = stack.back();
            stack.pop_back();
            components_.back().push_back(p);
            for (const auto& [other, border] : pieces_[p].borders) {
                if (taken[other] || border.smooth == 0.0) continue;
                taken[other] = true;
                stack.push_back(other);
            }
        }
        std::sort(components_.back().begin(), components_.back().end());
    }
    for (std::uint32_t c = 0; c < components_.size(); ++c)
        for (const std::uint32_t p : components_[c]) component_of_[p] = c;
    // Those between components are creases: never joined, and jobs must not touch each other's pieces.
    for (std::uint32_t p = 0; p < pieces_.size(); ++p)
        std::erase_if(pieces_[p].borders, [&](const auto& b) { return !same_component(b.first, p); });
}

void ChartJoiner::run(std::size_t component, const std::function<bool()>& cancelled) {
    if (components_[component].size() > 1) ComponentJoiner(*this, components_[component]).run(cancelled);
}

std::uint32_t ChartJoiner::find(std::uint32_t piece) { return sets_.find(piece); }

std::vector<FlatChart> ChartJoiner::take() {
    std::vector<FlatChart> out;
    for (Piece& piece : pieces_)
        if (!piece.chart.triangles.empty()) out.push_back(std::move(piece.chart));
    return out;
}

}  // namespace lumel
