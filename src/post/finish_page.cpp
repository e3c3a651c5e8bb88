#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/try.h"
#include "post/lightmap.h"
#include "post/texel_mean.h"

namespace lumel {
namespace {

constexpr std::array<std::array<int, 2>, 8> kNeighbours{
    {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};

// Calls visit(texel) for the 3x3 neighbours of pixel (x, y) that exist in the lightmap.
template <class Visit>
void for_each_neighbour(const Lightmap& map, std::uint32_t x, std::uint32_t y, Visit&& visit) {
    for (const auto& [dx, dy] : kNeighbours) {
        const std::uint32_t texel = texel_at_pixel(
            map.texel_at, map.width, map.height, static_cast<std::int32_t>(x) + dx, static_cast<std::int32_t>(y) + dy);
        if (texel != kNone) visit(texel);
    }
}

struct Pixel {
    std::uint32_t x, y;
};

constexpr std::size_t kLookEvery = 4096;  // texels between two looks at whether the bake was cancelled

// Mean of the 3x3 neighbours of one chart that have a value.
TexelMean mean_around(const Lightmap& map, Pixel p, std::uint32_t chart) {
    TexelMean mean(map);
    for_each_neighbour(map, p.x, p.y, [&](std::uint32_t texel) {
        if (map.coverage[texel] != Coverage::none && map.chart[texel] == chart) mean.add(texel);
    });
    return mean;
}

// Invalid texels take the mean of those neighbours of their chart that have a value, ring by ring inwards. Their
// surface is their own. A ring is marked only when all of it has been stored, so that it sees the ring before and not
// itself.
class Filler {
public:
    Filler(Lightmap& map, const TexelBuffer& buffer) : map_(map), buffer_(buffer), queued_(buffer.size()) {}

    Status run(Context& context) {
        std::vector<std::uint32_t> ring, next;
        for (std::uint32_t i = 0; i < buffer_.size(); ++i)
            if (map_.coverage[i] != Coverage::none) queue_around(i, ring);
        while (!ring.empty()) {
            for (std::size_t k = 0; k < ring.size(); ++k) {
                if (k % kLookEvery == 0 && context.cancelled()) return cancelled_error();
                const std::uint32_t i = ring[k];
                mean_around(map_, pixel(i), map_.chart[i]).store_light(map_.texels, i);
            }
            for (const std::uint32_t i : ring) map_.coverage[i] = Coverage::filled;
            next.clear();
            for (const std::uint32_t i : ring) queue_around(i, next);
            std::swap(ring, next);
        }
        return success();
    }

private:
    [[nodiscard]] Pixel pixel(std::uint32_t i) const { return {buffer_.x[i], buffer_.y[i]}; }

    // The open neighbours of texel i that can take its light and do not wait yet.
    void queue_around(std::uint32_t i, std::vector<std::uint32_t>& ring) {
        for_each_neighbour(map_, buffer_.x[i], buffer_.y[i], [&](std::uint32_t j) {
            if (map_.coverage[j] != Coverage::none || map_.chart[j] != map_.chart[i] || queued_[j] != 0) return;
            queued_[j] = 1;
            ring.push_back(j);
        });
    }

    Lightmap& map_;
    const TexelBuffer& buffer_;
    std::vector<std::uint8_t> queued_;
};

// The chart whose light an empty pixel takes; kNone where no neighbour has any.
std::uint32_t owner_of(const Lightmap& map, Pixel p, std::uint32_t reader) {
    std::array<std::uint32_t, 8> charts{};
    std::size_t count = 0;
    for_each_neighbour(map, p.x, p.y, [&](std::uint32_t texel) {
        if (map.coverage[texel] != Coverage::none) charts[count++] = map.chart[texel];
    });
    const std::span beside = std::span(charts).first(count);
    std::uint32_t owner = kNone;
    std::ptrdiff_t most = 0;
    for (const std::uint32_t chart : beside) {
        if (chart == reader) return reader;
        const std::ptrdiff_t n = std::ranges::count(beside, chart);
        if (n > most || (n == most && chart < owner)) {
            most = n;
            owner = chart;
        }
    }
    return owner;
}

// Room for all rings at once: growing ring by ring would hold the old and the new array each time.
void reserve(Lightmap& map, std::size_t texels) {
    map.texels.reserve(texels);
    map.surface.albedo.reserve(texels);
    map.surface.emission.reserve(texels);
    map.normal.reserve(texels);
    map.coverage.reserve(texels);
    map.chart.reserve(texels);
}

}  // namespace

Status dilate_once(Lightmap& map, std::span<const std::uint32_t> readers, Context& context) {
    std::vector<Pixel> ring;
    const std::size_t first = map.texels.size();
    for (std::uint32_t y = 0; y < map.height; ++y) {
        if (context.cancelled()) return cancelled_error();
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const std::size_t at = std::size_t{y} * map.width + x;
            if (map.texel_at[at] != kNone) continue;
            const std::uint32_t owner = owner_of(map, {x, y}, readers.empty() ? kNone : readers[at]);
            if (owner == kNone) continue;
            ring.push_back({x, y});
            map.chart.push_back(owner);
        }
    }
    resize_texels(map, first + ring.size());
    for (std::size_t k = 0; k < ring.size(); ++k) {
        if (k % kLookEvery == 0 && context.cancelled()) return cancelled_error();
        const TexelMean mean = mean_around(map, ring[k], map.chart[first + k]);
        mean.store_light(map.texels, first + k);
        mean.store_surface(map, first + k);
    }
    for (std::size_t k = 0; k < ring.size(); ++k) {
        map.coverage[first + k] = Coverage::dilated;
        map.texel_at[std::size_t{ring[k].y} * map.width + ring[k].x] = static_cast<std::uint32_t>(first + k);
    }
    return success();
}

// Square rings: first each row grows sideways, then a window of rows slides down the page.
std::size_t texels_with_rings(const TexelBuffer& buffer, std::uint32_t rings) {
    const std::size_t width = buffer.width, height = buffer.height;
    const std::size_t reach = std::min<std::size_t>(rings, std::max(width, height));
    std::vector<std::uint8_t> wide(width * height);
    for (std::size_t i = 0; i < buffer.size(); ++i) {
        const std::size_t x = buffer.x[i], row = buffer.y[i] * width;
        const std::size_t low = x > reach ? x - reach : 0, high = std::min(x + reach + 1, width);
        std::fill(wide.begin() + static_cast<std::ptrdiff_t>(row + low),
                  wide.begin() + static_cast<std::ptrdiff_t>(row + high), std::uint8_t{1});
    }
    std::vector<std::uint32_t> in_window(width);
    std::size_t count = 0;
    for (std::size_t y = 0; y < height + reach; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            if (y < height) in_window[x] += wide[y * width + x];
            if (y > 2 * reach) in_window[x] -= wide[(y - 2 * reach - 1) * width + x];
            count += y >= reach && in_window[x] > 0;
        }
    }
    return count;
}

