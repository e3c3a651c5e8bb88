#include "inspect/view.h"

#include <algorithm>
#include <cmath>

#include "render/camera_rays.h"
#include "seam/lookup_filter.h"

namespace lumel {
namespace {

// The texel that a place lies in, as a lookup of one.
Lookup point_lookup(Vec2 texels) {
    return {static_cast<std::int32_t>(std::floor(texels.x)),
            static_cast<std::int32_t>(std::floor(texels.y)),
            1,
            {1.0f},
            {1.0f}};
}

Lookup lookup_for(ViewFilter filter, Vec2 texels) {
    switch (filter) {
        case ViewFilter::point: return point_lookup(texels);
        case ViewFilter::bilinear: return lookup_at(LookupFilter::bilinear, texels);
        case ViewFilter::bicubic: return lookup_at(LookupFilter::bicubic, texels);
    }
    return point_lookup(texels);
}

// Whether any texel had a number; their blend.
bool blend(const LayerPage& page, const Lookup& lookup, bool zero_where_empty, std::span<float> out) {
    float found = 0.0f;
    lookup.for_each(page.values.width, page.values.height, [&](std::uint32_t x, std::uint32_t y, float share) {
        if (page.presence[std::size_t{y} * page.values.width + x] == Presence::none) return;
        const float* const value = page.values.at(x, y);
        for (std::size_t c = 0; c < out.size(); ++c) out[c] += share * value[c];
        found += share;
    });
    if (!(found > 0.0f)) return false;
    if (!zero_where_empty)
        for (float& v : out) v /= found;
    return true;
}

}  // namespace

LayerView look_up(const TexelLayer& layer, std::span<const LayerPage> pages, const Scene& scene,
                  const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas, const SeenSurfaces& seen,
                  ViewFilter filter) {
    const auto channels = static_cast<std::uint32_t>(layer.channels.size());
    LayerView out{Image(seen.width, seen.height, channels), std::vector<Shown>(seen.hits.size(), Shown::nothing),
                  seen.facing};
    if (!layer.blends()) filter = ViewFilter::point;
    for (std::size_t i = 0; i < seen.hits.size(); ++i) {
        const Hit& hit = seen.hits[i];
        if (hit.missed()) continue;
        if (is_culled(geometry, hit)) {
            out.shown[i] = Shown::back;
            continue;
        }
        const Atlas::TriangleUv uv = atlas.triangle_uv(charts, geometry, scene, hit.triangle);
        if (uv.page == kNone) {
            out.shown[i] = Shown::no_lightmap;
            continue;
        }
        const Vec2 at = uv.texels[0] * (1.0f - hit.b1 - hit.b2) + uv.texels[1] * hit.b1 + uv.texels[2] * hit.b2;
        const bool found = blend(pages[uv.page], lookup_for(filter, at), layer.is_looked_up,
                                 std::span(&out.values.data[i * channels], channels));
        out.shown[i] = found ? Shown::texel : Shown::empty;
    }
    return out;
}

}  // namespace lumel
