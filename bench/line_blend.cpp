#include "line_blend.h"

#include <algorithm>
#include <cmath>

#include "io/baked.h"

namespace lumel::bench {
namespace {

constexpr float kOpacity = 0.5f;

// Do the two edges meet at both ends?
bool is_whole(const Seam& seam) {
    const auto ends = [](float from, float to) { return std::min(from, to) < 1e-3f && std::max(from, to) > 0.999f; };
    return ends(seam.a_from, seam.a_to) && ends(seam.b_from, seam.b_to);
}

// Every texel that the line passes through, once for each run of points in it, with the place on the other side.
void draw(const BorderEdge& to, float t0, float t1, const BorderEdge& from, float s0, float s1,
          const std::vector<Image>& before, std::vector<Image>& pages) {
    const Vec2 a = texels_at(to, t0), b = texels_at(to, t1);
    const auto n = static_cast<std::uint32_t>(std::ceil(4.0f * length(b - a))) + 1;
    const Image& source = before[from.page];
    Image& page = pages[to.page];
    std::int64_t last = -1;
    for (std::uint32_t k = 0; k < n; ++k) {
        const float t = (static_cast<float>(k) + 0.5f) / static_cast<float>(n);
        const Vec2 p = a + (b - a) * t;
        if (p.x < 0.0f || p.y < 0.0f) continue;
        const auto x = static_cast<std::uint32_t>(p.x), y = static_cast<std::uint32_t>(p.y);
        const std::int64_t pixel = std::int64_t{y} * page.width + x;
        if (x >= page.width || y >= page.height || pixel == last) continue;
        last = pixel;
        const Vec2 place = texels_at(from, std::lerp(s0, s1, t));
        const Vec3 other = sample_bilinear(
            source, {place.x / static_cast<float>(source.width), place.y / static_cast<float>(source.height)});
        for (std::size_t c = 0; c < 3; ++c) {
            float& value = page.at(x, y)[c];
            value = std::lerp(value, other[c], kOpacity);
        }
    }
}

}  // namespace

void blend_lines(std::span<const BorderEdge> edges, std::span<const Seam> seams,
                 std::span<const std::uint32_t> triangle_instance, std::uint32_t passes, std::vector<Image>& pages) {
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const std::vector<Image> before = pages;
        for (const Seam& seam : seams) {
            const BorderEdge &a = edges[seam.a], &b = edges[seam.b];
            if (triangle_instance[a.triangle] != triangle_instance[b.triangle] || !is_whole(seam)) continue;
            draw(a, seam.a_from, seam.a_to, b, seam.b_from, seam.b_to, before, pages);
            draw(b, seam.b_from, seam.b_to, a, seam.a_from, seam.a_to, before, pages);
        }
    }
}

}  // namespace lumel::bench
