#include "io/baked.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <span>

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

// A scene of triangles in a folder as a bake leaves it.
struct Folder {
    explicit Folder(const GltfBuilder& builder, double texels_per_metre = 32, std::uint32_t max_page = 4096)
        : loaded(builder) {
        ChartOptions options;
        options.texels_per_metre = texels_per_metre;
        options.max_page = max_page;
        geometry = flatten(loaded.scene(), loaded.context).value();
        charts = make_charts(loaded.scene(), geometry, options, loaded.context).value();
        atlas = make_atlas(loaded.scene(), geometry, charts, options, loaded.context).value();
        std::vector<LitTexture> textures;
        for (const AtlasPage& page : atlas.pages) {
            const std::vector<std::uint8_t> pixels(std::size_t{page.width} * page.height * 3);
            textures.push_back({encode_png(page.width, page.height, 3, pixels), 1.0f});
        }
        EXPECT_TRUE(write_lit_gltf(folder / kSceneFile, {*loaded.result->document, loaded.scene(), charts, atlas,
                                                         textures, Include{}, hash_geometry(geometry)})
                        .ok());
        for (std::uint32_t p = 0; p < atlas.pages.size(); ++p) write_page(p);
    }
    // Red is x in texels, green y, blue the page plus one.
    void write_page(std::uint32_t p) {
        Image image(atlas.pages[p].width, atlas.pages[p].height, 3);
        for (std::uint32_t y = 0; y < image.height; ++y)
            for (std::uint32_t x = 0; x < image.width; ++x) {
                image.at(x, y)[0] = float(x) + 0.5f;
                image.at(x, y)[1] = float(y) + 0.5f;
                image.at(x, y)[2] = float(p + 1);
            }
        EXPECT_TRUE(write_exr(folder / page_file(PageFile::lightmap, p), image, ExrType::full).ok());
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

// Three triangles, too large for two to share a page: as many parts as the memory makes necessary, one loaded at a
// time.
TEST(ReadBaked, PagesThatDoNotFitTogetherAreLoadedInParts) {
    GltfBuilder builder;
    const std::size_t triangle = builder.triangle();
    for (const float x : {0.0f, 2.0f, 4.0f}) builder.node({{"mesh", triangle}, {"translation", {x, 0, 0}}});
    const Folder f(builder, 60, 64);
    ASSERT_EQ(f.atlas.pages.size(), 3u);
    std::uint64_t page = 0;
    for (const AtlasPage& p : f.atlas.pages)
        page = std::max(page, loaded_page_bytes(std::uint64_t{p.width} * p.height));
    const auto read = [&](std::uint64_t bytes) {
        return read_baked(f.folder.path(), f.loaded.scene(), f.geometry, bytes).value();
    };
    EXPECT_EQ(read(0).parts(), 1u);
    EXPECT_EQ(read(4 * page).parts(), 1u) << "three pages, one of them twice";
    EXPECT_EQ(read(3 * page).parts(), 2u);
    EXPECT_EQ(read(1).parts(), 3u) << "less than a page is not possible";

    BakedLighting baked = read(1);
    for (const std::uint32_t part : {2u, 0u, 1u}) {
        ASSERT_TRUE(baked.load(part).ok());
        for (std::uint32_t t = 0; t < 3; ++t) {
            const std::uint32_t of = f.atlas.triangle_uv(f.charts, f.geometry, f.loaded.scene(), t).page;
            const auto light = baked.irradiance(t, 0.3f, 0.3f);
            ASSERT_TRUE(light.has_value()) << "it has texels, be they loaded or not";
            EXPECT_EQ(light->z, of == part ? float(of + 1) : 0.0f);
        }
    }
    std::filesystem::remove(f.folder / "lightmap_2.exr");
    EXPECT_FALSE(baked.load(2).ok());
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

// A NaN would be no place in a page.
TEST(ReadBaked, UvsThatAreNotFiniteAreRefused) {
    const Folder f(triangle_scene());
    const float uv = read_baked_uvs(f.folder / kSceneFile, f.loaded.scene(), f.geometry).value().at(0).uv[1].x;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    auto bytes = read_file(f.folder / kSceneFile, 1 << 20).value();
    const auto old_bytes = std::as_bytes(std::span(&uv, 1)), new_bytes = std::as_bytes(std::span(&nan, 1));
    // The last of equal bytes: UVs are written last.
    const auto at = std::find_end(bytes.begin(), bytes.end(), old_bytes.begin(), old_bytes.end());
    ASSERT_NE(at, bytes.end());
    std::copy(new_bytes.begin(), new_bytes.end(), at);
    ASSERT_TRUE(write_file(f.folder / kSceneFile, bytes).ok());
    const auto read = read_baked_uvs(f.folder / kSceneFile, f.loaded.scene(), f.geometry);
    ASSERT_FALSE(read.ok());
    EXPECT_NE(read.error().text().find("not finite"), std::string::npos) << read.error().text();
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
