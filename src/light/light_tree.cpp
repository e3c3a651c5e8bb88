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

struct Cone {
    Vec3 axis;
    float cosine;
};

// The smallest cone around both; a little wider, so that rounding cannot cut anything off.
Cone enclose(Cone a, Cone b) {
    constexpr Cone kAll{{0, 0, 1}, -1.0f};
    constexpr float kMargin = 1e-6f;
    if (a.cosine <= -1.0f || b.cosine <= -1.0f) return kAll;
    if (a.cosine > b.cosine) std::swap(a, b);  // a is the wider one
    const double wide = angle_of(a.cosine), narrow = angle_of(b.cosine);
    const double between = angle_of(dot(a.axis, b.axis));
    if (std::min(between + narrow, double{kPi}) <= wide) return a;
    const double half = 0.5 * (wide + between + narrow);
    const Vec3 aside = b.axis - a.axis * dot(a.axis, b.axis);
    if (half >= double{kPi} || !(length(aside) > 1e-6f)) return kAll;
    const SinCosDouble turn = sincos_radians(half - wide);
    const Vec3 axis =
        normalize(a.axis * static_cast<float>(turn.cosine) + normalize(aside) * static_cast<float>(turn.sine));
    return {axis, std::max(-1.0f, static_cast<float>(sincos_radians(half).cosine) - kMargin)};
}

LightBounds enclose(const LightBounds& a, const LightBounds& b) {
    if (!(a.intensity > 0.0)) return b;
    if (!(b.intensity > 0.0)) return a;
    LightBounds out;
    for (std::size_t c = 0; c < 3; ++c) {
        out.low[c] = std::min(a.low[c], b.low[c]);
        out.high[c] = std::max(a.high[c], b.high[c]);
    }
    const Cone cone = enclose(Cone{a.axis, a.cos_facing}, Cone{b.axis, b.cos_facing});
    out.axis = cone.axis;
    out.cos_facing = cone.cosine;
    out.cos_emission = std::min(a.cos_emission, b.cos_emission);
    out.intensity = a.intensity + b.intensity;
    out.reach = std::max(a.reach, b.reach);
    out.both_sides = a.both_sides || b.both_sides;
    return out;
}

// Conty Estevez and Kulla 2018, equation 1: directions that the group shines in.
double orientation_measure(const LightBounds& b) {
    const double facing = angle_of(b.cos_facing);
    const double whole = std::min(facing + angle_of(b.cos_emission), double{kPi});
    const SinCosDouble f = sincos_radians(facing);
    return 2.0 * double{kPi} * (1.0 - f.cosine) +
           0.5 * double{kPi} *
               (2.0 * whole * f.sine - sincos_radians(facing - 2.0 * whole).cosine - 2.0 * facing * f.sine + f.cosine);
}

double extent_measure(const LightBounds& b) {
    const Vec3 d = b.high - b.low;
    // Rows of lights have no area; they are long all the same.
    constexpr double kThin = 1e-3;
    return 2.0 * (double{d.x} * d.y + double{d.y} * d.z + double{d.z} * d.x) + kThin * double{dot(d, d)};
}

}  // namespace

class LightTree::Builder {
public:
    Builder(std::span<const LightBounds> lights, LightTree& tree) : lights_(lights), tree_(tree) {
        for (std::uint32_t i = 0; i < lights.size(); ++i)
            if (lights[i].intensity > 0.0) order_.push_back(i);
        tree_.trail_.assign(lights.size(), 0);
        if (!order_.empty()) build(0, order_.size(), 0, 0);
    }

private:
    static constexpr std::size_t kBuckets = 12;
    static constexpr std::uint32_t kBalancedFrom = 32;  // depth; halving from there on stays within the trail's 64 bits

    void build(std::size_t begin, std::size_t end, std::uint64_t trail, std::uint32_t depth) {
        LUMEL_CHECK(depth < 64, depth);
        const std::size_t index = tree_.nodes_.size();
        tree_.nodes_.emplace_back();
        if (end - begin == 1) {
            const std::uint32_t light = order_[begin];
            tree_.nodes_[index].bounds = lights_[light];
            tree_.nodes_[index].light = light;
            tree_.nodes_[index].guaranteed = lights_[light].must_be_sampled ? 1 : 0;
            tree_.trail_[light] = trail;
            return;
        }
        const std::size_t middle = split(begin, end, depth);
        build(begin, middle, trail, depth + 1);
        const auto second = static_cast<std::uint32_t>(tree_.nodes_.size());
        build(middle, end, trail | (std::uint64_t{1} << depth), depth + 1);
        Node& node = tree_.nodes_[index];
        const Node &a = tree_.nodes_[index + 1], &b = tree_.nodes_[second];
        node.bounds = enclose(a.bounds, b.bounds);
        node.second = second;
        node.guaranteed = a.guaranteed + b.guaranteed;
    }

    [[nodiscard]] Vec3 centre(std::uint32_t light) const { return (lights_[light].low + lights_[light].high) * 0.5f; }

