// Material lookups: texture filtering in linear light, glTF's products of factor, texture and vertex colour.
#include "scene/surface.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/prefetch.h"

namespace lumel {
namespace {

// x^(2/5) by Newton's iteration on y^5 = x^2: the same bits everywhere, and usable at compile time.
constexpr double power_two_fifths(double x) {
    const double target = x * x;
    double y = 1.0;
    for (int i = 0; i < 100; ++i) y -= (y - target / (y * y * y * y)) / 5.0;
    return y;
}

constexpr std::array<float, 256> make_srgb_table() {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; ++i) {
        const double s = i / 255.0;
        const double base = (s + 0.055) / 1.055;
        const double linear = s <= 0.04045 ? s / 12.92 : base * base * power_two_fifths(base);  // base^2.4
        table[static_cast<std::size_t>(i)] = static_cast<float>(linear);
    }
    return table;
}

constexpr std::array<float, 256> make_linear_table() {
    std::array<float, 256> table{};
    for (int i = 0; i < 256; ++i) table[static_cast<std::size_t>(i)] = static_cast<float>(i / 255.0);
    return table;
}

constexpr std::array<float, 256> kSrgbToLinear = make_srgb_table();
constexpr std::array<float, 256> kByteToUnit = make_linear_table();

// The largest whole number not above x, for |x| < 2^31. The baseline processor has no instruction for it, and a call of
// the library's costs more than the rest of a lookup.
float whole_below(float x) {
    const auto whole = static_cast<std::int32_t>(x);
    return static_cast<float>(whole - (static_cast<float>(whole) > x ? 1 : 0));
}

// Folds a coordinate into [0, 1]; anything not finite, or too large to have a fraction, becomes 0.
float fold(float u, Wrap wrap) {
    constexpr float kNoFraction = 0x1p24f;
    if (!(u > -kNoFraction && u < kNoFraction)) u = wrap == Wrap::clamp && u > 0.0f ? 1.0f : 0.0f;
    switch (wrap) {
        case Wrap::repeat: u -= whole_below(u); break;
        case Wrap::clamp: u = std::clamp(u, 0.0f, 1.0f); break;
        case Wrap::mirror:
            u -= 2.0f * whole_below(0.5f * u);
            if (u > 1.0f) u = 2.0f - u;
            break;
    }
    return u >= 0.0f && u <= 1.0f ? u : 0.0f;
}

// The neighbour of a folded coordinate's texel lies at most one beyond the edge.
std::uint32_t neighbour(std::int32_t i, std::int32_t size, Wrap wrap) {
    const std::int32_t beyond = wrap == Wrap::repeat ? size : 1;
    return static_cast<std::uint32_t>(i + (i < 0 ? beyond : 0) - (i >= size ? beyond : 0));
}

// The two texels of one axis and the weight of the second.
struct Tap {
    std::uint32_t low, high;
    float weight;
};

Tap linear_tap(float u, std::uint32_t size, Wrap wrap) {
    const float x = fold(u, wrap) * static_cast<float>(size) - 0.5f;
    const float floor = whole_below(x);
    const auto i = static_cast<std::int32_t>(floor);
    const auto n = static_cast<std::int32_t>(size);
    return {neighbour(i, n, wrap), neighbour(i + 1, n, wrap), x - floor};
}

std::uint32_t nearest_tap(float u, std::uint32_t size, Wrap wrap) {
    const auto i = static_cast<std::uint32_t>(fold(u, wrap) * static_cast<float>(size));
    return std::min(i, size - 1);
}

// The four texels of a lookup, and how they mix.
struct Footprint {
    std::array<const std::uint8_t*, 4> texels;  // low-low, high-low, low-high, high-high
    Vec2 weight;                                // of the high ones
};

Footprint footprint(const Texture& texture, const TextureRef& ref, Vec2 uv) {
    const std::array<float, 6>& m = ref.transform;
    const float u = m[0] * uv.x + m[1] * uv.y + m[2];
    const float v = m[3] * uv.x + m[4] * uv.y + m[5];
    const auto texel = [&texture](std::uint32_t x, std::uint32_t y) {
        return &texture.rgba[(std::size_t{y} * texture.width + x) * 4];
    };
    if (ref.nearest) {
        const std::uint8_t* p =
            texel(nearest_tap(u, texture.width, ref.wrap_u), nearest_tap(v, texture.height, ref.wrap_v));
        return {{p, p, p, p}, {}};
    }
    const Tap x = linear_tap(u, texture.width, ref.wrap_u);
    const Tap y = linear_tap(v, texture.height, ref.wrap_v);
    return {{texel(x.low, y.low), texel(x.high, y.low), texel(x.low, y.high), texel(x.high, y.high)},
            {x.weight, y.weight}};
}

const std::array<float, 256>& to_linear(const Texture& texture) { return texture.srgb ? kSrgbToLinear : kByteToUnit; }

float mix(const std::array<const std::uint8_t*, 4>& texels, Vec2 weight, std::size_t channel,
          const std::array<float, 256>& values) {
    const float top = values[texels[0][channel]] * (1.0f - weight.x) + values[texels[1][channel]] * weight.x;
    const float bottom = values[texels[2][channel]] * (1.0f - weight.x) + values[texels[3][channel]] * weight.x;
    return top * (1.0f - weight.y) + bottom * weight.y;
}

}  // namespace

