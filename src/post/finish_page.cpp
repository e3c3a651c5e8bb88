#include <array>
#include <cstddef>

#include "base/check.h"
#include "post/lightmap.h"

namespace lumel {
namespace {

constexpr std::array<std::array<int, 2>, 8> kNeighbours{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

// Calls visit(texel) for the 3x3 neighbours of pixel (x, y) that exist in the lightmap.
template <class Visit>
void for_each_neighbour(const Lightmap& map, std::uint32_t x, std::uint32_t y, Visit&& visit) {
    for (const auto& [dx, dy] : kNeighbours) {
        const std::int64_t nx = std::int64_t{x} + dx;
        const std::int64_t ny = std::int64_t{y} + dy;
        if (nx < 0 || ny < 0 || nx >= map.width || ny >= map.height) continue;
        const std::uint32_t texel = map.texel_at[static_cast<std::size_t>(ny) * map.width + static_cast<std::size_t>(nx)];
        if (texel != kNone) visit(texel);
    }
}

// Mean of several texels, written over `target`. Sample counts are not averaged: a filled texel was not sampled.
class Average {
public:
    void add(const RadianceSums& from, std::size_t i) {
        ++n_;
        for (std::size_t l = 0; l < kLayerCount; ++l) {
            for (std::size_t k = 0; k < kShCoefficients; ++k) layers_[l].sh[k] += from.layers[i][l].sh[k];
            layers_[l].irradiance += from.layers[i][l].irradiance;
        }
        variance_ += from.variance[i];
        bent_ += from.bent_normal[i];
        sky_ += from.sky_visibility[i];
        occlusion_ += from.ambient_occlusion[i];
    }
    [[nodiscard]] bool empty() const { return n_ == 0; }
    void store(RadianceSums& to, std::size_t i) const {
        const float s = 1.0f / static_cast<float>(n_);
        for (std::size_t l = 0; l < kLayerCount; ++l) {
            for (std::size_t k = 0; k < kShCoefficients; ++k) to.layers[i][l].sh[k] = layers_[l].sh[k] * s;
            to.layers[i][l].irradiance = layers_[l].irradiance * s;
        }
        to.variance[i] = variance_ * s;
        to.bent_normal[i] = bent_ * s;
        to.sky_visibility[i] = sky_ * s;
        to.ambient_occlusion[i] = occlusion_ * s;
    }

private:
    std::uint32_t n_ = 0;
    std::array<LayerMoments, kLayerCount> layers_{};
    Vec3 variance_{}, bent_{};
    float sky_ = 0.0f, occlusion_ = 0.0f;
};

struct Pixel {
    std::uint32_t x, y;
};

// Gives each candidate that has a usable 3x3 neighbour the mean of those, all at once (the order does not matter), and
// stores it in texel place(candidate index).
template <class Usable, class Place>
void average_ring(Lightmap& map, const std::vector<Pixel>& candidates, Usable&& usable, Place&& place) {
    std::vector<std::size_t> filled;
    std::vector<Average> values;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        Average average;
        for_each_neighbour(map, candidates[c].x, candidates[c].y, [&](std::uint32_t texel) {
            if (usable(texel)) average.add(map.texels, texel);
        });
        if (average.empty()) continue;
        filled.push_back(c);
        values.push_back(average);
    }
    for (std::size_t k = 0; k < filled.size(); ++k) values[k].store(map.texels, place(filled[k]));
}

// Invalid texels take the mean of their valid neighbours, ring by ring inwards.
void fill_invalid(Lightmap& map, const TexelBuffer& buffer) {
    std::vector<Pixel> open;
    for (std::size_t i = 0; i < buffer.size(); ++i)
        if (map.coverage[i] == Coverage::none) open.push_back({buffer.x[i], buffer.y[i]});
    const auto texel = [&](const Pixel& p) { return map.texel_at[std::size_t{p.y} * map.width + p.x]; };
    while (!open.empty()) {
        // Marked only after the whole ring is done, so that a ring sees the ring before it and not itself.
        std::vector<std::uint32_t> marked;
        average_ring(
            map, open, [&](std::uint32_t t) { return map.coverage[t] != Coverage::none; },
            [&](std::size_t c) { return marked.emplace_back(texel(open[c])); });
        if (marked.empty()) return;
        for (const std::uint32_t t : marked) map.coverage[t] = Coverage::filled;
        std::erase_if(open, [&](const Pixel& p) { return map.coverage[texel(p)] != Coverage::none; });
    }
}

// One ring of new texels around all that have a value.
void dilate_once(Lightmap& map) {
    std::vector<Pixel> ring;
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            if (map.texel_at[std::size_t{y} * map.width + x] != kNone) continue;
            bool touches = false;
            for_each_neighbour(map, x, y, [&](std::uint32_t t) { touches |= map.coverage[t] != Coverage::none; });
            if (touches) ring.push_back({x, y});
        }
    const std::size_t first = map.texels.size();
    map.texels.resize(first + ring.size());
    map.coverage.resize(first + ring.size(), Coverage::none);
    average_ring(
        map, ring, [&](std::uint32_t t) { return map.coverage[t] != Coverage::none; },
        [&](std::size_t c) { return first + c; });
    for (std::size_t c = 0; c < ring.size(); ++c) {
        map.coverage[first + c] = Coverage::dilated;
        map.texel_at[std::size_t{ring[c].y} * map.width + ring[c].x] = static_cast<std::uint32_t>(first + c);
    }
}

}  // namespace

Lightmap finish_page(const TexelBuffer& buffer, RadianceSums sums, std::uint32_t rings) {
    LUMEL_CHECK(sums.size() == buffer.size(), sums.size(), buffer.size());
    Lightmap map;
    map.page = buffer.page;
    map.width = buffer.width;
    map.height = buffer.height;
    map.texel_at = buffer.texel_at;
    map.texels = std::move(sums);
    map.coverage.assign(buffer.size(), Coverage::none);
    for (std::size_t i = 0; i < buffer.size(); ++i)
        if (map.texels.valid(i)) map.coverage[i] = Coverage::baked;
    fill_invalid(map, buffer);
    for (std::uint32_t ring = 0; ring < rings; ++ring) dilate_once(map);
    return map;
}

}  // namespace lumel
