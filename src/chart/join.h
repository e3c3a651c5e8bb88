// Joins neighbouring charts that are still a valid map together: fewer charts, and less smooth surface that is cut.
//
// Based on: the merge of charts by what it saves of Sander, Wood, Gortler, Snyder, Hoppe, "Multi-chart geometry images"
// (2003), judged by the map itself instead of a proxy: the smaller chart is brought to the larger one by the rigid
// motion that fits their common border best (Procrustes), both are relaxed together, and the result must have neither
// flips nor overlaps nor more stretch than is allowed. What closes a ring (a tube, whose two halves meet along two
// lines) is joined along one line and stays cut along the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "base/union_find.h"
#include "chart/crease.h"
#include "chart/flatten.h"
#include "chart/topology.h"

namespace lumel {

struct JoinOptions {
    CreaseRule crease;
    double max_stretch = 1.05;  // Sander's L2 of a joined chart
    double max_gap = 0.25;      // root mean square distance of the borders after the rigid motion, over their length
    int relax_steps = 8;
    // Triangles of all attempts together, times those of the component: what bounds the time. One that is refused by
    // its gap counts as a hundredth of the smaller chart.
    double work = 6.0;
};

// The charts of one mesh. Pairs are tried by the length of smooth surface between them, longest first.
class ChartJoiner {
public:
    ChartJoiner(const Mesh& mesh, const MeshTopology& topology, std::vector<FlatChart> charts,
                const JoinOptions& options);

    // Charts of different components have no smooth surface between them. Components may run at the same time.
    [[nodiscard]] std::size_t component_count() const { return components_.size(); }
    void run(std::size_t component, const std::function<bool()>& cancelled);

    // What is left, in no particular order.
    std::vector<FlatChart> take();

private:
    struct Border {
        double smooth = 0.0, crease = 0.0;  // lengths
    };
    struct Piece {
        FlatChart chart;
        std::uint32_t version = 0;
        std::map<std::uint32_t, Border> borders;  // by neighbour
    };
    friend class ComponentJoiner;

    void add_borders();
    void find_components();
    std::uint32_t find(std::uint32_t piece);  // touches nothing outside the component of `piece`
    [[nodiscard]] bool same_component(std::uint32_t a, std::uint32_t b) const {
        return a != kNone && component_of_[a] == component_of_[b];
    }

    const Mesh& mesh_;
    const MeshTopology& topology_;
    const JoinOptions options_;
    std::vector<Piece> pieces_;
    std::vector<std::uint32_t> piece_of_triangle_;  // before anything was joined, or kNone
    UnionFind sets_;                                // of pieces that are one chart
    std::vector<std::uint32_t> component_of_;       // of pieces
    std::vector<std::vector<std::uint32_t>> components_;
};

}  // namespace lumel
