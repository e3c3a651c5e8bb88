#include "light/light_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "math/constants.h"
#include "math/discrete.h"
#include "math/trig.h"

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
    if (a.cosine > b.cosine) return {1.0f, 0.0f};
    return {a.cosine * b.cosine + a.sine * b.sine, std::max(0.0f, a.sine * b.cosine - a.cosine * b.sine)};
}

// What the box hides of the sky, at most: half angle of its bounding sphere.
Angle half_angle(float radius_squared, float distance_squared) {
    if (distance_squared <= radius_squared) return {-1.0f, 0.0f};
    const float sine_squared = radius_squared / distance_squared;
    return {safe_sqrt(1.0f - sine_squared), safe_sqrt(sine_squared)};
}

float distance_to_box(const LightBounds& b, Vec3 p) {
    const auto outside = [](float low, float high, float x) { return std::max({low - x, 0.0f, x - high}); };
    return length(
        Vec3{outside(b.low.x, b.high.x, p.x), outside(b.low.y, b.high.y, p.y), outside(b.low.z, b.high.z, p.z)});
}

// Of the surface's cosine: light along the surface counts in radiance, if not in irradiance.
constexpr float kGrazing = 0.25f;

}  // namespace

double importance(const LightBounds& b, const Receiver& receiver) {
    if (!(b.intensity > 0.0)) return 0.0;
    if (b.reach < std::numeric_limits<float>::infinity() && distance_to_box(b, receiver.position) > b.reach) return 0.0;
    const Vec3 half = (b.high - b.low) * 0.5f;
    const Vec3 to_light = b.low + half - receiver.position;
    constexpr float kHuge = 1e36f;  // squares of lengths that single precision cannot hold
    const float radius_squared = std::min(dot(half, half), kHuge);
    const float distance_squared = std::min(dot(to_light, to_light), kHuge);
    const Angle box = half_angle(radius_squared, distance_squared);
    float share = 1.0f;
    if (box.cosine > -1.0f) {
        const Vec3 direction = to_light * (1.0f / std::sqrt(distance_squared));
        const float arriving = dot(direction, receiver.normal);
        const float cosine = minus({arriving, sine_of(arriving)}, box).cosine;
        if (cosine <= 0.0f) return 0.0;
        share = kGrazing + (1.0f - kGrazing) * cosine;
        if (b.cos_facing > -1.0f) {
            float leaving = -dot(direction, b.axis);
            if (b.both_sides) leaving = std::fabs(leaving);
            const Angle from_cone = minus({leaving, sine_of(leaving)}, {b.cos_facing, sine_of(b.cos_facing)});
            const float emission = minus(from_cone, box).cosine;
            if (emission <= b.cos_emission) return 0.0;
            share *= emission;
        }
    }
    // Within its own size a light is not nearer than that.
    const float least = std::numeric_limits<float>::min();
    return b.intensity * double{share} / double{std::max({distance_squared, radius_squared, least})};
}

namespace {

double angle_of(float cosine) { return arccosine(std::clamp(double{cosine}, -1.0, 1.0)); }

// Angle between unit vectors; exact to rounding where they are nearly parallel, too.
double angle_between(Vec3 a, Vec3 b) {
    const double ax = a.x, ay = a.y, az = a.z, bx = b.x, by = b.y, bz = b.z;
    const double x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    return arctangent2(std::sqrt(x * x + y * y + z * z), ax * bx + ay * by + az * bz);
}

struct Cone {
    Vec3 axis{0, 0, 1};
    double half = 0.0;  // angle; pi: all directions
};

// The smallest cone around both, or a little more.
Cone enclose(Cone a, Cone b) {
    constexpr double kPiDouble{kPi};
    if (a.half >= kPiDouble || b.half >= kPiDouble) return {{0, 0, 1}, kPiDouble};
    if (a.half < b.half) std::swap(a, b);
    if (a.axis == b.axis) return a;
    const double between = angle_between(a.axis, b.axis);
    if (between + b.half <= a.half) return a;
    const double half = 0.5 * (a.half + between + b.half);
    if (half >= kPiDouble) return {{0, 0, 1}, kPiDouble};
    const Vec3 aside = normalize_or(b.axis - a.axis * dot(a.axis, b.axis), {});
    // So close together that rounding decides which way to turn: stay, and open wider.
    constexpr double kClose = 1e-3;
    if (between < kClose || kPiDouble - between < kClose || aside == Vec3{})
        return {a.axis, std::min(kPiDouble, between + b.half)};
    const SinCosDouble turn = sincos_radians(half - a.half);
    const Vec3 axis = a.axis * static_cast<float>(turn.cosine) + aside * static_cast<float>(turn.sine);
    constexpr double kRounding = 1e-6;  // of the axis
    return {normalize(axis), std::min(kPiDouble, half + kRounding)};
}

// LightBounds with their cone as an angle, for the many unions of a build.
struct Group {
    Vec3 low{}, high{};
    Cone facing;
    double emission = 0.0;  // angle
    double intensity = 0.0;
    float reach = 0.0f;
    bool both_sides = false;

