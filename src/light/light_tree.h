// Choosing one of many local lights for a point, near to in proportion to what each can bring there.
// Based on: Conty Estevez, Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting"; Dammertz,
// Hanika, Keller 2008, "Shallow Bounding Volume Hierarchies for Fast SIMD Ray Tracing of Incoherent Rays" (binary nodes
// collapsed to wide ones, whose children are looked at side by side).
// Different here: the chance of a light is a whole number of units of the random number, exact in both directions: no
// light that must be sampled ever rounds to none, and what is divided by is how often it happens.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "light/light_bounds.h"
#include "light/light_importance.h"
#include "light/light_tree_builder.h"

namespace lumel {

class LightTree {
public:
    LightTree() = default;
    // Fewer than kUnits / 2 that must be sampled. An intensity of zero is never chosen. The lights are parted into at
    // most so many groups (at least one).
    LightTree(std::span<const LightBounds> lights, std::size_t most_groups);

    static constexpr std::uint32_t kNoLight = 0xffffffffu;
    struct Chosen {
        std::uint32_t light = kNoLight;  // kNoLight: none of them lights the receiver
        std::uint32_t units = 0;         // its chance, times kUnits
    };
    [[nodiscard]] Chosen choose(const Receiver& receiver, float u) const;
    // What choose() would have stated for that light.
    [[nodiscard]] std::uint32_t units_of(const Receiver& receiver, std::uint32_t light) const;

    // A part of the tree, of which others say how often it is chosen.
    struct Subtree {
        std::uint32_t root = 0;        // a reference, as of a node's children
        std::uint32_t guaranteed = 0;  // lights in it that must be sampled: it needs as many units
    };
    // Groups that have each light once: the brightest are divided first. In the order of the tree, in which neighbours
    // are alike: evenly spread numbers then choose evenly spread lights. Empty without lights.
    [[nodiscard]] std::span<const Subtree> groups() const { return groups_; }
    // For each light the group that has it, or kNoLight where none does.
    [[nodiscard]] std::span<const std::uint32_t> group_of_lights() const { return group_of_light_; }
    // Importance of the lights of a group.
    [[nodiscard]] double importance_of(std::size_t group, const ReceiverRegion& region) const {
        return group_bounds_[group].importance(region)[0];
    }
    // As above, in a group: `unit` of the `units` that it has been given.
    [[nodiscard]] Chosen choose_in(const Subtree& group, std::uint32_t unit, std::uint32_t units,
                                   const Receiver& receiver) const;
    [[nodiscard]] std::uint32_t units_in(const Subtree& group, std::uint32_t units, const Receiver& receiver,
                                         std::uint32_t light) const;

private:
    static constexpr std::uint32_t kChildren = 8;
    static constexpr std::uint32_t kLeaf = 0x80000000u;  // of a reference: the rest is a light, else a node
    using PerChild = std::array<std::uint32_t, kChildren>;
    struct alignas(64) Node {
        PerChild child{};       // references
        PerChild guaranteed{};  // lights in each that must be sampled
        PreparedBounds<kChildren> bounds;
        std::uint32_t place = kNoLight;  // in the parent, as place_of_light_; kNoLight: the root of all
    };
    class Collapse;

    // The first unit beyond each child, of the units of their node; the last is 0 where none lights the receiver.
    [[nodiscard]] static PerChild share(const Node& node, std::uint32_t units, const Receiver& receiver);

    std::vector<Node> nodes_;  // the root comes first
    std::vector<Subtree> groups_;
    std::vector<PreparedBounds<1>> group_bounds_;
    std::vector<std::uint32_t> group_of_light_;
    std::vector<std::uint32_t> place_of_light_;  // kChildren * node + child, or kNoLight
};

}  // namespace lumel
