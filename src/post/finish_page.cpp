#include <array>
#include <cstddef>
#include <utility>
#include <vector>

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
        const std::uint32_t texel =
            map.texel_at[static_cast<std::size_t>(ny) * map.width + static_cast<std::size_t>(nx)];
        if (texel != kNone) visit(texel);
    }
}

// Mean of several texels' light, written over a texel. Sample counts are not averaged: a filled texel was not sampled.
class Average {
public:
    void add(const Lightmap& map, std::size_t i) {
        const RadianceSums& from = map.texels;
        ++n_;
        for (std::size_t l = 0; l < kLayerCount; ++l) {
            for (std::size_t k = 0; k < kShCoefficients; ++k) layers_[l].sh[k] += from.layers[i][l].sh[k];
            layers_[l].irradiance += from.layers[i][l].irradiance;
        }
        variance_ += from.variance[i];
        bent_ += from.bent_normal[i];
        sky_ += from.sky_visibility[i];
        occlusion_ += from.ambient_occlusion[i];
        albedo_ += map.surface.albedo[i];
        emission_ += map.surface.emission[i];
    }
    [[nodiscard]] bool empty() const { return n_ == 0; }
    void store_light(RadianceSums& to, std::size_t i) const {
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
    void store_surface(TexelSurface& to, std::size_t i) const {
        to.albedo[i] = albedo_ * (1.0f / static_cast<float>(n_));
        to.emission[i] = emission_ * (1.0f / static_cast<float>(n_));
    }

private:
    std::uint32_t n_ = 0;
    std::array<LayerMoments, kLayerCount> layers_{};
    Vec3 variance_{}, bent_{}, albedo_{}, emission_{};
    float sky_ = 0.0f, occlusion_ = 0.0f;
};

struct Pixel {
    std::uint32_t x, y;
};

// Mean of the 3x3 neighbours that have a value.
Average average_around(const Lightmap& map, Pixel p) {
    Average average;
    for_each_neighbour(map, p.x, p.y, [&](std::uint32_t texel) {
        if (map.coverage[texel] != Coverage::none) average.add(map, texel);
    });
    return average;
}

// Invalid texels take the mean of their valid neighbours, ring by ring inwards. Their surface is their own. A ring is
// marked only when all of it has been stored, so that it sees the ring before and not itself.
void fill_invalid(Lightmap& map, const TexelBuffer& buffer) {
    std::vector<Pixel> open;
    for (std::size_t i = 0; i < buffer.size(); ++i)
        if (map.coverage[i] == Coverage::none) open.push_back({buffer.x[i], buffer.y[i]});
    const auto texel = [&](Pixel p) { return map.texel_at[std::size_t{p.y} * map.width + p.x]; };
    while (!open.empty()) {
        std::vector<std::uint32_t> ring;
        for (const Pixel& p : open) {
            const Average average = average_around(map, p);
            if (average.empty()) continue;
            average.store_light(map.texels, texel(p));
            ring.push_back(texel(p));
        }
        if (ring.empty()) return;
        for (const std::uint32_t t : ring) map.coverage[t] = Coverage::filled;
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
    map.surface.albedo.resize(first + ring.size());
    map.surface.emission.resize(first + ring.size());
    map.coverage.resize(first + ring.size(), Coverage::none);
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const Average average = average_around(map, ring[k]);
        average.store_light(map.texels, first + k);
        average.store_surface(map.surface, first + k);
    }
    for (std::size_t k = 0; k < ring.size(); ++k) {
        map.coverage[first + k] = Coverage::dilated;
        map.texel_at[std::size_t{ring[k].y} * map.width + ring[k].x] = static_cast<std::uint32_t>(first + k);
    }
}

}  // namespace

Lightmap finish_page(const TexelBuffer& buffer, RadianceSums sums, TexelSurface surface, std::uint32_t rings) {
    LUMEL_CHECK(sums.size() == buffer.size(), sums.size(), buffer.size());
    Lightmap map;
    map.page = buffer.page;
    map.width = buffer.width;
    map.height = buffer.height;
    map.texel_at = buffer.texel_at;
    map.texels = std::move(sums);
    map.surface = std::move(surface);
    map.coverage.assign(buffer.size(), Coverage::none);
    for (std::size_t i = 0; i < buffer.size(); ++i)
        if (map.texels.valid(i)) map.coverage[i] = Coverage::baked;
    fill_invalid(map, buffer);
    for (std::uint32_t ring = 0; ring < rings; ++ring) dilate_once(map);
    return map;
}

}  // namespace lumel
