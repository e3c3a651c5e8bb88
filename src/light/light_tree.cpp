#include "light/light_tree.h"

#include <algorithm>

#include "base/check.h"
#include "math/discrete.h"

namespace lumel {

// Makes wide nodes of a binary tree. Each group begins with a node of its own.
class LightTree::Collapse {
public:
    Collapse(std::span<const BinaryLightNode> binary, std::size_t most_groups, LightTree& tree)
        : binary_(binary), tree_(tree), group_roots_(divide_brightest(binary, 0, most_groups)) {
        tree_.groups_.resize(group_roots_.size());
        make_node(divide_brightest(binary_, 0, kChildren, group_roots_), kNoLight);
        for (std::size_t g = 0; g < group_roots_.size(); ++g) {
            const BinaryLightNode& root = binary_[group_roots_[g]];
            tree_.groups_[g].guaranteed = root.guaranteed;
            tree_.group_bounds_.emplace_back().set(0, root.bounds);
        }
        std::uint32_t g = 0;
        for (std::uint32_t i = 0; i < binary_.size(); ++i) {
            if (g + 1 < group_roots_.size() && i == group_roots_[g + 1]) ++g;
            if (binary_[i].is_leaf()) tree_.group_of_light_[binary_[i].light] = g;
        }
    }

private:
    // Returns the node's number.
    std::uint32_t make_node(const std::vector<std::uint32_t>& children, std::uint32_t place) {
        const auto index = static_cast<std::uint32_t>(tree_.nodes_.size());
        tree_.nodes_.emplace_back().place = place;
        for (std::uint32_t k = 0; k < children.size(); ++k) {
            const BinaryLightNode& child = binary_[children[k]];
            tree_.nodes_[index].bounds.set(k, child.bounds);
            tree_.nodes_[index].guaranteed[k] = child.guaranteed;
            const std::uint32_t reference = make_child(children[k], kChildren * index + k);
            tree_.nodes_[index].child[k] = reference;
            const auto group = std::ranges::lower_bound(group_roots_, children[k]);
            if (group != group_roots_.end() && *group == children[k])
                tree_.groups_[static_cast<std::size_t>(group - group_roots_.begin())].root = reference;
        }
        return index;
    }

    std::uint32_t make_child(std::uint32_t root, std::uint32_t place) {
        const BinaryLightNode& node = binary_[root];
        if (node.is_leaf()) {
            tree_.place_of_light_[node.light] = place;
            return kLeaf | node.light;
        }
        // Groups are divided only from their roots on.
        const bool is_group = std::ranges::binary_search(group_roots_, root);
        const auto whole = is_group ? std::span<const std::uint32_t>() : std::span<const std::uint32_t>(group_roots_);
        return make_node(divide_brightest(binary_, root, kChildren, whole), place);
    }

    std::span<const BinaryLightNode> binary_;
    LightTree& tree_;
    std::vector<std::uint32_t> group_roots_;  // ascending
};

LightTree::LightTree(std::span<const LightBounds> lights, std::size_t most_groups)
    : group_of_light_(lights.size(), kNoLight), place_of_light_(lights.size(), kNoLight) {
    LUMEL_CHECK(lights.size() < kLeaf / kChildren && most_groups > 0, lights.size(), most_groups);
    const std::vector<BinaryLightNode> binary = build_light_tree(lights);
    if (!binary.empty()) const Collapse collapse(binary, most_groups, *this);
}

// By importance, of what those that must be sampled leave over.
LightTree::PerChild LightTree::share(const Node& node, std::uint32_t units, const Receiver& receiver) {
    std::array<double, kChildren> sums = node.bounds.importance(receiver);
    PerChild ends;
    std::uint32_t guaranteed = 0;
    double total = 0.0;
    for (std::size_t i = 0; i < kChildren; ++i) {
        const bool shines = sums[i] > 0.0;
        guaranteed += shines ? node.guaranteed[i] : 0;
        ends[i] = guaranteed;
        total += shines ? sums[i] : 0.0;
        sums[i] = total;
    }
    if (!(total > 0.0)) return {};
    const auto free_units = static_cast<double>(units - guaranteed);
    for (std::size_t i = 0; i < kChildren; ++i)
        ends[i] += static_cast<std::uint32_t>(static_cast<std::int32_t>(sums[i] / total * free_units + 0.5));
    return ends;
}

LightTree::Chosen LightTree::choose(const Receiver& receiver, float u) const {
    return nodes_.empty() ? Chosen{} : choose_in({}, unit_of(u), kUnits, receiver);
}

std::uint32_t LightTree::units_of(const Receiver& receiver, std::uint32_t light) const {
    return nodes_.empty() ? 0 : units_in({}, kUnits, receiver, light);
}

LightTree::Chosen LightTree::choose_in(const Subtree& group, std::uint32_t unit, std::uint32_t units,
                                       const Receiver& receiver) const {
    std::uint32_t reference = group.root;
    while ((reference & kLeaf) == 0) {
        const Node& node = nodes_[reference];
        const PerChild ends = share(node, units, receiver);
        if (ends.back() == 0) return {};  // though their common bound may light the receiver
        std::uint32_t child = 0;
        for (const std::uint32_t end : ends) child += end <= unit ? 1 : 0;
        const std::uint32_t begin = child == 0 ? 0 : ends[child - 1];
        units = ends[child] - begin;
        unit -= begin;
        reference = node.child[child];
    }
    return {reference & ~kLeaf, units};
}

std::uint32_t LightTree::units_in(const Subtree& group, std::uint32_t units, const Receiver& receiver,
                                  std::uint32_t light) const {
    if ((group.root & kLeaf) != 0) return group.root == (kLeaf | light) ? units : 0;
    std::array<std::uint32_t, kMostLightTreeLevels> places;  // from the light up to the root
    std::size_t levels = 0;
    std::uint32_t place = place_of_light_[light];
    for (; place != kNoLight && levels < places.size(); place = nodes_[place / kChildren].place) {
        places[levels++] = place;
        if (place / kChildren == group.root) break;
    }
    if (place == kNoLight) return 0;  // the light is not of the group
    for (; levels > 0 && units > 0; --levels) {
        const std::uint32_t child = places[levels - 1] % kChildren;
        const PerChild ends = share(nodes_[places[levels - 1] / kChildren], units, receiver);
        units = child == 0 ? ends[0] : ends[child] - ends[child - 1];
    }
    return units;
}

}  // namespace lumel