Result<Lightmap> finish_page(const TexelBuffer& buffer, RadianceSums sums, TexelSurface surface,
                             std::span<const std::uint32_t> readers, std::uint32_t rings, Context& context) {
    LUMEL_CHECK(sums.size() == buffer.size(), sums.size(), buffer.size());
    LUMEL_CHECK(buffer.chart.size() == buffer.size(), buffer.chart.size(), buffer.size());
    LUMEL_CHECK(buffer.normal.size() == buffer.size(), buffer.normal.size(), buffer.size());
    LUMEL_CHECK(readers.empty() || readers.size() == buffer.texel_at.size(), readers.size(), buffer.texel_at.size());
    Lightmap map;
    map.page = buffer.page;
    map.width = buffer.width;
    map.height = buffer.height;
    map.texel_at = buffer.texel_at;
    map.texels = std::move(sums);
    map.surface = std::move(surface);
    map.normal = buffer.normal;
    map.chart = buffer.chart;
    map.coverage.assign(buffer.size(), Coverage::none);
    for (std::size_t i = 0; i < buffer.size(); ++i)
        if (map.texels.valid(i)) map.coverage[i] = Coverage::baked;
    LUMEL_TRY_STATUS(Filler(map, buffer).run(context));
    reserve(map, texels_with_rings(buffer, rings));
    for (std::uint32_t ring = 0; ring < rings; ++ring) LUMEL_TRY_STATUS(dilate_once(map, readers, context));
    return map;
}

}  // namespace lumel
