#include "light/light_tree_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "math/constants.h"
#include "math/discrete.h"
#include "math/trig.h"

namespace lumel {
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

class Builder {
public:
    Builder(std::span<const LightBounds> lights, std::vector<BinaryLightNode>& nodes) : lights_(lights), nodes_(nodes) {
        groups_.reserve(lights.size());
        std::size_t guaranteed = 0;
        for (std::uint32_t i = 0; i < lights.size(); ++i) {
            groups_.emplace_back(lights[i]);
            if (!(lights[i].intensity > 0.0)) continue;
            order_.push_back(i);
            guaranteed += lights[i].must_be_sampled ? 1 : 0;
        }
        LUMEL_CHECK(guaranteed < kUnits / 2, guaranteed);
        if (order_.empty()) return;
        nodes_.reserve(2 * order_.size() - 1);
        build(0, order_.size(), 0);
    }

private:
    static constexpr std::size_t kBuckets = 12;
    static constexpr std::uint32_t kBalancedFrom =
        32;  // depth; halving from there on stays within kMostLightTreeLevels

    // Returns all lights of the range as one.
    Group build(std::size_t begin, std::size_t end, std::uint32_t depth) {
        LUMEL_CHECK(depth < kMostLightTreeLevels, depth);
        const std::size_t index = nodes_.size();
        nodes_.emplace_back();
        if (end - begin == 1) {
            const std::uint32_t light = order_[begin];
            nodes_[index].bounds = lights_[light];
            nodes_[index].light = light;
            nodes_[index].guaranteed = lights_[light].must_be_sampled ? 1 : 0;
            return groups_[light];
        }
        const std::size_t middle = split(begin, end, depth);
        Group group = build(begin, middle, depth + 1);
        const auto second = static_cast<std::uint32_t>(nodes_.size());
        group.add(build(middle, end, depth + 1));
        BinaryLightNode& node = nodes_[index];
        node.bounds = group.bounds();
        node.second = second;
        node.guaranteed = nodes_[index + 1].guaranteed + nodes_[second].guaranteed;
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
    std::vector<BinaryLightNode>& nodes_;
    std::vector<Group> groups_;  // of each light
    std::vector<std::uint32_t> order_;
};

}  // namespace

std::vector<BinaryLightNode> build_light_tree(std::span<const LightBounds> lights) {
    std::vector<BinaryLightNode> nodes;
    const Builder build(lights, nodes);
    return nodes;
}

std::vector<std::uint32_t> divide_brightest(std::span<const BinaryLightNode> nodes, std::uint32_t root,
                                            std::size_t most, std::span<const std::uint32_t> whole) {
    std::vector<std::uint32_t> parts{root};
    while (parts.size() < most) {
        const BinaryLightNode* brightest = nullptr;
        std::size_t place = 0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const BinaryLightNode& node = nodes[parts[i]];
            if (node.is_leaf() || std::ranges::binary_search(whole, parts[i])) continue;
            if (brightest && node.bounds.intensity <= brightest->bounds.intensity) continue;
            brightest = &node;
            place = i;
        }
        if (!brightest) break;
        parts.push_back(brightest->second);
        ++parts[place];  // the first child
    }
    std::ranges::sort(parts);
    return parts;
}

}  // namespace lumel
