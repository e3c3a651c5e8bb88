#include "texture/stored_page.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/parallel.h"
#include "base/try.h"
#include "encode/is_light.h"
#include "encode/light_range.h"
#include "encode/units.h"
#include "lumel/scene.h"

namespace lumel {
namespace {

std::span<const Field> fields_of(const Encoding& encoding, const StoredTexture& texture) {
    return encoding.fields.subspan(texture.first, texture.count);
}

float scale_of(const Encoding& encoding, const StoredTexture& texture, std::span<const EncodedPage> levels) {
    const float largest = format_info(texture.format).largest;
    if (!is_light(fields_of(encoding, texture)[0].kind) || largest == 0.0f) return 1.0f;
    LightRange range = light_range(levels[0].numbers, texture.first, texture.count);
    // Numbers that encodings solve from a mean may be larger than any of which it is the mean.
    for (const EncodedPage& mip : levels.subspan(1))
        range.largest = std::max(range.largest, light_range(mip.numbers, texture.first, texture.count).largest);
    if (range.largest == 0.0f) return 1.0f;
    if (largest < kLargestOfHalves) return range.largest / largest;  // codes with a range of their own
    if (halves_hold(range)) return 1.0f;
    int exponent = 0;
    std::frexp(range.largest, &exponent);
    return std::ldexp(1.0f, exponent - 15);
}

// Fields of light that a texture of ratios shapes.
std::vector<std::size_t> light_behind(const Encoding& encoding, const StoredTexture& texture) {
    const auto find = [&](std::string_view ending) {
        std::vector<std::size_t> out;
        for (std::size_t i = 0; i < encoding.fields.size(); ++i)
            if (encoding.fields[i].kind == FieldKind::light &&
                std::string_view(encoding.fields[i].name).ends_with(ending))
                out.push_back(i);
        return out;
    };
    const std::size_t dot = texture.name.rfind('.');
    const std::vector<std::size_t> of_channel =
        dot == std::string::npos ? std::vector<std::size_t>{} : find(texture.name.substr(dot));
    return of_channel.empty() ? find("") : of_channel;
}

std::vector<float> weights_of(const Encoding& encoding, const StoredTexture& texture, const EncodedPage& page) {
    const bool of_light = is_light(fields_of(encoding, texture)[0].kind);
    const std::vector<std::size_t> behind = of_light ? std::vector<std::size_t>{} : light_behind(encoding, texture);
    // What is dark keeps a little: its numbers are looked at where light is filtered into it.
    constexpr float kLeast = 1e-4f;
    std::vector<float> of_texel(page.numbers.size(), 1.0f);
    float largest = 0.0f;
    for (std::size_t t = 0; t < of_texel.size() && !behind.empty(); ++t) {
        of_texel[t] = 0.0f;
        for (const std::size_t i : behind) of_texel[t] += std::max(page.numbers[t][i], 0.0f);
        largest = std::max(largest, of_texel[t]);
    }
    for (float& weight : of_texel)
        weight = behind.empty() || largest == 0.0f ? 1.0f : std::max(weight / largest, kLeast);
    std::vector<float> out(page.texel_at.size(), 0.0f);
    for (std::size_t i = 0; i < out.size(); ++i)
        if (page.texel_at[i] != kNone) out[i] = of_texel[page.texel_at[i]];
    return out;
}

// How a number is stored, and read.
struct Mapping {
    float offset, factor;
};
Mapping mapping_of(FieldKind kind, float scale) {
    if (is_light(kind)) return {0.0f, to_file_unit(1.0f / scale, LightUnit::e_over_pi)};
    return kind == FieldKind::ratio ? Mapping{0.5f, 0.5f} : Mapping{0.0f, 1.0f};
}

Result<std::vector<std::uint8_t>> store_level(const Encoding& encoding, const StoredTexture& texture,
                                              const EncodedPage& page, float scale, BcQuality quality,
                                              Context& context) {
    const std::span<const Field> fields = fields_of(encoding, texture);
    Image image(page.width, page.height, texture.count);
    for (std::size_t i = 0; i < page.texel_at.size(); ++i) {
        if (page.texel_at[i] == kNone) continue;
        const Numbers& numbers = page.numbers[page.texel_at[i]];
        for (std::size_t c = 0; c < texture.count; ++c) {
            const Mapping mapping = mapping_of(fields[c].kind, scale);
            image.data[i * texture.count + c] = mapping.offset + mapping.factor * numbers[texture.first + c];
        }
    }
    return encode_texels(texture.format, image, weights_of(encoding, texture, page), quality, context);
}

}  // namespace

Result<StoredLevels> store_levels(const Encoding& encoding, const StoredTexture& texture,
                                  std::span<const EncodedPage> levels, BcQuality quality, Context& context) {
    StoredLevels out;
    out.scale = scale_of(encoding, texture, levels);
    for (const EncodedPage& level : levels) {
        LUMEL_TRY(std::vector<std::uint8_t> texels, store_level(encoding, texture, level, out.scale, quality, context));
        out.texels.push_back(std::move(texels));
    }
    return out;
}

Result<StoredPage> store_page(const Encoding& encoding, const StoredTexture& texture, const EncodedPage& page,
                              BcQuality quality, Context& context) {
    LUMEL_TRY(StoredLevels stored, store_levels(encoding, texture, {&page, 1}, quality, context));
    return StoredPage{std::move(stored.texels[0]), stored.scale};
}

void read_back(const Encoding& encoding, const StoredTexture& texture, const StoredPage& stored, EncodedPage& page) {
    const Image image = decode_texels(texture.format, stored.texels, page.width, page.height);
    const std::span<const Field> fields = fields_of(encoding, texture);
    for (std::size_t i = 0; i < page.texel_at.size(); ++i) {
        if (page.texel_at[i] == kNone) continue;
        for (std::size_t c = 0; c < texture.count; ++c) {
            const Mapping mapping = mapping_of(fields[c].kind, stored.scale);
            page.numbers[page.texel_at[i]][texture.first + c] =
                (image.data[i * image.channels + c] - mapping.offset) / mapping.factor;
        }
    }
}

Result<EncodedPage> as_stored(const Encoding& encoding, std::span<const StoredTexture> layout, const EncodedPage& page,
                              BcQuality quality, Context& context) {
    EncodedPage out = page;
    for (const StoredTexture& texture : layout) {
        LUMEL_TRY(const StoredPage stored, store_page(encoding, texture, page, quality, context));
        read_back(encoding, texture, stored, out);
    }
    return out;
}

}  // namespace lumel
