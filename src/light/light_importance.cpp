#include "light/light_importance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumel {
namespace {

float safe_sqrt(float x) { return std::sqrt(std::max(0.0f, x)); }
float sine_of(float cosine) { return safe_sqrt(1.0f - cosine * cosine); }

// An angle in [0, pi] by cosine and sine.
struct Angle {
    float cosine, sine;
};

// a - b, or 0 where b is the larger.
Angle minus(Angle a, Angle b) {
    const float cosine = a.cosine * b.cosine + a.sine * b.sine;
    const float sine = std::max(0.0f, a.sine * b.cosine - a.cosine * b.sine);
    const bool is_larger = a.cosine > b.cosine;
    return {is_larger ? 1.0f : cosine, is_larger ? 0.0f : sine};
}

float outside(float low, float high, float x) { return std::max(std::max(low - x, x - high), 0.0f); }

constexpr float kLeastEmission = 1e-6f;
constexpr float kHuge = 1e18f;  // lengths whose squares single precision holds

}  // namespace

template <std::size_t n>
void PreparedBounds<n>::set(std::size_t lane, const LightBounds& b) {
    const Vec3 half = (b.high - b.low) * 0.5f;
    for (std::size_t c = 0; c < 3; ++c) {
        low_[c][lane] = b.low[c];
        high_[c][lane] = b.high[c];
        centre_[c][lane] = b.low[c] + half[c];
        axis_[c][lane] = b.axis[c];
    }
    radius_[lane] = std::min(length(half), kHuge);
    cos_facing_[lane] = b.cos_facing;
    sin_facing_[lane] = sine_of(b.cos_facing);
    // What faces all ways shines all ways.
    cos_emission_[lane] = b.cos_facing > -1.0f ? b.cos_emission : -1.0f;
    back_[lane] = b.both_sides ? -1.0f : 1.0f;
    reach_[lane] = b.reach;
    reach_ends_ = reach_ends_ || b.reach < std::numeric_limits<float>::infinity();
    intensity_[lane] = std::max(0.0, b.intensity);
}

template <std::size_t n>
std::array<double, n> PreparedBounds<n>::importance(const Receiver& receiver) const {
    return importance_in<false>({receiver.position, receiver.normal});
}

template <std::size_t n>
std::array<double, n> PreparedBounds<n>::importance(const ReceiverRegion& region) const {
    return importance_in<true>(region);
}

// From anywhere in a region the directions to a box are those from its centre to a box that is larger by its radius.
// Without branches, so that the compiler computes lanes side by side.
template <std::size_t n>
template <bool is_region>
std::array<double, n> PreparedBounds<n>::importance_in(const ReceiverRegion& region) const {
    const Vec3 from = region.centre, normal = region.axis;
    const Angle normals{region.cos_normals, is_region ? sine_of(region.cos_normals) : 0.0f};
    Lanes share, nearest;
    for (std::size_t i = 0; i < n; ++i) {
        const float x = centre_[0][i] - from.x, y = centre_[1][i] - from.y, z = centre_[2][i] - from.z;
        const float squared = x * x + y * y + z * z;
        const float distance_squared = std::min(std::max(squared, std::numeric_limits<float>::min()), kHuge * kHuge);
        const float radius = is_region ? std::min(radius_[i] + region.radius, kHuge) : radius_[i];
        const float inverse = 1.0f / std::sqrt(distance_squared);
        // What the box hides of the sky, at most: half angle of its bounding sphere.
        const float sine = std::min(1.0f, radius * inverse);
        const Angle box{std::sqrt(1.0f - sine * sine), sine};
        const float arriving = (x * normal.x + y * normal.y + z * normal.z) * inverse;
        Angle from_normal = minus({arriving, sine_of(arriving)}, box);
        if (is_region) from_normal = minus(from_normal, normals);
        const float leaving = -(x * axis_[0][i] + y * axis_[1][i] + z * axis_[2][i]) * inverse;
        const float from_front = std::max(leaving, leaving * back_[i]);
        const Angle from_cone = minus({from_front, sine_of(from_front)}, {cos_facing_[i], sin_facing_[i]});
        const float emission = minus(from_cone, box).cosine;
        const float cosine = from_normal.cosine;
        // Bounds of several lights are a rounding wider than what they hold: on their rim the cosine is below zero, and
        // a light there might shine all the same.
        float seen = (kGrazing + (1.0f - kGrazing) * cosine) * std::max(emission, kLeastEmission);
        seen = cosine > 0.0f ? seen : 0.0f;
        seen = emission > cos_emission_[i] ? seen : 0.0f;
        // Within the box, or nearly, light comes from everywhere; and it is not nearer than the box is large.
        share[i] = sine < 1.0f ? seen : 1.0f;
        nearest[i] = std::max(distance_squared, radius * radius);
    }
    if (reach_ends_)
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 away{outside(low_[0][i], high_[0][i], from.x), outside(low_[1][i], high_[1][i], from.y),
                            outside(low_[2][i], high_[2][i], from.z)};
            if (length(away) > reach_[i] + region.radius) share[i] = 0.0f;
        }
    std::array<double, n> out;
    for (std::size_t i = 0; i < n; ++i) out[i] = intensity_[i] * double{share[i]} / double{nearest[i]};
    return out;
}

template class PreparedBounds<1>;
template class PreparedBounds<8>;

}  // namespace lumel
