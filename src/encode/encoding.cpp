#include "encode/encoding.h"

#include <algorithm>
#include <cmath>

#include "encode/encodings.h"
#include "encode/is_light.h"
#include "math/half.h"

namespace lumel {
namespace {

constexpr std::array<const Encoding*, 22> kEncodings{&kIrradianceEncoding,
                                                     &kIrradZAhd,
                                                     &kIrradZHhd,
                                                     &kIrradZHhdClosed,
                                                     &kL1Mono,
                                                     &kIrradZAhdRgb,
                                                     &kIrradZHhdRgb,
                                                     &kL1Linear,
                                                     &kL1Hazel,
                                                     &kL1Hhd,
                                                     &kL1LinearFit,
                                                     &kL1HazelFit,
                                                     &kZh3Hallucinated,
                                                     &kHlsh,
                                                     &kH4,
                                                     &kZh3,
                                                     &kH6,
                                                     &kL2,
                                                     &kAhd,
                                                     &kRnm,
                                                     &kAmbientCube,
                                                     &kSphericalGaussians};

float round_to_byte(float unit) { return std::floor(std::clamp(unit, 0.0f, 1.0f) * 255.0f + 0.5f) / 255.0f; }

float stored(FieldKind kind, Storage storage, float value) {
    if (storage == Storage::exact) return value;
    if (storage == Storage::texture && kind == FieldKind::ratio)
        return 2.0f * round_to_byte(0.5f + 0.5f * value) - 1.0f;
    if (storage == Storage::texture && kind == FieldKind::unit) return round_to_byte(value);
    return round_to_half(value);
}

}  // namespace

std::span<const Encoding* const> list_encodings() { return kEncodings; }

const Encoding* find_encoding(std::string_view name) {
    const auto at = std::ranges::find_if(kEncodings, [&](const Encoding* e) { return name == e->name; });
    return at == kEncodings.end() ? nullptr : *at;
}

void quantise(const Encoding& encoding, Storage storage, Numbers& numbers) {
    for (std::size_t i = 0; i < encoding.fields.size(); ++i)
        numbers[i] = stored(encoding.fields[i].kind, storage, numbers[i]);
}

std::size_t bytes_per_texel(const Encoding& encoding, Storage storage) {
    const std::size_t numbers = encoding.fields.size();
    if (storage == Storage::exact) return 4 * numbers;
    if (storage == Storage::half) return 2 * numbers;
    const auto lights = static_cast<std::size_t>(std::ranges::count_if(encoding.fields, is_light, &Field::kind));
    return (lights + 2) / 3 * 6 + (numbers - lights + 3) / 4 * 4;
}

Numbers detail::blend_numbers(const Numbers& a, float weight_a, const Numbers& b, float weight_b) {
    Numbers out;
    for (std::size_t i = 0; i < kMaxNumbers; ++i) out[i] = a[i] * weight_a + b[i] * weight_b;
    return out;
}

}  // namespace lumel
