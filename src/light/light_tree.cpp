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

float distance_to_box(Vec3 low, Vec3 high, Vec3 p) {
    const auto outside = [](float from, float to, float x) { return std::max({from - x, 0.0f, x - to}); };
    return length(Vec3{outside(low.x, high.x, p.x), outside(low.y, high.y, p.y), outside(low.z, high.z, p.z)});
}

constexpr float kHuge = 1e36f;  // squares of lengths that single precision cannot hold

}  // namespace

PreparedBounds::PreparedBounds(const LightBounds& b)
    : low_(b.low),
      high_(b.high),
      axis_(b.axis),
      cos_facing_(b.cos_facing),
      sin_facing_(sine_of(b.cos_facing)),
      cos_emission_(b.cos_emission),
      reach_(b.reach),
      intensity_(b.intensity),
      both_sides_(b.both_sides) {
    const Vec3 half = (b.high - b.low) * 0.5f;
    centre_ = b.low + half;
    radius_squared_ = std::min(dot(half, half), kHuge);
}

double PreparedBounds::importance(const Receiver& receiver) const {
    return importance_in<false>({receiver.position, receiver.normal});
}

double PreparedBounds::importance(const ReceiverRegion& region) const { return importance_in<true>(region); }

// From anywhere in a region the directions to a box are those from its centre to a box that is larger by its radius.
template <bool is_region>
double PreparedBounds::importance_in(const ReceiverRegion& region) const {
    if (!(intensity_ > 0.0)) return 0.0;
    if (reach_ < std::numeric_limits<float>::infinity() &&
        distance_to_box(low_, high_, region.centre) > reach_ + region.radius)
        return 0.0;
    const Vec3 to_light = centre_ - region.centre;
    const float distance_squared = std::clamp(dot(to_light, to_light), std::numeric_limits<float>::min(), kHuge);
    float radius_squared = radius_squared_;
    if constexpr (is_region) {
        const float radius = std::sqrt(radius_squared_) + region.radius;
        radius_squared = std::min(radius * radius, kHuge);
    }
    float share = 1.0f;
    if (distance_squared > radius_squared) {  // else the receiver is within the box, or nearly
        const float inverse_square = 1.0f / distance_squared;
        const Vec3 direction = to_light * std::sqrt(inverse_square);
        // What the box hides of the sky, at most: half angle of its bounding sphere.
        const float sine_squared = radius_squared * inverse_square;
        const Angle box{safe_sqrt(1.0f - sine_squared), std::sqrt(sine_squared)};
        const float arriving = dot(direction, region.axis);
        Angle from_normal = minus({arriving, sine_of(arriving)}, box);
        if constexpr (is_region) from_normal = minus(from_normal, {region.cos_normals, sine_of(region.cos_normals)});
        const float cosine = from_normal.cosine;
        if (cosine <= 0.0f) return 0.0;
        share = kGrazing + (1.0f - kGrazing) * cosine;
        if (cos_facing_ > -1.0f) {
            float leaving = -dot(direction, axis_);
            if (both_sides_) leaving = std::fabs(leaving);
            const Angle from_cone = minus({leaving, sine_of(leaving)}, {cos_facing_, sin_facing_});
            const float emission = minus(from_cone, box).cosine;
            if (emission <= cos_emission_) return 0.0;
            share *= emission;
        }
    }
    // Within its own size a light is not nearer than that.
    return intensity_ * double{share} / double{std::max(distance_squared, radius_squared)};
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
            tree_.nodes_[index].bounds = PreparedBounds(lights_[light]);
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
        node.bounds = PreparedBounds(group.bounds());
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
    const double a = first.bounds.importance(receiver), b = second.bounds.importance(receiver);
    if (!(b > 0.0)) return {a > 0.0 ? units : 0, 0};
    if (!(a > 0.0)) return {0, units};
    const double free_units = static_cast<double>(units - node.guaranteed);
    const auto share = static_cast<std::uint32_t>(std::min(1.0, a / (a + b)) * free_units + 0.5);
    return {first.guaranteed + share, units - first.guaranteed - share};
}

// A tree of one light has no node that asks for its importance.
bool LightTree::reaches(const Receiver& receiver) const {
    return !nodes_.empty() && (nodes_[0].light == kNoLight || nodes_[0].bounds.importance(receiver) > 0.0);
}

LightTree::Chosen LightTree::choose(const Receiver& receiver, float u) const {
    if (!reaches(receiver)) return {};
    return choose_in({}, unit_of(u), kUnits, receiver);
}

std::uint32_t LightTree::units_of(const Receiver& receiver, std::uint32_t light) const {
    return reaches(receiver) ? units_in({}, kUnits, receiver, light) : 0;
}

LightTree::Chosen LightTree::choose_in(const Subtree& group, std::uint32_t unit, std::uint32_t units,
                                       const Receiver& receiver) const {
    std::uint32_t index = group.node;
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

std::uint32_t LightTree::units_in(const Subtree& group, std::uint32_t units, const Receiver& receiver,
                                  std::uint32_t light) const {
    std::uint64_t trail = trail_[light] >> group.depth;
    std::uint32_t index = group.node;
    for (; nodes_[index].light == kNoLight && units > 0; trail >>= 1) {
        const auto [first, second] = shares(index, units, receiver);
        const bool to_second = (trail & 1u) != 0;
        units = to_second ? second : first;
        index = to_second ? nodes_[index].second : index + 1;
    }
    return nodes_[index].light == light ? units : 0;
}

double LightTree::importance_of(const Subtree& group, const ReceiverRegion& region) const {
    return nodes_[group.node].bounds.importance(region);
}

std::vector<LightTree::Subtree> LightTree::groups(std::size_t most) const {
    std::vector<Subtree> out;
    if (nodes_.empty()) return out;
    out.push_back({0, 0, nodes_[0].guaranteed});
    while (out.size() < most) {
        std::size_t brightest = out.size();
        for (std::size_t i = 0; i < out.size(); ++i)
            if (nodes_[out[i].node].light == kNoLight &&
                (brightest == out.size() ||
                 nodes_[out[i].node].bounds.intensity() > nodes_[out[brightest].node].bounds.intensity()))
                brightest = i;
        if (brightest == out.size()) break;  // each is one light
        const Subtree whole = out[brightest];
        const std::uint32_t first = whole.node + 1, second = nodes_[whole.node].second;
        out[brightest] = {first, whole.depth + 1, nodes_[first].guaranteed};
        out.push_back({second, whole.depth + 1, nodes_[second].guaranteed});
    }
    std::ranges::sort(out, {}, &Subtree::node);
    return out;
}

std::vector<std::uint32_t> LightTree::group_of_lights(std::span<const Subtree> groups) const {
    std::vector<std::uint32_t> out(trail_.size(), kNoLight);
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
        std::vector<std::uint32_t> below{groups[g].node};
        while (!below.empty()) {
            const std::uint32_t index = below.back();
            below.pop_back();
            if (nodes_[index].light != kNoLight) {
                out[nodes_[index].light] = g;
                continue;
            }
            below.push_back(index + 1);
            below.push_back(nodes_[index].second);
        }
    }
    return out;
}

}  // namespace lumel
