// The binary tree of lights from which LightTree makes its wide nodes.
// Based on: Conty Estevez, Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (cost of a
// split).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/light_bounds.h"

namespace lumel {

// A bound of the nodes from the root to any light.
inline constexpr std::uint32_t kMostLightTreeLevels = 64;

struct BinaryLightNode {
    static constexpr std::uint32_t kNoLight = 0xffffffffu;

    LightBounds bounds;
    std::uint32_t second = 0;        // the other child; the first one follows its parent
    std::uint32_t light = kNoLight;  // of a leaf
    std::uint32_t guaranteed = 0;    // lights below that must be sampled

    [[nodiscard]] bool is_leaf() const { return light != kNoLight; }
};

// The root comes first; empty without lights. Lights without intensity are left out. Fewer than kUnits / 2
// (math/discrete.h) that must be sampled.
std::vector<BinaryLightNode> build_light_tree(std::span<const LightBounds> lights);

// At most `most` nodes (at least one) that together have each light below `root` once: the brightest are divided first,
// those of `whole` (ascending) never. Ascending, an order in which neighbours are alike.
std::vector<std::uint32_t> divide_brightest(std::span<const BinaryLightNode> nodes, std::uint32_t root,
                                            std::size_t most, std::span<const std::uint32_t> whole = {});

}  // namespace lumel
