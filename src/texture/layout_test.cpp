#include "texture/layout.h"

#include <gtest/gtest.h>

#include "encode/encodings.h"

namespace lumel {
namespace {

std::vector<StoredTexture> layout_of(const Encoding& encoding, const char* storage) {
    const TextureStorage* found = find_texture_storage(storage);
    EXPECT_NE(found, nullptr) << storage;
    return found ? texture_layout(encoding, *found) : std::vector<StoredTexture>{};
}

using F = TexelFormat;
using Layout = std::vector<StoredTexture>;

TEST(TextureLayout, IsThatOfTheEncodings) {
    EXPECT_EQ(layout_of(kIrradianceEncoding, "bc7"), (Layout{{"I", F::bc6h_unsigned, 0, 3}}));
    EXPECT_EQ(layout_of(kL1Hhd, "bc7"), (Layout{{"L0", F::bc6h_unsigned, 0, 3},
                                                {"L1n.R", F::bc7, 3, 3},
                                                {"L1n.G", F::bc7, 6, 3},
                                                {"L1n.B", F::bc7, 9, 3}}));
    EXPECT_EQ(layout_of(kIrradZHhd, "bc7"), (Layout{{"I", F::bc6h_unsigned, 0, 3}, {"w-d", F::bc7, 3, 3}}));
    EXPECT_EQ(layout_of(kIrradZHhd, "bc45"),
              (Layout{{"I", F::bc6h_unsigned, 0, 3}, {"w", F::bc4, 3, 1}, {"d", F::bc5, 4, 2}}));
    EXPECT_EQ(layout_of(kIrradZHhdRgb, "bc1"),
              (Layout{{"I", F::bc6h_unsigned, 0, 3}, {"w", F::bc1, 3, 3}, {"d", F::bc1, 6, 2}}));
    EXPECT_EQ(layout_of(kHlsh, "bc7"), (Layout{{"I", F::bc6h_unsigned, 0, 3},
                                               {"A", F::bc6h_signed, 3, 3},
                                               {"Cx", F::bc6h_signed, 6, 3},
                                               {"Cy", F::bc6h_signed, 9, 3}}));
    EXPECT_TRUE(layout_of(kHlsh, "rgb9e5").empty()) << "no negative light";
    EXPECT_EQ(find_texture_storage("bc2"), nullptr);
}

TEST(TextureLayout, HoldsEachFieldOnce) {
    for (const Encoding* encoding : list_encodings())
        for (const TextureStorage& storage : texture_storages()) {
            const Layout layout = texture_layout(*encoding, storage);
            std::size_t next = 0;
            for (const StoredTexture& texture : layout) {
                EXPECT_EQ(texture.first, next) << encoding->name << ' ' << storage.name;
                EXPECT_LE(texture.count, format_info(texture.format).channels);
                next += texture.count;
            }
            EXPECT_EQ(next, layout.empty() ? 0 : encoding->fields.size()) << encoding->name;
        }
}

TEST(TextureLayout, HasTheBytesOfTheSeeds) {
    EXPECT_EQ(bytes_per_texel(layout_of(kL1Hazel, "bc7")), 4.0);
    EXPECT_EQ(bytes_per_texel(layout_of(kL1Hazel, "bc1")), 2.5);
    EXPECT_EQ(bytes_per_texel(layout_of(kIrradZHhd, "bc45")), 2.5);
    EXPECT_EQ(bytes_per_texel(layout_of(kIrradZHhd, "bc7")), 2.0);
    EXPECT_EQ(bytes_per_texel(layout_of(kIrradianceEncoding, "bc7")), 1.0);
}

}  // namespace
}  // namespace lumel
