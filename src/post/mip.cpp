#include "post/mip.h"

#include <utility>
#include <vector>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/try.h"
#include "post/texel_mean.h"

namespace lumel {
namespace {

bool has_own_light(const Lightmap& page, std::uint32_t texel) {
    return texel != kNone && page.coverage[texel] >= Coverage::filled;
}

// Calls visit(texel) for those below a texel of the mip that have light of their own.
template <class Visit>
void for_each_below(const Lightmap& page, std::uint32_t side, std::uint32_t x, std::uint32_t y, const Visit& visit) {
    for (std::uint32_t row = y * side; row < (y + 1) * side; ++row)
        for (std::uint32_t column = x * side; column < (x + 1) * side; ++column)
            if (const std::uint32_t texel = page.texel_at[std::size_t{row} * page.width + column];
                has_own_light(page, texel))
                visit(texel);
}

bool leaks(const Lightmap& page, std::uint32_t texel) { return texel < page.leaks.size() && page.leaks[texel] != 0; }

// Texels that hold nothing but leaks take the mean of those around them that do not, and of those that have taken it
// in an earlier ring.
void refill(Lightmap& mip, std::vector<std::uint8_t>& leaky) {
    struct Place {
        std::uint32_t texel, x, y;
    };
    std::vector<Place> open;
    for (std::uint32_t y = 0; y < mip.height; ++y)
        for (std::uint32_t x = 0; x < mip.width; ++x)
            if (const std::uint32_t texel = mip.texel_at[std::size_t{y} * mip.width + x];
                texel != kNone && leaky[texel] != 0)
                open.push_back({texel, x, y});
    for (bool any = true; any;) {
        std::vector<Place> later;
        std::vector<std::pair<std::uint32_t, TexelMean>> ring;
        for (const Place& place : open) {
            TexelMean mean(mip);
            for (std::int32_t dy = -1; dy <= 1; ++dy)
                for (std::int32_t dx = -1; dx <= 1; ++dx) {
                    const std::uint32_t beside =
                        texel_at_pixel(mip.texel_at, mip.width, mip.height, static_cast<std::int32_t>(place.x) + dx,
                                       static_cast<std::int32_t>(place.y) + dy);
                    if (beside != kNone && leaky[beside] == 0 && mip.chart[beside] == mip.chart[place.texel])
                        mean.add(beside);
                }
            if (mean.empty())
                later.push_back(place);
            else
                ring.emplace_back(place.texel, mean);
        }
        for (const auto& [texel, mean] : ring) {
            const Vec3 albedo = mip.surface.albedo[texel], emission = mip.surface.emission[texel],
                       normal = mip.normal[texel];
            mean.store(mip, texel, mip.chart[texel]);
            mip.coverage[texel] = Coverage::filled;
            mip.surface.albedo[texel] = albedo;  // a filled texel keeps its own surface
            mip.surface.emission[texel] = emission;
            mip.normal[texel] = normal;
            leaky[texel] = 0;
        }
        any = !ring.empty();
        open = std::move(later);
    }
}

}  // namespace

Result<Lightmap> make_mip(const Lightmap& page, std::uint32_t mip, std::span<const std::uint32_t> readers,
                          std::uint32_t rings, Context& context) {
    const std::uint32_t side = 1u << mip;
    LUMEL_CHECK(page.mip == 0 && page.width % side == 0 && page.height % side == 0, page.width, page.height);
    Lightmap out;
    out.page = page.page;
    out.mip = mip;
    out.width = page.width / side;
    out.height = page.height / side;
    LUMEL_CHECK(readers.size() == std::size_t{out.width} * out.height, readers.size(), out.width);
    out.texel_at.assign(readers.size(), kNone);
    std::vector<std::uint32_t> owners;
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const std::size_t at = std::size_t{y} * out.width + x;
            std::uint32_t owner = kNone;
            for_each_below(page, side, x, y, [&](std::uint32_t texel) {
                const std::uint32_t chart = page.chart[texel];
                if (owner == kNone || chart == readers[at]) owner = chart;
            });
            if (owner == kNone) continue;
            out.texel_at[at] = static_cast<std::uint32_t>(owners.size());
            owners.push_back(owner);
        }
    resize_texels(out, owners.size());
    std::vector<std::uint8_t> leaky(owners.size());
    for (std::uint32_t y = 0; y < out.height; ++y) {
        if (context.cancelled()) return cancelled_error();
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const std::uint32_t to = out.texel_at[std::size_t{y} * out.width + x];
            if (to == kNone) continue;
            TexelMean mean(page), of_leaks(page);
            for_each_below(page, side, x, y, [&](std::uint32_t texel) {
                if (page.chart[texel] == owners[to]) (leaks(page, texel) ? of_leaks : mean).add(texel);
            });
            leaky[to] = mean.empty() ? 1 : 0;
            (mean.empty() ? of_leaks : mean).store(out, to, owners[to]);
        }
    }
    refill(out, leaky);
    for (std::uint32_t ring = 0; ring < rings; ++ring) LUMEL_TRY_STATUS(dilate_once(out, readers, context));
    return out;
}

}  // namespace lumel
