// One texel against the triangles that overlap it: which sample points lie in which triangle, and where.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <span>

#include "texel/texel_buffer.h"
#include "texel/texel_triangle.h"

namespace lumel {

// Position of bit `s` among the bits set in `mask`.
inline std::uint32_t rank(std::uint64_t mask, std::uint32_t s) {
    return static_cast<std::uint32_t>(std::popcount(mask & ((std::uint64_t{1} << s) - 1)));
}

class TexelSamples {
public:
    TexelSamples(std::uint32_t x, std::uint32_t y) : left_(x), top_(y) {}

    // The points of a texel that is covered whole, where it gathers from.
    static TexelSamples gathering(std::uint32_t x, std::uint32_t y) {
        TexelSamples samples(x, y);
        samples.scale_ = double{kGatherFootprint};
        samples.left_ += 0.5 - 0.5 * samples.scale_;
        samples.top_ += 0.5 - 0.5 * samples.scale_;
        return samples;
    }

    // Calls visit(s, barycentrics) for each point of the set `wanted` that lies in the triangle.
    template <class Visit>
    void for_each_inside(const TexelTriangle& triangle, std::uint64_t wanted, Visit&& visit) const {
        for (; wanted != 0; wanted &= wanted - 1) {
            const auto s = static_cast<std::uint32_t>(std::countr_zero(wanted));
            const Vec2 p = subtexel_point(s);
            if (const auto b = triangle.locate(left_ + scale_ * double{p.x}, top_ + scale_ * double{p.y})) visit(s, *b);
        }
    }

    // Which points lie in the triangle.
    [[nodiscard]] std::uint64_t inside(const TexelTriangle& triangle) const {
        constexpr std::uint64_t kAll = ~std::uint64_t{0};
        if (triangle.contains_texel(left_, top_)) return kAll;
        std::uint64_t found = 0;
        for_each_inside(triangle, kAll, [&](std::uint32_t s, Barycentrics) { found |= std::uint64_t{1} << s; });
        return found;
    }

    // The point to stand for a texel that no Hammersley point is valid in. `triangles`: world triangles; uv(t): theirs.
    template <class UvOf>
    [[nodiscard]] SamplePoint middle_of_largest_part(std::span<const std::uint32_t> triangles, UvOf&& uv) const {
        SamplePoint best;
        double largest = -1.0;
        for (const std::uint32_t triangle : triangles) {
            const TexelTriangle::Part part = uv(triangle).part_in(left_, top_);
            if (part.area <= largest) continue;
            largest = part.area;
            best = {triangle, part.middle.b1, part.middle.b2};
        }
        return best;
    }

    // The centre where it lies in a triangle, else the valid point nearest to it, else the middle of the largest part.
    template <class UvOf>
    [[nodiscard]] SamplePoint representative(std::span<const std::uint32_t> triangles, std::uint64_t valid,
                                             UvOf&& uv) const {
        if (const SamplePoint p = first_at({0.5f, 0.5f}, triangles, uv); p.triangle != kNone) return p;
        if (valid == 0) return middle_of_largest_part(triangles, uv);
        return first_at(nearest_to_centre(valid), triangles, uv);
    }

private:
    static Vec2 nearest_to_centre(std::uint64_t valid) {
        Vec2 nearest{};
        float smallest = std::numeric_limits<float>::infinity();
        for (; valid != 0; valid &= valid - 1) {
            const Vec2 p = subtexel_point(static_cast<std::uint32_t>(std::countr_zero(valid)));
            const Vec2 d = p - Vec2{0.5f, 0.5f};
            if (dot(d, d) >= smallest) continue;
            smallest = dot(d, d);
            nearest = p;
        }
        return nearest;
    }

    // The first triangle that has the point, or kNone.
    template <class UvOf>
    [[nodiscard]] SamplePoint first_at(Vec2 p, std::span<const std::uint32_t> triangles, UvOf&& uv) const {
        for (const std::uint32_t triangle : triangles)
            if (const auto b = uv(triangle).locate(left_ + double{p.x}, top_ + double{p.y}))
                return {triangle, b->b1, b->b2};
        return {};
    }

    double left_, top_, scale_ = 1.0;
};

}  // namespace lumel
