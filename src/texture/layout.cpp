#include "texture/layout.h"

#include <algorithm>
#include <array>

#include "encode/is_light.h"

namespace lumel {
namespace {

using F = TexelFormat;
constexpr std::array<F, 3> kBytes{F::rgba8, F::rgba8, F::rgba8};

constexpr TextureStorage row(const char* name, F light, F signed_light, bool has_negative, std::array<F, 3> rest,
                             bool joins) {
    return {name, light, signed_light, has_negative, {rest[0], rest[1], rest[2]}, joins};
}
// Two channels that need not lie on one line are better off in BC5 than in BC7, for the same bytes.
constexpr std::array kStorages{
    row("bc7", F::bc6h_unsigned, F::bc6h_signed, true, {F::bc4, F::bc5, F::bc7}, true),
    row("bc45", F::bc6h_unsigned, F::bc6h_signed, true, {F::bc4, F::bc5, F::bc7}, false),
    row("bc1", F::bc6h_unsigned, F::bc6h_signed, true, {F::bc4, F::bc1, F::bc1}, true),
    row("rgb9e5", F::rgb9e5, F::rgb9e5, false, kBytes, true),
    row("rgba16f", F::rgba16f, F::rgba16f, true, kBytes, true),
    row("rgbm", F::rgbm, F::rgbm, false, kBytes, true),
    row("rgbd", F::rgbd, F::rgbd, false, kBytes, true),
    row("logluv", F::logluv, F::logluv, false, kBytes, true),
    row("rgbe", F::rgbe, F::rgbe, false, kBytes, true),
};

std::string_view stem(const Field& field) {
    const std::string_view name = field.name;
    return name.substr(0, name.rfind('.'));
}

// Fields that belong together, format to be found.
std::vector<StoredTexture> groups_of(const Encoding& encoding) {
    std::vector<StoredTexture> out;
    for (std::size_t i = 0; i < encoding.fields.size(); ++i) {
        const Field& field = encoding.fields[i];
        if (!out.empty() && out.back().name == stem(field) && out.back().count < 3 &&
            is_light(field.kind) == is_light(encoding.fields[i - 1].kind))
            ++out.back().count;
        else
            out.push_back({std::string(stem(field)), F::rgba8, static_cast<std::uint8_t>(i), 1});
    }
    return out;
}

std::vector<StoredTexture> joined(const Encoding& encoding, const std::vector<StoredTexture>& groups) {
    std::vector<StoredTexture> out;
    for (const StoredTexture& group : groups) {
        const bool fits = !out.empty() && !is_light(encoding.fields[group.first].kind) &&
                          !is_light(encoding.fields[out.back().first].kind) && out.back().count + group.count <= 3;
        if (!fits) {
            out.push_back(group);
            continue;
        }
        out.back().name += "-" + group.name;
        out.back().count = static_cast<std::uint8_t>(out.back().count + group.count);
    }
    return out;
}

}  // namespace

std::span<const TextureStorage> texture_storages() { return kStorages; }

const TextureStorage* find_texture_storage(std::string_view name) {
    const auto* const at = std::ranges::find_if(kStorages, [&](const TextureStorage& s) { return name == s.name; });
    return at == kStorages.end() ? nullptr : at;
}

bool is_of_gpus(const TextureStorage& storage) { return format_info(storage.light).vk_format != 0; }

std::vector<StoredTexture> texture_layout(const Encoding& encoding, const TextureStorage& storage) {
    std::vector<StoredTexture> out = groups_of(encoding);
    if (storage.joins) out = joined(encoding, out);
    for (StoredTexture& texture : out) {
        const auto fields = encoding.fields.subspan(texture.first, texture.count);
        const bool is_signed =
            std::ranges::any_of(fields, [](const Field& f) { return f.kind == FieldKind::signed_light; });
        if (is_signed && !storage.has_negative) return {};
        texture.format = !is_light(fields[0].kind) ? storage.eight_bits[texture.count - 1]
                         : is_signed               ? storage.signed_light
                                                   : storage.light;
    }
    return out;
}

double bytes_per_texel(std::span<const StoredTexture> layout) {
    double sum = 0.0;
    for (const StoredTexture& texture : layout) sum += bytes_per_texel(format_info(texture.format));
    return sum;
}

}  // namespace lumel
