// Random numbers of the peer integrator (flux_integrator.h): Halton points with a random rotation per texel, or Lumel's
// own points for comparison.
// Based on: Halton 1964; Cranley and Patterson 1976 (the rotation); O'Donnell 2018 (where it is used so).
#pragma once

#include <cstdint>
#include <vector>

#include "lumel/vec.h"
#include "math/sampler.h"

namespace lumel::bench {

enum class FluxPoints : std::uint8_t {
    halton,  // rotated
    sobol    // Lumel's: Owen-scrambled, even and odd samples a set each
};

// The digits of `index` in the given base, mirrored at the point.
float radical_inverse(std::uint32_t base, std::uint32_t index);

// The first vertices of a path take dimensions of a Halton sequence, five each: direction (2), choice of a light, point
// on it (2). The next ones would get bases so large that their points fall on lines: they get independent numbers.
class HaltonTable {
public:
    static constexpr std::uint32_t kPerVertex = 5, kVertices = 2, kDimensions = kPerVertex * kVertices;
    explicit HaltonTable(std::uint32_t samples);
    [[nodiscard]] float at(std::uint32_t sample, std::uint32_t dimension) const {
        return values_[std::size_t{sample} * kDimensions + dimension];
    }

private:
    std::vector<float> values_;
};

// Of one path. `key`: the texel; `index`: the sample in it.
class FluxNumbers {
public:
    FluxNumbers(const HaltonTable& table, FluxPoints points, std::uint32_t key, std::uint32_t index)
        : table_(table), points_(points), key_(key), index_(index) {}

    [[nodiscard]] Vec2 direction(std::uint32_t vertex) const { return pair(vertex, 0, 0); }
    [[nodiscard]] float light_choice(std::uint32_t vertex) const { return one(vertex); }
    // `which`: of several samples at one vertex; each turns the points by another angle.
    [[nodiscard]] Vec2 on_light(std::uint32_t vertex, std::uint32_t which) const { return pair(vertex, 3, which); }
    [[nodiscard]] float roulette(std::uint32_t vertex) const;
    [[nodiscard]] float origin() const { return independent(0, 6, 0); }

private:
    static std::uint32_t salt_of(std::uint32_t vertex, std::uint32_t use, std::uint32_t which) {
        return (which * 0x10000u + vertex) * 8u + use;
    }
    [[nodiscard]] float independent(std::uint32_t vertex, std::uint32_t use, std::uint32_t which) const {
        return unit_float(Sampler(key_, index_).hash(salt_of(vertex, use, which)));
    }
    [[nodiscard]] float rotated(std::uint32_t vertex, std::uint32_t use, std::uint32_t which) const;
    [[nodiscard]] Vec2 pair(std::uint32_t vertex, std::uint32_t use, std::uint32_t which) const;
    [[nodiscard]] float one(std::uint32_t vertex) const;

    const HaltonTable& table_;
    FluxPoints points_;
    std::uint32_t key_, index_;
};

}  // namespace lumel::bench
