#include "texture/stored_page.h"

#include <gtest/gtest.h>

#include <cmath>

#include "encode/encodings.h"
#include "lumel/scene.h"

namespace lumel {
namespace {

// 8 x 8 texels of which those with x + y < 9 are covered, smooth in every field.
EncodedPage smooth_page(const Encoding& encoding, float light) {
    EncodedPage out{8, 8, {}, {}};
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto x = static_cast<float>(i % 8), y = static_cast<float>(i / 8);
        if (i % 8 + i / 8 >= 9) {
            out.texel_at.push_back(kNone);
            continue;
        }
        out.texel_at.push_back(static_cast<std::uint32_t>(out.numbers.size()));
        Numbers numbers{};
        for (std::size_t f = 0; f < encoding.fields.size(); ++f) {
            const float value = 0.3f + 0.03f * x + 0.02f * y + 0.01f * static_cast<float>(f % 3);
            switch (encoding.fields[f].kind) {
                case FieldKind::light: numbers[f] = light * value; break;
                case FieldKind::signed_light: numbers[f] = light * (value - 0.5f); break;
                case FieldKind::ratio: numbers[f] = 2.0f * value - 1.0f; break;
                case FieldKind::unit: numbers[f] = value; break;
            }
        }
        out.numbers.push_back(numbers);
    }
    return out;
}

TEST(StoredPage, ComesBackInEveryStorage) {
    Context context(2);
    for (const Encoding* encoding : list_encodings())
        for (const TextureStorage& storage : texture_storages()) {
            const std::vector<StoredTexture> layout = texture_layout(*encoding, storage);
            if (layout.empty()) continue;
            SCOPED_TRACE(std::string(encoding->name) + " " + storage.name);
            const EncodedPage page = smooth_page(*encoding, 40.0f);
            const auto back = as_stored(*encoding, layout, page, BcQuality::fast, context);
            ASSERT_TRUE(back.ok());
            for (std::size_t t = 0; t < page.numbers.size(); ++t)
                for (std::size_t f = 0; f < encoding->fields.size(); ++f) {
                    const FieldKind kind = encoding->fields[f].kind;
                    // 3 % of the light, and 10 % where blocks cross zero, near which BC6H spends most of its codes; of
                    // ratios, whose range is 2, three steps of BC1's five bits.
                    const float bound = kind == FieldKind::light ? 1.2f : kind == FieldKind::signed_light ? 4.0f : 0.1f;
                    EXPECT_NEAR(back->numbers[t][f], page.numbers[t][f], bound) << t << ' ' << f;
                }
        }
}

TEST(StoredPage, ScalesLightThatHalvesDoNotHold) {
    Context context(1);
    for (const char* name : {"bc7", "rgb9e5", "rgba16f", "rgbm", "rgbd", "logluv", "rgbe"})
        for (const float light : {1e-6f, 1.0f, 1e4f, 3e7f}) {
            SCOPED_TRACE(std::string(name) + " " + std::to_string(light));
            const auto layout = texture_layout(kIrradianceEncoding, *find_texture_storage(name));
            const EncodedPage page = smooth_page(kIrradianceEncoding, light);
            const auto stored = store_page(kIrradianceEncoding, layout[0], page, BcQuality::normal, context);
            ASSERT_TRUE(stored.ok());
            const bool of_halves = format_info(layout[0].format).largest > 255.0f;
            if (of_halves) {
                EXPECT_EQ(std::ldexp(1.0f, std::ilogb(stored->scale)), stored->scale) << "a power of two";
                EXPECT_EQ(stored->scale == 1.0f, light == 1.0f || light == 1e4f);
            }
            EncodedPage back = page;
            read_back(kIrradianceEncoding, layout[0], *stored, back);
            for (std::size_t t = 0; t < page.numbers.size(); ++t)
                EXPECT_NEAR(back.numbers[t][0] / page.numbers[t][0], 1.0f, 0.03f);
        }
}

// The ratios of dark texels give way to those of bright ones, and what no chart covers costs nothing at all.
TEST(StoredPage, WeighsTexels) {
    Context context(1);
    const auto layout = texture_layout(kL1Hhd, *find_texture_storage("bc1"));
    // Four texels of light 10 with ratios on a line; the others' are all over the place.
    const auto worst_of_the_four = [&](float light_of_others, bool others_covered) {
        EncodedPage page{4, 4, {}, {}};
        for (std::uint32_t i = 0; i < 16; ++i) {
            const bool on_line = i < 4;
            page.texel_at.push_back(on_line || others_covered ? i : kNone);
            Numbers numbers{};
            for (std::size_t c = 0; c < 3; ++c) numbers[c] = on_line ? 10.0f : light_of_others;
            for (std::size_t f = 3; f < 12; ++f)
                numbers[f] =
                    on_line ? 0.2f * static_cast<float>(i) - 0.3f : std::sin(static_cast<float>(7 * i + 3 * f));
            page.numbers.push_back(numbers);
        }
        const auto back = as_stored(kL1Hhd, layout, page, BcQuality::best, context);
        EXPECT_TRUE(back.ok());
        float worst = 0.0f;
        for (std::size_t t = 0; t < 4; ++t)
            for (std::size_t f = 3; f < 12; ++f)
                worst = std::max(worst, std::fabs(back->numbers[t][f] - page.numbers[t][f]));
        return worst;
    };
    // Four colours on a line, with ends of 5 bits: half a step of the ratios, which go from -1 to 1, and a little.
    constexpr float kExact = 0.04f;
    EXPECT_LT(worst_of_the_four(1e-3f, true), kExact);
    EXPECT_LT(worst_of_the_four(10.0f, false), kExact);
    EXPECT_GT(worst_of_the_four(10.0f, true), 3.0f * kExact) << "the others are no burden: this test says nothing";
}

}  // namespace
}  // namespace lumel