Vec4 sample_texture(const Texture& texture, const TextureRef& ref, Vec2 uv) {
    const auto [texels, weight] = footprint(texture, ref, uv);
    const std::array<float, 256>& rgb = to_linear(texture);
    return {mix(texels, weight, 0, rgb), mix(texels, weight, 1, rgb), mix(texels, weight, 2, rgb),
            mix(texels, weight, 3, kByteToUnit)};
}

Vec2 SurfaceReader::uv(const TextureRef& ref, const WorldTriangle& triangle, float b1, float b2) const {
    const Triangle& v = triangle.vertices;
    const std::vector<Vec2>& set = ref.uv_set == 0 ? geometry_->uv0 : geometry_->uv1;
    return set[v[0]] * (1.0f - b1 - b2) + set[v[1]] * b1 + set[v[2]] * b2;
}

// What multiplies the base colour texture: the material's factor and the vertex colour.
Vec4 SurfaceReader::base_factor(const WorldTriangle& t, float b1, float b2) const {
    const Material& material = scene_->materials[t.material];
    const Vec4 color{material.base_color.x, material.base_color.y, material.base_color.z, material.alpha};
    if (geometry_->colors.empty()) return color;
    const std::vector<Vec4>& c = geometry_->colors;
    const Vec4 vertex = c[t.vertices[0]] * (1.0f - b1 - b2) + c[t.vertices[1]] * b1 + c[t.vertices[2]] * b2;
    return {color.x * vertex.x, color.y * vertex.y, color.z * vertex.z, color.w * vertex.w};
}

AlbedoLookup SurfaceReader::begin_albedo(std::uint32_t triangle, float b1, float b2) const {
    AlbedoLookup lookup;
    const WorldTriangle& t = geometry_->triangles[triangle];
    if ((t.flags & kOccluderOnly) != 0) return lookup;
    const Vec4 factor = base_factor(t, b1, b2);
    lookup.factor = {factor.x, factor.y, factor.z};
    const TextureRef& ref = scene_->materials[t.material].base_color_texture;
    if (ref.texture == kNone) return lookup;
    const Texture& texture = scene_->textures[ref.texture];
    const auto [texels, weight] = footprint(texture, ref, uv(ref, t, b1, b2));
    prefetch(texels[0]);
    prefetch(texels[3]);
    lookup.texels = texels;
    lookup.weight = weight;
    lookup.to_linear = &to_linear(texture);
    return lookup;
}

Vec3 SurfaceReader::finish(const AlbedoLookup& lookup) {
    Vec3 color = lookup.factor;
    if (lookup.to_linear)
        for (std::size_t c = 0; c < 3; ++c) color[c] *= mix(lookup.texels, lookup.weight, c, *lookup.to_linear);
    return {std::clamp(color.x, 0.0f, 1.0f), std::clamp(color.y, 0.0f, 1.0f), std::clamp(color.z, 0.0f, 1.0f)};
}

Vec3 SurfaceReader::albedo(std::uint32_t triangle, float b1, float b2) const {
    return finish(begin_albedo(triangle, b1, b2));
}

Vec3 SurfaceReader::emission(std::uint32_t triangle, float b1, float b2) const {
    const WorldTriangle& t = geometry_->triangles[triangle];
    if ((t.flags & kEmissive) == 0) return {};
    const Material& material = scene_->materials[t.material];
    const TextureRef& ref = material.emission_texture;
    if (ref.texture == kNone) return material.emission;
    const Vec4 texel = sample_texture(scene_->textures[ref.texture], ref, uv(ref, t, b1, b2));
    return material.emission * Vec3{texel.x, texel.y, texel.z};
}

// Rays ask for it at every surface with holes: alpha alone is read.
float SurfaceReader::alpha(const WorldTriangle& t, float b1, float b2) const {
    const float factor = base_factor(t, b1, b2).w;
    const TextureRef& ref = scene_->materials[t.material].base_color_texture;
    if (ref.texture == kNone) return factor;
    const auto [texels, weight] = footprint(scene_->textures[ref.texture], ref, uv(ref, t, b1, b2));
    return factor * mix(texels, weight, 3, kByteToUnit);
}

float SurfaceReader::opacity(std::uint32_t triangle, float b1, float b2) const {
    const WorldTriangle& t = geometry_->triangles[triangle];
    if ((t.flags & kNeedsAlpha) == 0) return 1.0f;
    const Material& material = scene_->materials[t.material];
    if (material.alpha_mode == AlphaMode::mask) return alpha(t, b1, b2) >= material.alpha_cutoff ? 1.0f : 0.0f;
    return std::clamp(alpha(t, b1, b2), 0.0f, 1.0f);
}

}  // namespace lumel
