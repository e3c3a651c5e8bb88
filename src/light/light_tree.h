// Choosing one of many local lights for a point, near to in proportion to what each can bring there.
// Based on: Conty Estevez, Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (bounds of
// position and direction, cost of a split); Pharr, Jakob, Humphreys, "Physically Based Rendering" 4th ed., section
// 12.6.3 (importance of a node).
// Different here: intensities instead of powers, so that kinds of light compare; a reach, for lights that glTF cuts
// off; and the chance of a light is a whole number of units of the random number, exact in both directions: no light
// that must be sampled ever rounds to none, and what is divided by is how often it happens.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/light_bounds.h"

namespace lumel {

// Of the surface's cosine: light along the surface counts in radiance, if not in irradiance.
inline constexpr float kGrazing = 0.25f;

// Bounds in the form in which millions of receivers ask for their importance.
class PreparedBounds {
public:
    PreparedBounds() = default;
    explicit PreparedBounds(const LightBounds& bounds);
    // Of the light at a receiver, up to a factor that all bounds share; zero only if nothing can come from there.
    [[nodiscard]] double importance(const Receiver& receiver) const;
    // The same of a region: zero only if nothing can come to any receiver in it.
    [[nodiscard]] double importance(const ReceiverRegion& region) const;
    [[nodiscard]] double intensity() const { return intensity_; }

private:
    template <bool is_region>
    [[nodiscard]] double importance_in(const ReceiverRegion& region) const;

    Vec3 low_{}, high_{}, centre_{}, axis_{};
    float radius_squared_ = 0.0f;
    float cos_facing_ = -1.0f, sin_facing_ = 0.0f, cos_emission_ = 0.0f, reach_ = 0.0f;
    double intensity_ = 0.0;
    bool both_sides_ = false;
};

class LightTree {
public:
    LightTree() = default;
    // Fewer than kUnits / 2 that must be sampled. An intensity of zero is never chosen.
    explicit LightTree(std::span<const LightBounds> lights);

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
        std::uint32_t node = 0;        // its root
        std::uint32_t depth = 0;       // of that
        std::uint32_t guaranteed = 0;  // lights in it that must be sampled: it needs as many units
    };
    // At most `most` groups (at least one) that have each light once: the brightest are divided first. In the order of
    // the tree, in which neighbours are alike: evenly spread numbers then choose evenly spread lights. Empty without
    // lights.
    [[nodiscard]] std::vector<Subtree> groups(std::size_t most) const;
    // For each light the group that has it, or kNoLight where none does.
    [[nodiscard]] std::vector<std::uint32_t> group_of_lights(std::span<const Subtree> groups) const;
    // Importance of the lights of a group.
    [[nodiscard]] double importance_of(const Subtree& group, const ReceiverRegion& region) const;
    // As above, below a group's root: `unit` of the `units` that the group has been given.
    [[nodiscard]] Chosen choose_in(const Subtree& group, std::uint32_t unit, std::uint32_t units,
                                   const Receiver& receiver) const;
    [[nodiscard]] std::uint32_t units_in(const Subtree& group, std::uint32_t units, const Receiver& receiver,
                                         std::uint32_t light) const;

private:
    struct Node {
        PreparedBounds bounds;
        std::uint32_t second = 0;        // the other child; the first one follows its parent
        std::uint32_t light = kNoLight;  // of a leaf
        std::uint32_t guaranteed = 0;    // lights below that must be sampled
    };
    class Builder;

    // What the children of a node get of its units; both nothing where neither lights the receiver.
    struct Shares {
        std::uint32_t first, second;
    };
    [[nodiscard]] Shares shares(std::uint32_t index, std::uint32_t units, const Receiver& receiver) const;
    [[nodiscard]] bool reaches(const Receiver& receiver) const;

    std::vector<Node> nodes_;
    std::vector<std::uint64_t> trail_;  // of each light: bit d says whether to take the second child at depth d
};

}  // namespace lumel
