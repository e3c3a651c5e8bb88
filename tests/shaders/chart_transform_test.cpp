// shaders/chart_transform.*: the compact form of lightmap UVs gives the texels of the expanded one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "io/gltf_accessor.h"
#include "io/gltf_container.h"
#include "io/gltf_write.h"
#include "io/image_io.h"
#include "io/layout_json.h"
#include "shaders/shader_types.h"
#include "support/scene_file.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace lumel {
namespace {

namespace glsl {
using namespace test::glsl;
#include "chart_transform.glsl"
}  // namespace glsl

TEST(ChartTransform, EntriesFillATextureRowByRow) {
    const auto texel = glsl::lumel_chart_texel(glsl::lumel_chart_index(1000, 29), 256);
    EXPECT_EQ(texel.x, 1029u - 4 * 256);
    EXPECT_EQ(texel.y, 4u);
}

// A scene.glb, its layout and the numbers of its accessors.
struct LitScene {
    LitScene(const std::filesystem::path& path, const ChartOptions& options) : scene(path, options) {
        // Loaded a second time for its document, which SceneFile lets go.
        auto loaded = load_scene(path, scene.context);
        std::vector<LitTexture> textures;
        for (std::size_t p = 0; p < scene.atlas.pages.size(); ++p)
            textures.push_back({encode_png(1, 1, 3, std::vector<std::uint8_t>(3)), 1.0f});
        const Status status = write_lit_gltf(
            folder / "scene.glb",
            {*loaded->document, loaded->scene, scene.charts, scene.atlas, textures, Include{}, std::string(32, '0')});
        EXPECT_TRUE(status.ok()) << status.error().text();
        document =
            read_document(read_file(folder / "scene.glb", 1u << 30).value(), folder / "scene.glb", "lit").value();
    }
    [[nodiscard]] AccessorView open(const Json& accessor) const { return open_accessor(*document, accessor).value(); }

    test::SceneFile scene;
    test::TemporaryFolder folder;
    GltfDocumentPtr document;
};

struct Compared {
    std::uint64_t vertices = 0, primitives = 0;
    double worst = 0.0;  // texels
};

// Every vertex of every primitive that has a lightmap.
Compared compare_forms(const LitScene& lit) {
    constexpr const char* kName = "LUMEL_lightmap";
    const Json& root = lit.document->root;
    const Json& all = root["extensions"][kName];
    const AccessorView transforms = lit.open(all["transforms"]), pages = lit.open(all["chartPages"]);
    EXPECT_EQ(transforms.count, lit.scene.atlas.placements.size());
    const Json manifest = charts_json(lit.scene.scene, lit.scene.charts, lit.scene.atlas)["transform"];
    for (std::uint32_t i = 0; i < transforms.count; ++i)
        for (std::uint32_t c = 0; c < 4; ++c) EXPECT_EQ(manifest[i][c].get<float>(), transforms.number(i, c)) << i;
    Compared out;
    for (const Json& node : root["nodes"]) {
        if (!node.contains("extensions") || !node["extensions"].contains(kName)) continue;
        const auto first = node["extensions"][kName]["firstChart"].get<std::uint32_t>();
        for (const Json& primitive : root["meshes"][node["mesh"].get<std::size_t>()]["primitives"]) {
            const Json& compact = primitive["extensions"][kName];
            if (!compact.contains("page")) continue;
            ++out.primitives;
            const AccessorView charts = lit.open(compact["charts"]), chart_uvs = lit.open(compact["chartUvs"]),
                               uvs = lit.open(primitive["attributes"]["TEXCOORD_1"]);
            const auto page = compact["page"].get<std::uint32_t>();
            const AtlasPage size = lit.scene.atlas.pages.at(page);
            for (std::uint32_t v = 0; v < uvs.count; ++v) {
                const std::uint32_t entry = glsl::lumel_chart_index(first, charts.index(v));
                if (uvs.number(v, 0) == 0.0f && uvs.number(v, 1) == 0.0f) continue;  // of a triangle without area
                EXPECT_EQ(pages.index(entry), page);
                const glsl::vec2 uv =
                    glsl::lumel_lightmap_uv({chart_uvs.number(v, 0), chart_uvs.number(v, 1)},
                                            {transforms.number(entry, 0), transforms.number(entry, 1),
                                             transforms.number(entry, 2), transforms.number(entry, 3)});
                out.worst = std::max({out.worst, std::abs(double{uv.x} - uvs.number(v, 0)) * size.width,
                                      std::abs(double{uv.y} - uvs.number(v, 1)) * size.height});
                ++out.vertices;
            }
        }
    }
    return out;
}

// Hardware filters between texels in steps of 1/256: nearer than that, both forms read the same.
constexpr double kSubTexel = 1.0 / 256.0;

class ChartTransformScenes : public testing::TestWithParam<const char*> {};

TEST_P(ChartTransformScenes, BothFormsGiveTheSameTexel) {
    const auto path = test::data_file(std::string("scenes/") + GetParam());
    if (!path) GTEST_SKIP() << "no " << GetParam() << ": set LUMEL_DATA";
    for (const std::uint32_t max_page : {4096u, 256u}) {
        ChartOptions options;
        options.max_page = max_page;
        const LitScene lit(*path, options);
        EXPECT_EQ(lit.scene.atlas.pages.size() == 1, lit.scene.charts.scene_wide || max_page == 4096);
        const Compared compared = compare_forms(lit);
        EXPECT_GT(compared.vertices, 100u);
        EXPECT_LT(compared.worst, kSubTexel);
        if (lit.scene.charts.scene_wide) {
            EXPECT_EQ(compared.worst, 0.0) << "a kept layout is kept to the bit";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Files, ChartTransformScenes,
                         testing::Values("godot_room.glb", "kenney_city.glb", "bench_courtyard.glb"),
                         [](const auto& info) {
                             const std::string name = info.param;
                             return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace lumel
