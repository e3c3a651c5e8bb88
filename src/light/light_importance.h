// What bounds of lights can bring to a receiver: of several at once, in the form in which processors compute it
// fastest. Based on: Conty Estevez, Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting"
// (bounds of position and direction); Pharr, Jakob, Humphreys, "Physically Based Rendering" 4th ed., section 12.6.3
// (importance of a node). Different here: intensities instead of powers, so that kinds of light compare; a reach, for
// lights that glTF cuts off.
#pragma once

#include <array>
#include <cstddef>

#include "light/light_bounds.h"

namespace lumel {

// Of the surface's cosine: light along the surface counts in radiance, if not in irradiance.
inline constexpr float kGrazing = 0.25f;

// Bounds of n lights or groups of lights. Those never set have no light.
template <std::size_t n>
class PreparedBounds {
public:
    PreparedBounds() = default;
    void set(std::size_t lane, const LightBounds& bounds);
    // Of each at a receiver, up to a factor that all bounds share; zero only if nothing can come from there.
    [[nodiscard]] std::array<double, n> importance(const Receiver& receiver) const;
    // The same of a region: zero only if nothing can come to any receiver in it.
    [[nodiscard]] std::array<double, n> importance(const ReceiverRegion& region) const;

private:
    template <bool is_region>
    [[nodiscard]] std::array<double, n> importance_in(const ReceiverRegion& region) const;

    using Lanes = std::array<float, n>;
    std::array<double, n> intensity_{};
    std::array<Lanes, 3> centre_{}, axis_{};
    Lanes radius_{};  // of the bounding sphere of the box, metres
    // `back_`: by what the cosine of a direction that leaves from the back counts as one from the front.
    Lanes cos_facing_{}, sin_facing_{}, cos_emission_{}, back_{};
    // Read only where some reach ends.
    bool reach_ends_ = false;
    std::array<Lanes, 3> low_{}, high_{};
    Lanes reach_{};
};

}  // namespace lumel