    // Reorders the range; returns where its second part begins.
    std::size_t split(std::size_t begin, std::size_t end, std::uint32_t depth) {
        const auto range = std::span(order_).subspan(begin, end - begin);
        Vec3 low = centre(range[0]), high = low;
        LightBounds all;
        for (const std::uint32_t light : range) {
            const Vec3 c = centre(light);
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], c[k]);
                high[k] = std::max(high[k], c[k]);
            }
            all = enclose(all, lights_[light]);
        }
        const auto bucket_of = [&](std::uint32_t light, std::size_t axis) {
            const float t = (centre(light)[axis] - low[axis]) / (high[axis] - low[axis]);
            return std::min(static_cast<std::size_t>(t * static_cast<float>(kBuckets)), kBuckets - 1);
        };
        const Vec3 size = all.high - all.low;
        double best = std::numeric_limits<double>::infinity();
        std::size_t best_axis = 3, best_bucket = 0;
        for (std::size_t axis = 0; axis < 3 && depth < kBalancedFrom; ++axis) {
            if (!(high[axis] > low[axis])) continue;
            std::array<LightBounds, kBuckets> buckets;
            for (const std::uint32_t light : range) {
                LightBounds& bucket = buckets[bucket_of(light, axis)];
                bucket = enclose(bucket, lights_[light]);
            }
            std::array<double, kBuckets> after{};
            LightBounds bounds;
            for (std::size_t k = kBuckets - 1; k > 0; --k) {
                bounds = enclose(bounds, buckets[k]);
                after[k - 1] = cost(bounds);
            }
            const double thin = max_component(size) / std::max(size[axis], std::numeric_limits<float>::min());
            bounds = {};
            for (std::size_t k = 0; k + 1 < kBuckets; ++k) {
                bounds = enclose(bounds, buckets[k]);
                const double total = thin * (cost(bounds) + after[k]);
                if (total < best) {
                    best = total;
                    best_axis = axis;
                    best_bucket = k;
                }
            }
        }
        std::size_t middle = begin;
        if (best_axis < 3) {
            const auto second = std::stable_partition(range.begin(), range.end(), [&](std::uint32_t light) {
                return bucket_of(light, best_axis) <= best_bucket;
            });
            middle = begin + static_cast<std::size_t>(second - range.begin());
        }
        // Lights at one place, or too deep.
        return middle == begin || middle == end ? begin + (end - begin) / 2 : middle;
    }

    static double cost(const LightBounds& b) {
        return b.intensity > 0.0 ? b.intensity * orientation_measure(b) * extent_measure(b) : 0.0;
    }

    std::span<const LightBounds> lights_;
    LightTree& tree_;
    std::vector<std::uint32_t> order_;
};

LightTree::LightTree(std::span<const LightBounds> lights) {
    LUMEL_CHECK(lights.size() < kUnits / 2, lights.size());
    const Builder build(lights, *this);
}

// How many of a node's units its first child gets: by importance, of what those that must be sampled leave over.
std::uint32_t LightTree::first_share(const Node& node, std::uint32_t index, std::uint32_t units,
                                     const Receiver& receiver) const {
    const Node &first = nodes_[index + 1], &second = nodes_[node.second];
    const double a = importance(first.bounds, receiver), b = importance(second.bounds, receiver);
    if (!(b > 0.0)) return a > 0.0 ? units : 0;
    if (!(a > 0.0)) return 0;
    const double free_units = static_cast<double>(units - node.guaranteed);
    const auto share = static_cast<std::uint32_t>(std::min(1.0, a / (a + b)) * free_units + 0.5);
    return first.guaranteed + share;
}

LightTree::Chosen LightTree::choose(const Receiver& receiver, float u) const {
    if (nodes_.empty() || !(importance(nodes_[0].bounds, receiver) > 0.0)) return {};
    auto unit = std::min(static_cast<std::uint32_t>(u * 0x1p24f), kUnits - 1);
    std::uint32_t index = 0, units = kUnits;
    while (nodes_[index].light == kNoLight) {
        const Node& node = nodes_[index];
        const std::uint32_t first = first_share(node, index, units, receiver);
        if (unit < first) {
            units = first;
            index = index + 1;
        } else {
            unit -= first;
            units -= first;
            index = node.second;
            // Neither child lights the receiver, though their common bound may.
            if (first == 0 && !(importance(nodes_[index].bounds, receiver) > 0.0)) return {};
        }
    }
    return {nodes_[index].light, units};
}

std::uint32_t LightTree::units_of(const Receiver& receiver, std::uint32_t light) const {
    if (nodes_.empty() || !(importance(nodes_[0].bounds, receiver) > 0.0)) return 0;
    std::uint64_t trail = trail_[light];
    std::uint32_t index = 0, units = kUnits;
    for (; nodes_[index].light == kNoLight && units > 0; trail >>= 1) {
        const Node& node = nodes_[index];
        const std::uint32_t first = first_share(node, index, units, receiver);
        if ((trail & 1u) == 0) {
            units = first;
            index = index + 1;
        } else {
            units -= first;
            index = node.second;
            if (first == 0 && !(importance(nodes_[index].bounds, receiver) > 0.0)) return 0;
        }
    }
    return nodes_[index].light == light ? units : 0;
}

}  // namespace lumel