    Group() = default;
    explicit Group(const LightBounds& b)
        : low(b.low),
          high(b.high),
          facing{b.axis, b.cos_facing <= -1.0f ? double{kPi} : angle_of(b.cos_facing)},
          emission(angle_of(b.cos_emission)),
          intensity(b.intensity),
          reach(b.reach),
          both_sides(b.both_sides) {}

    void add(const Group& other) {
        if (!(other.intensity > 0.0)) return;
        if (!(intensity > 0.0)) {
            *this = other;
            return;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], other.low[c]);
            high[c] = std::max(high[c], other.high[c]);
        }
        facing = enclose(facing, other.facing);
        emission = std::max(emission, other.emission);
        intensity += other.intensity;
        reach = std::max(reach, other.reach);
        both_sides = both_sides || other.both_sides;
    }

    [[nodiscard]] LightBounds bounds() const {
        constexpr float kRounding = 1e-6f;
        const auto wider = [](double angle) {
            return std::max(-1.0f, static_cast<float>(sincos_radians(angle).cosine) - kRounding);
        };
        LightBounds b;
        b.low = low;
        b.high = high;
        b.axis = facing.axis;
        b.cos_facing = facing.half >= double{kPi} ? -1.0f : wider(facing.half);
        b.cos_emission = wider(emission);
        b.intensity = intensity;
        b.reach = reach;
        b.both_sides = both_sides;
        return b;
    }

    // Conty Estevez and Kulla 2018, equation 1: directions that the group shines in.
    [[nodiscard]] double orientation_measure() const {
        const double whole = std::min(facing.half + emission, double{kPi});
        const SinCosDouble f = sincos_radians(facing.half);
        return 2.0 * double{kPi} * (1.0 - f.cosine) +
               0.5 * double{kPi} *
                   (2.0 * whole * f.sine - sincos_radians(facing.half - 2.0 * whole).cosine -
                    2.0 * facing.half * f.sine + f.cosine);
    }

    [[nodiscard]] double extent_measure() const {
        const double x = double{high.x} - low.x, y = double{high.y} - low.y, z = double{high.z} - low.z;
        // Rows of lights have no area; they are long all the same.
        constexpr double kThin = 1e-3;
        return 2.0 * (x * y + y * z + z * x) + kThin * (x * x + y * y + z * z);
    }

    // What the part of a split with these lights costs.
    [[nodiscard]] double cost() const {
        return intensity > 0.0 ? intensity * orientation_measure() * extent_measure() : 0.0;
    }
};

}  // namespace

class LightTree::Builder {
public:
    Builder(std::span<const LightBounds> lights, LightTree& tree) : lights_(lights), tree_(tree) {
        groups_.reserve(lights.size());
        std::size_t guaranteed = 0;
        for (std::uint32_t i = 0; i < lights.size(); ++i) {
            groups_.emplace_back(lights[i]);
            if (!(lights[i].intensity > 0.0)) continue;
            order_.push_back(i);
            guaranteed += lights[i].must_be_sampled ? 1 : 0;
        }
        LUMEL_CHECK(guaranteed < kUnits / 2, guaranteed);
        tree_.trail_.assign(lights.size(), 0);
        if (order_.empty()) return;
        tree_.nodes_.reserve(2 * order_.size() - 1);
        build(0, order_.size(), 0, 0);
    }

private:
    static constexpr std::size_t kBuckets = 12;
    static constexpr std::uint32_t kBalancedFrom = 32;  // depth; halving from there on stays within the trail's 64 bits

    // Returns all lights of the range as one.
    Group build(std::size_t begin, std::size_t end, std::uint64_t trail, std::uint32_t depth) {
        LUMEL_CHECK(depth < 64, depth);
        const std::size_t index = tree_.nodes_.size();
        tree_.nodes_.emplace_back();
        if (end - begin == 1) {
            const std::uint32_t light = order_[begin];
            tree_.nodes_[index].bounds = lights_[light];
            tree_.nodes_[index].light = light;
            tree_.nodes_[index].guaranteed = lights_[light].must_be_sampled ? 1 : 0;
            tree_.trail_[light] = trail;
            return groups_[light];
        }
        const std::size_t middle = split(begin, end, depth);
        Group group = build(begin, middle, trail, depth + 1);
        const auto second = static_cast<std::uint32_t>(tree_.nodes_.size());
        group.add(build(middle, end, trail | (std::uint64_t{1} << depth), depth + 1));
        Node& node = tree_.nodes_[index];
        node.bounds = group.bounds();
        node.second = second;
        node.guaranteed = tree_.nodes_[index + 1].guaranteed + tree_.nodes_[second].guaranteed;
        return group;
    }

    [[nodiscard]] float centre(std::uint32_t light, std::size_t axis) const {
        return 0.5f * lights_[light].low[axis] + 0.5f * lights_[light].high[axis];
    }

    struct Split {
        double cost = std::numeric_limits<double>::infinity();
        std::size_t axis = 3, bucket = 0;  // 3: none
    };

