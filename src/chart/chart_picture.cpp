#include "chart/chart_picture.h"

#include "base/hash.h"
#include "chart/chart_mask.h"

namespace lumel {

namespace {

// Calls span(placement, instance, triangle of its mesh, y, x0, x1) for what the triangles of the page reach in one of
// its mips, in the order of placements.
template <class Span>
void for_each_span(const Scene& scene, const ChartSet& charts, const Atlas& atlas, std::uint32_t page,
                   std::uint32_t mip, double reach, const Span& span) {
    const AtlasPage size = atlas.pages[page].at_mip(mip);
    const double scale = 1.0 / static_cast<double>(1u << mip);
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const std::uint32_t first = atlas.first_placement[i];
        if (first == atlas.first_placement[i + 1]) continue;
        const MeshCharts& mesh = charts.meshes[scene.instances[i].mesh];
        for (std::uint32_t c = 0; c < mesh.charts.size(); ++c) {
            const ChartPlacement& place = atlas.placements[first + c];
            if (place.page != page) continue;
            const TexelMap map{place.scale.x * scale, place.scale.y * scale, place.offset.x * scale,
                               place.offset.y * scale};
            for (std::uint32_t k = 0; k < mesh.charts[c].count; ++k) {
                const std::uint32_t triangle = mesh.order[mesh.charts[c].first + k];
                for_each_mask_span(
                    mesh.uv[triangle], map, size.width, size.height,
                    [&](std::uint32_t y, std::uint32_t x0, std::uint32_t x1) {
                        span(first + c, i, triangle, y, x0, x1);
                    },
                    reach);
            }
        }
    }
}

}  // namespace

std::vector<std::uint32_t> chart_ids(const Scene& scene, const ChartSet& charts, const Atlas& atlas, std::uint32_t page,
                                     std::uint32_t mip) {
    const AtlasPage size = atlas.pages[page].at_mip(mip);
    std::vector<std::uint32_t> ids(std::size_t{size.width} * size.height, kNone);
    for_each_span(scene, charts, atlas, page, mip, atlas.masks.reach(),
                  [&](std::uint32_t placement, std::uint32_t, std::uint32_t, std::uint32_t y, std::uint32_t x0,
                      std::uint32_t x1) {
                      for (std::uint32_t x = x0; x < x1; ++x) {
                          std::uint32_t& id = ids[std::size_t{y} * size.width + x];
                          if (id == kNone) id = placement;
                      }
                  });
    return ids;
}

TexelOwners texel_owners(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas,
                         std::uint32_t page) {
    const AtlasPage& size = atlas.pages[page];
    const std::size_t texels = std::size_t{size.width} * size.height;
    TexelOwners out{std::vector<std::uint32_t>(texels, kNone), std::vector<std::uint8_t>(texels, 0)};
    const auto take = [&](double reach, std::uint8_t covered) {
        for_each_span(scene, charts, atlas, page, 0, reach,
                      [&](std::uint32_t, std::uint32_t instance, std::uint32_t triangle, std::uint32_t y,
                          std::uint32_t x0, std::uint32_t x1) {
                          for (std::uint32_t x = x0; x < x1; ++x) {
                              const std::size_t texel = std::size_t{y} * size.width + x;
                              if (out.triangle[texel] != kNone) continue;
                              out.triangle[texel] = geometry.first_triangle[instance] + triangle;
                              out.covered[texel] = covered;
                          }
                      });
    };
    take(kTexelReach, 1);
    take(atlas.masks.reach(), 0);
    return out;
}

std::vector<std::uint8_t> color_ids(const std::vector<std::uint32_t>& ids) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * ids.size());
    for (const std::uint32_t id : ids) {
        const std::uint64_t h = mix64(std::uint64_t{id} + 1);
        for (int c = 0; c < 3; ++c)
            rgb.push_back(id == kNone ? 0 : static_cast<std::uint8_t>(64 + ((h >> (8 * c)) & 0xff) * 191 / 255));
    }
    return rgb;
}

}  // namespace lumel
