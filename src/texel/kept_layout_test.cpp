// A layout that comes with the scene: texels against the reference's mask, positions against the scene's description.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "support/scene_file.h"
#include "support/test_data.h"

namespace lumel {
namespace {

// Binary PGM, 8 bits.
std::vector<std::uint8_t> read_pgm(const std::filesystem::path& path, std::uint32_t size) {
    std::ifstream in(path, std::ios::binary);
    std::string magic;
    std::uint32_t width = 0, height = 0, top = 0;
    in >> magic >> width >> height >> top;
    in.get();
    EXPECT_EQ(magic, "P5");
    EXPECT_EQ(width, size);
    EXPECT_EQ(height, size);
    std::vector<std::uint8_t> pixels(std::size_t{size} * size);
    in.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(pixels.size()));
    EXPECT_TRUE(in.good());
    return pixels;
}

ChartOptions one_page(std::uint32_t size) {
    ChartOptions options;
    options.resolution_width = options.resolution_height = size;
    return options;
}

class KeptLayout : public ::testing::TestWithParam<const char*> {};

TEST_P(KeptLayout, CoversTheReferencesValidTexels) {
    const std::string name = GetParam();
    const auto scene = test::data_file("scenes/bench_" + name + ".glb");
    const auto mask = test::data_file("reference/cycles/" + name + "_256_valid.pgm");
    if (!scene || !mask) GTEST_SKIP() << "needs the test data: set LUMEL_DATA";
    test::SceneFile file(*scene, one_page(256));
    ASSERT_TRUE(file.charts.scene_wide);
    const TexelBuffer texels = file.rasterize();
    const auto valid = read_pgm(*mask, 256);
    std::size_t wanted = 0;
    for (std::size_t i = 0; i < valid.size(); ++i) {
        if (valid[i] == 0) continue;
        ++wanted;
        ASSERT_NE(texels.texel_at[i], kNone) << "texel " << i % 256 << ", " << i / 256;
        // Their footprint lies wholly inside one chart.
        EXPECT_EQ(texels.valid[texels.texel_at[i]], ~std::uint64_t{0}) << "texel " << i % 256 << ", " << i / 256;
    }
    EXPECT_GT(wanted, 40000u);
    // The charts are aligned to texels of 512 or cut through those of 256: little more is covered than is valid or
    // hidden.
    EXPECT_LT(texels.size(), wanted * 5 / 4);
    EXPECT_EQ(file.context.diagnostics.count("chart-overlap"), 0u);
}

INSTANTIATE_TEST_SUITE_P(Reference, KeptLayout, ::testing::Values("cornell", "courtyard"));

// The floor of bench_cornell: texels 1..84 of 256 in both directions, from (-1, 0, -1) to (1, 0, 1).
TEST(KeptLayout, PositionsAreWhereTheSceneSaysTheyAre) {
    const auto scene = test::data_file("scenes/bench_cornell.glb");
    if (!scene) GTEST_SKIP() << "needs the test data: set LUMEL_DATA";
    test::SceneFile file(*scene, one_page(256));
    const TexelBuffer texels = file.rasterize();
    std::size_t checked = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        if (texels.x[i] < 1 || texels.x[i] >= 84 || texels.y[i] < 1 || texels.y[i] >= 84) continue;
        ++checked;
        const float s = (texels.x[i] + 0.5f - 1) / 83, t = (84 - (texels.y[i] + 0.5f)) / 83;
        EXPECT_NEAR(texels.position[i].x, -1 + 2 * s, 1e-5f);  // rounding of the file's float UVs
        EXPECT_NEAR(texels.position[i].y, 0.0f, 1e-6f);
        EXPECT_NEAR(texels.position[i].z, 1 - 2 * t, 1e-5f);
        EXPECT_NEAR(texels.world_size[i], 2.0f / 83, 1e-5f);
        EXPECT_NEAR(texels.normal[i].y, 1.0f, 1e-6f);
    }
    EXPECT_EQ(checked, 83u * 83u);
}

}  // namespace
}  // namespace lumel
