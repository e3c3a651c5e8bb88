#include "texel/texel_buffer.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/check.h"
#include "texel/texel_samples.h"

namespace lumel {
namespace {

// The radical inverse of the index in base 2 beside the index itself, each in the middle of its sixty-fourth; in an
// order in which the first 2^k points are spread as evenly as 2^k can be: one in each of the boxes of 2^-a x 2^-b of
// the square, a + b = k. The order is linear over GF(2), its columns found by trying.
constexpr std::array<Vec2, kSamplesPerTexel> hammersley_set() {
    constexpr std::array<std::uint32_t, 6> kColumns{51, 17, 15, 5, 3, 1};
    std::array<Vec2, kSamplesPerTexel> points;
    for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
        std::uint32_t index = 0, reversed = 0;
        for (std::uint32_t bit = 0; bit < 6; ++bit)
            if ((s >> bit) & 1u) index ^= kColumns[bit];
        for (std::uint32_t bit = 0; bit < 6; ++bit) reversed |= ((index >> bit) & 1u) << (5 - bit);
        points[s] = {(static_cast<float>(index) + 0.5f) / 64.0f, (static_cast<float>(reversed) + 0.5f) / 64.0f};
    }
    return points;
}
constexpr std::array<Vec2, kSamplesPerTexel> kHammersley = hammersley_set();

}  // namespace

Vec2 subtexel_point(std::uint32_t s) { return kHammersley[s]; }

Vec2 gather_point(std::uint64_t valid, std::uint32_t s) {
    if (~valid != 0) return kHammersley[s];
    const Vec2 centre{0.5f, 0.5f};
    return centre + (kHammersley[s] - centre) * kGatherFootprint;
}

std::vector<std::vector<std::uint32_t>> triangles_by_page(const Scene& scene, const WorldGeometry& geometry,
                                                          const ChartSet& charts, const Atlas& atlas) {
    std::vector<std::vector<std::uint32_t>> pages(atlas.pages.size());
    for (std::uint32_t triangle = 0; triangle < geometry.triangle_count(); ++triangle) {
        const std::uint32_t page = atlas.triangle_uv(charts, geometry, scene, triangle).page;
        if (page == kNone) continue;
        LUMEL_CHECK(page < pages.size(), page, pages.size());
        pages[page].push_back(triangle);
    }
    return pages;
}

namespace {

// Writes the surface point of each valid point, in order of s; whether all were found in a triangle.
template <class UvOf>
bool locate_all(const TexelSamples& samples, std::uint64_t valid, std::span<const std::uint32_t> triangles, UvOf&& uv,
                std::span<SamplePoint, kSamplesPerTexel> out) {
    std::uint64_t missing = valid;
    for (const std::uint32_t triangle : triangles) {
        samples.for_each_inside(uv(triangle), missing, [&](std::uint32_t s, Barycentrics b) {
            out[rank(valid, s)] = {triangle, b.b1, b.b2};
            missing &= ~(std::uint64_t{1} << s);
        });
        if (missing == 0) return true;
    }
    return false;
}

// From a number evenly spread over [0, 1) to one as densely spread as a tent over (-1, 1) is high.
double tent(double u) { return u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 * (1.0 - u)); }

// Triangles of the texel, and of those up to `reach` texels around it that are of its chart; ascending.
void triangles_around(const TexelBuffer& texels, std::size_t texel, std::int32_t reach,
                      std::vector<std::uint32_t>& out) {
    out.clear();
    for (std::int32_t dy = -reach; dy <= reach; ++dy)
        for (std::int32_t dx = -reach; dx <= reach; ++dx) {
            const std::uint32_t i = texels.at(texels.x[texel] + dx, texels.y[texel] + dy);
            if (i == kNone || texels.chart[i] != texels.chart[texel]) continue;
            for (std::uint32_t k = texels.first_triangle[i]; k < texels.first_triangle[i + 1]; ++k)
                out.push_back(texels.triangles[k]);
        }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
}

}  // namespace

void texel_points(const TexelBuffer& texels, std::size_t texel, const Scene& scene, const WorldGeometry& geometry,
                  const ChartSet& charts, const Atlas& atlas, Footprint footprint, const FootprintPart& part,
                  TexelPoints& out) {
    LUMEL_CHECK(footprint != Footprint::gather);
    const bool lookup = footprint == Footprint::lookup;
    triangles_around(texels, texel, lookup ? 1 : 0, out.triangles);
    std::vector<TexelTriangle> uv;
    uv.reserve(out.triangles.size());
    for (const std::uint32_t triangle : out.triangles)
        uv.emplace_back(atlas.triangle_uv(charts, geometry, scene, triangle).texels);
    out.count = 0;
    out.valid = 0;
    for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
        const Vec2 p = part.low + subtexel_point(s) * (part.high - part.low);
        const double x = texels.x[texel] + (lookup ? 0.5 + tent(double{p.x}) : double{p.x});
        const double y = texels.y[texel] + (lookup ? 0.5 + tent(double{p.y}) : double{p.y});
        for (std::size_t k = 0; k < uv.size(); ++k) {
            const auto b = uv[k].locate(x, y);
            if (!b) continue;
            out.at[out.count++] = {out.triangles[k], b->b1, b->b2};
            out.valid |= std::uint64_t{1} << s;
            break;
        }
    }
}

SamplePoint representative_point(const TexelBuffer& texels, std::size_t texel, const Scene& scene,
                                 const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas) {
    const std::uint32_t first = texels.first_triangle[texel], end = texels.first_triangle[texel + 1];
    return TexelSamples(texels.x[texel], texels.y[texel])
        .representative(std::span(&texels.triangles[first], end - first), texels.valid[texel],
                        [&](std::uint32_t triangle) {
                            return TexelTriangle(atlas.triangle_uv(charts, geometry, scene, triangle).texels);
                        });
}

std::uint32_t sample_points(const TexelBuffer& texels, std::size_t texel, const Scene& scene,
                            const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas,
                            std::span<SamplePoint, kSamplesPerTexel> out, Footprint footprint) {
    const std::uint32_t first = texels.first_triangle[texel], end = texels.first_triangle[texel + 1];
    const std::span triangles(&texels.triangles[first], end - first);
    const TexelSamples samples(texels.x[texel], texels.y[texel]);
    const auto uv = [&](std::uint32_t triangle) {
        return TexelTriangle(atlas.triangle_uv(charts, geometry, scene, triangle).texels);
    };
    const std::uint64_t valid = texels.valid[texel];
    if (valid == 0) {
        out[0] = samples.middle_of_largest_part(triangles, uv);
        return 1;
    }
    constexpr std::uint64_t kAll = ~std::uint64_t{0};
    if (valid == kAll && footprint == Footprint::gather &&
        locate_all(TexelSamples::gathering(texels.x[texel], texels.y[texel]), valid, triangles, uv, out))
        return kSamplesPerTexel;
    // On the rim; or a shrunk point fell into a crack between two triangles, which the others do not.
    const bool found = locate_all(samples, valid, triangles, uv, out);
    LUMEL_CHECK(found, texels.page, texels.x[texel], texels.y[texel]);
    return static_cast<std::uint32_t>(std::popcount(valid));
}

}  // namespace lumel
