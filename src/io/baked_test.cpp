#include "io/baked.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/gltf_write.h"
#include "io/image_io.h"
#include "io/page_files.h"
#include "support/load_gltf.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

using test::GltfBuilder;
using test::Loaded;
using test::TemporaryFolder;

TEST(SampleBilinear, TexelCentresAreAtHalves) {
    Image image(2, 2, 3);
    for (std::size_t i = 0; i < 4; ++i) image.data[3 * i] = float(i);
    EXPECT_EQ(sample_bilinear(image, {0.25f, 0.25f}).x, 0.0f);
    EXPECT_EQ(sample_bilinear(image, {0.75f, 0.25f}).x, 1.0f);
    EXPECT_EQ(sample_bilinear(image, {0.5f, 0.5f}).x, 1.5f);
    EXPECT_EQ(sample_bilinear(image, {-3.0f, 0.75f}).x, 2.0f);  // clamped
    EXPECT_EQ(sample_bilinear(image, {9.0f, 9.0f}).x, 3.0f);
}

// A scene of one triangle in a folder as a bake leaves it; the lightmap's red is x in texels, its green y.
struct Folder {
    explicit Folder(const GltfBuilder& builder) : loaded(builder) {
        ChartOptions options;
        options.texels_per_metre = 32;
        geometry = flatten(loaded.scene(), loaded.context).value();
        charts = make_charts(loaded.scene(), geometry, options, loaded.context).value();
        atlas = make_atlas(loaded.scene(), geometry, charts, options, loaded.context).value();
        const AtlasPage page = atlas.pages.at(0);
        const std::vector<std::uint8_t> pixels(std::size_t{page.width} * page.height * 3);
        const std::vector<LitTexture> textures{{encode_png(page.width, page.height, 3, pixels), 1.0f}};
        EXPECT_TRUE(write_lit_gltf(folder / kSceneFile, {*loaded.result->document, loaded.scene(), charts, atlas,
                                                         textures, Include{}, hash_geometry(geometry)})
                        .ok());
        Image image(page.width, page.height, 3);
        for (std::uint32_t y = 0; y < page.height; ++y)
            for (std::uint32_t x = 0; x < page.width; ++x) {
                image.at(x, y)[0] = float(x) + 0.5f;
                image.at(x, y)[1] = float(y) + 0.5f;
            }
        EXPECT_TRUE(write_exr(folder / page_file(PageFile::lightmap, 0), image, ExrType::full).ok());
    }
    Loaded loaded;
    WorldGeometry geometry;
    ChartSet charts;
    Atlas atlas;
    TemporaryFolder folder;
};

GltfBuilder triangle_scene(float size = 1.0f) {
    GltfBuilder builder;
    builder.node({{"mesh", builder.triangle()}, {"scale", {size, size, size}}});
    return builder;
}

TEST(ReadBaked, LooksUpTheTexelThatTheAtlasGave) {
    const Folder f(triangle_scene());
    const auto baked = read_baked(f.folder.path(), f.loaded.scene(), f.geometry);
    ASSERT_TRUE(baked.ok()) << baked.error().text();
    const auto uv = f.atlas.triangle_uv(f.charts, f.geometry, f.loaded.scene(), 0);
    for (const Vec2 b : {Vec2{0.3f, 0.3f}, Vec2{0.1f, 0.6f}, Vec2{0.5f, 0.2f}}) {
        const Vec2 texel = uv.texels[0] * (1 - b.x - b.y) + uv.texels[1] * b.x + uv.texels[2] * b.y;
        const auto value = baked->irradiance(0, b.x, b.y);
        ASSERT_TRUE(value.has_value());
        // A linear image is interpolated exactly but for float rounding of coordinates of some 50 texels.
        EXPECT_NEAR(value->x, texel.x, 2e-5);
        EXPECT_NEAR(value->y, texel.y, 2e-5);
    }
}

TEST(ReadBaked, AnotherSceneIsRefused) {
    const Folder f(triangle_scene());
    const Loaded other(triangle_scene(2.0f));
    Context context(1);
    const WorldGeometry geometry = flatten(other.scene(), context).value();
    const auto baked = read_baked(f.folder.path(), other.scene(), geometry);
    ASSERT_FALSE(baked.ok());
    EXPECT_NE(baked.error().text().find("another scene"), std::string::npos);
}

TEST(ReadBaked, MissingOrForeignPagesAreErrors) {
    const Folder f(triangle_scene());
    ASSERT_TRUE(write_exr(f.folder / "lightmap_0.exr", Image(3, 3, 3), ExrType::full).ok());
    EXPECT_FALSE(read_baked(f.folder.path(), f.loaded.scene(), f.geometry).ok());
    std::filesystem::remove(f.folder / "lightmap_0.exr");
    EXPECT_FALSE(read_baked(f.folder.path(), f.loaded.scene(), f.geometry).ok());
}

TEST(ReadBaked, AnOrdinaryGltfIsNoBake) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_file(folder / kSceneFile, triangle_scene().glb()).ok());
    const Loaded loaded(triangle_scene());
    Context context(1);
    const auto baked = read_baked(folder.path(), loaded.scene(), flatten(loaded.scene(), context).value());
    ASSERT_FALSE(baked.ok());
    EXPECT_NE(baked.error().text().find("LUMEL_lightmap"), std::string::npos);
}

// Any flipped byte of the JSON or truncation: an error or other UVs, never a crash (run under sanitizers).
TEST(ReadBaked, DamagedFilesAreErrorsOrHarmless) {
    const Folder f(triangle_scene());
    const auto bytes = read_file(f.folder / kSceneFile, 1 << 20).value();
    std::size_t refused = 0;
    for (std::size_t i = 0; i < bytes.size(); i += 13) {
        auto damaged = bytes;
        damaged[i] ^= std::byte{0x11};
        std::ofstream(f.folder / "damaged.glb", std::ios::binary)
            .write(reinterpret_cast<const char*>(damaged.data()), static_cast<std::streamsize>(damaged.size()));
        refused += !read_baked_uvs(f.folder / "damaged.glb", f.loaded.scene(), f.geometry).ok();
    }
    EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace lumel
