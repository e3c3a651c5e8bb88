// Material lookups: texture filtering in linear light, glTF's products of factor, texture and vertex colour.
#include "scene/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

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

// Folds a coordinate into [0, 1]; anything not finite becomes 0.
float fold(float u, Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat: u -= std::floor(u); break;
        case Wrap::clamp: u = std::clamp(u, 0.0f, 1.0f); break;
        case Wrap::mirror:
            u -= 2.0f * std::floor(0.5f * u);
            if (u > 1.0f) u = 2.0f - u;
            break;
    }
    return u >= 0.0f && u <= 1.0f ? u : 0.0f;
}

// The neighbour of a folded coordinate's texel lies at most one beyond the edge.
std::uint32_t neighbour(std::int32_t i, std::int32_t size, Wrap wrap) {
    if (i < 0) return static_cast<std::uint32_t>(wrap == Wrap::repeat ? size - 1 : 0);
    if (i >= size) return static_cast<std::uint32_t>(wrap == Wrap::repeat ? 0 : size - 1);
    return static_cast<std::uint32_t>(i);
}

Vec4 fetch(const Texture& texture, const std::array<float, 256>& rgb, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* p = &texture.rgba[(std::size_t{y} * texture.width + x) * 4];
    return {rgb[p[0]], rgb[p[1]], rgb[p[2]], kByteToUnit[p[3]]};
}

// The two texels of one axis and the weight of the second.
struct Tap {
    std::uint32_t low, high;
    float weight;
};

Tap linear_tap(float u, std::uint32_t size, Wrap wrap) {
    const float x = fold(u, wrap) * static_cast<float>(size) - 0.5f;
    const float floor = std::floor(x);
    const auto i = static_cast<std::int32_t>(floor);
    const auto n = static_cast<std::int32_t>(size);
    return {neighbour(i, n, wrap), neighbour(i + 1, n, wrap), x - floor};
}

std::uint32_t nearest_tap(float u, std::uint32_t size, Wrap wrap) {
    const auto i = static_cast<std::uint32_t>(fold(u, wrap) * static_cast<float>(size));
    return std::min(i, size - 1);
}

}  // namespace

Vec4 sample_texture(const Texture& texture, const TextureRef& ref, Vec2 uv) {
    const std::array<float, 256>& rgb = texture.srgb ? kSrgbToLinear : kByteToUnit;
    const std::array<float, 6>& m = ref.transform;
    const float u = m[0] * uv.x + m[1] * uv.y + m[2];
    const float v = m[3] * uv.x + m[4] * uv.y + m[5];
    if (ref.nearest)
        return fetch(texture, rgb, nearest_tap(u, texture.width, ref.wrap_u),
                     nearest_tap(v, texture.height, ref.wrap_v));

    const Tap x = linear_tap(u, texture.width, ref.wrap_u);
    const Tap y = linear_tap(v, texture.height, ref.wrap_v);
    const Vec4 top =
        fetch(texture, rgb, x.low, y.low) * (1.0f - x.weight) + fetch(texture, rgb, x.high, y.low) * x.weight;
    const Vec4 bottom =
        fetch(texture, rgb, x.low, y.high) * (1.0f - x.weight) + fetch(texture, rgb, x.high, y.high) * x.weight;
    return top * (1.0f - y.weight) + bottom * y.weight;
}

Vec2 SurfaceReader::uv(const TextureRef& ref, std::uint32_t triangle, float b1, float b2) const {
    const Triangle& v = geometry_->triangles[triangle].vertices;
    const std::vector<Vec2>& set = ref.uv_set == 0 ? geometry_->uv0 : geometry_->uv1;
    return set[v[0]] * (1.0f - b1 - b2) + set[v[1]] * b1 + set[v[2]] * b2;
}

Vec4 SurfaceReader::base_color(std::uint32_t triangle, float b1, float b2) const {
    const WorldTriangle& t = geometry_->triangles[triangle];
    const Material& material = scene_->materials[t.material];
    Vec4 color{material.base_color.x, material.base_color.y, material.base_color.z, material.alpha};
    if (const TextureRef& ref = material.base_color_texture; ref.texture != kNone) {
        const Vec4 texel = sample_texture(scene_->textures[ref.texture], ref, uv(ref, triangle, b1, b2));
        color = {color.x * texel.x, color.y * texel.y, color.z * texel.z, color.w * texel.w};
    }
    if (!geometry_->colors.empty()) {
        const std::vector<Vec4>& c = geometry_->colors;
        const Vec4 vertex = c[t.vertices[0]] * (1.0f - b1 - b2) + c[t.vertices[1]] * b1 + c[t.vertices[2]] * b2;
        color = {color.x * vertex.x, color.y * vertex.y, color.z * vertex.z, color.w * vertex.w};
    }
    return color;
}

Vec3 SurfaceReader::albedo(std::uint32_t triangle, float b1, float b2) const {
    if ((geometry_->triangles[triangle].flags & kOccluderOnly) != 0) return {};
    const Vec4 color = base_color(triangle, b1, b2);
    return {std::clamp(color.x, 0.0f, 1.0f), std::clamp(color.y, 0.0f, 1.0f), std::clamp(color.z, 0.0f, 1.0f)};
}

Vec3 SurfaceReader::emission(std::uint32_t triangle, float b1, float b2) const {
    const WorldTriangle& t = geometry_->triangles[triangle];
    if ((t.flags & kEmissive) == 0) return {};
    const Material& material = scene_->materials[t.material];
    const TextureRef& ref = material.emission_texture;
    if (ref.texture == kNone) return material.emission;
    const Vec4 texel = sample_texture(scene_->textures[ref.texture], ref, uv(ref, triangle, b1, b2));
    return material.emission * Vec3{texel.x, texel.y, texel.z};
}

float SurfaceReader::opacity(std::uint32_t triangle, float b1, float b2) const {
    const WorldTriangle& t = geometry_->triangles[triangle];
    if ((t.flags & kNeedsAlpha) == 0) return 1.0f;
    const Material& material = scene_->materials[t.material];
    const float alpha = base_color(triangle, b1, b2).w;
    if (material.alpha_mode == AlphaMode::mask) return alpha >= material.alpha_cutoff ? 1.0f : 0.0f;
    return std::clamp(alpha, 0.0f, 1.0f);
}

}  // namespace lumel