    // By the centres' place between `low` and `low + size`.
    [[nodiscard]] std::size_t bucket_of(std::uint32_t light, std::size_t axis, float low, float size) const {
        const float t = (centre(light, axis) - low) / size * static_cast<float>(kBuckets);
        return t > 0.0f ? std::min(static_cast<std::size_t>(std::min(t, float{kBuckets})), kBuckets - 1) : 0;
    }

    [[nodiscard]] Split best_along(std::size_t axis, std::span<const std::uint32_t> range, float low,
                                   float size) const {
        std::array<Group, kBuckets> buckets;
        Group all;
        for (const std::uint32_t light : range) buckets[bucket_of(light, axis, low, size)].add(groups_[light]);
        std::array<double, kBuckets> after{};
        for (std::size_t k = kBuckets - 1; k > 0; --k) {
            all.add(buckets[k]);
            after[k - 1] = all.cost();
        }
        all.add(buckets[0]);
        const Vec3 extent = all.high - all.low;
        const double thin = max_component(extent) / std::max(extent[axis], std::numeric_limits<float>::min());
        Split best;
        Group before;
        for (std::size_t k = 0; k + 1 < kBuckets; ++k) {
            before.add(buckets[k]);
            const double cost = thin * (before.cost() + after[k]);
            if (cost < best.cost) best = {cost, axis, k};
        }
        return best;
    }

    // Reorders the range; returns where its second part begins.
    std::size_t split(std::size_t begin, std::size_t end, std::uint32_t depth) {
        const auto range = std::span(order_).subspan(begin, end - begin);
        Vec3 low{}, size{};
        Split best;
        for (std::size_t axis = 0; axis < 3 && depth < kBalancedFrom; ++axis) {
            float high = low[axis] = centre(range[0], axis);
            for (const std::uint32_t light : range) {
                low[axis] = std::min(low[axis], centre(light, axis));
                high = std::max(high, centre(light, axis));
            }
            size[axis] = high - low[axis];
            if (!(size[axis] > 0.0f) || !std::isfinite(size[axis])) continue;
            const Split along = best_along(axis, range, low[axis], size[axis]);
            if (along.cost < best.cost) best = along;
        }
        std::size_t middle = begin;
        if (best.axis < 3) {
            const auto second = std::stable_partition(range.begin(), range.end(), [&](std::uint32_t light) {
                return bucket_of(light, best.axis, low[best.axis], size[best.axis]) <= best.bucket;
            });
            middle = begin + static_cast<std::size_t>(second - range.begin());
        }
        // Lights at one place, or too deep.
        return middle == begin || middle == end ? begin + (end - begin) / 2 : middle;
    }

    std::span<const LightBounds> lights_;
    LightTree& tree_;
    std::vector<Group> groups_;  // of each light
    std::vector<std::uint32_t> order_;
};

LightTree::LightTree(std::span<const LightBounds> lights) { const Builder build(lights, *this); }

// By importance, of what those that must be sampled leave over.
LightTree::Shares LightTree::shares(std::uint32_t index, std::uint32_t units, const Receiver& receiver) const {
    const Node& node = nodes_[index];
    const Node &first = nodes_[index + 1], &second = nodes_[node.second];
    const double a = importance(first.bounds, receiver), b = importance(second.bounds, receiver);
    if (!(b > 0.0)) return {a > 0.0 ? units : 0, 0};
    if (!(a > 0.0)) return {0, units};
    const double free_units = static_cast<double>(units - node.guaranteed);
    const auto share = static_cast<std::uint32_t>(std::min(1.0, a / (a + b)) * free_units + 0.5);
    return {first.guaranteed + share, units - first.guaranteed - share};
}

// A tree of one light has no node that asks for its importance.
bool LightTree::reaches(const Receiver& receiver) const {
    return !nodes_.empty() && (nodes_[0].light == kNoLight || importance(nodes_[0].bounds, receiver) > 0.0);
}

LightTree::Chosen LightTree::choose(const Receiver& receiver, float u) const {
    if (!reaches(receiver)) return {};
    auto unit = std::min(static_cast<std::uint32_t>(u * 0x1p24f), kUnits - 1);
    std::uint32_t index = 0, units = kUnits;
    while (nodes_[index].light == kNoLight) {
        const auto [first, second] = shares(index, units, receiver);
        if (first + second == 0) return {};  // though their common bound may light the receiver
        if (unit < first) {
            units = first;
            index = index + 1;
        } else {
            unit -= first;
            units = second;
            index = nodes_[index].second;
        }
    }
    return {nodes_[index].light, units};
}

std::uint32_t LightTree::units_of(const Receiver& receiver, std::uint32_t light) const {
    if (!reaches(receiver)) return 0;
    std::uint64_t trail = trail_[light];
    std::uint32_t index = 0, units = kUnits;
    for (; nodes_[index].light == kNoLight && units > 0; trail >>= 1) {
        const auto [first, second] = shares(index, units, receiver);
        const bool to_second = (trail & 1u) != 0;
        units = to_second ? second : first;
        index = to_second ? nodes_[index].second : index + 1;
    }
    return nodes_[index].light == light ? units : 0;
}

}  // namespace lumel
