// Any text as the manifest of an output folder: the masters that it names, the light that it records, which lights a
// scene, the layout that it records, which a level keeps, and whose texels are rasterised; and as its report: the
// warnings.
#include <algorithm>
#include <cstdio>

#include "base/check.h"
#include "fuzz/seed_corpus.h"
#include "io/atlas_record_read.h"
#include "io/bake_record.h"
#include "io/light_json.h"
#include "io/light_record.h"
#include "io/master.h"
#include "io/read_report.h"
#include "lumel/bake.h"
#include "scene/world_geometry.h"
#include "support/load_gltf.h"
#include "texel/texel_buffer.h"

namespace {

// A triangle of one metre, in one chart.
struct Level {
    Level() {
        scene = loaded.scene();
        geometry = lumel::flatten(scene, loaded.context).value();
        charts = lumel::make_charts(scene, geometry, {}, loaded.context).value();
    }
    static lumel::test::GltfBuilder built() {
        lumel::test::GltfBuilder builder;
        builder.node({{"name", "one"}, {"mesh", builder.triangle()}});
        return builder;
    }
    lumel::test::Loaded loaded{built()};
    lumel::Scene scene;
    lumel::WorldGeometry geometry;
    lumel::ChartSet charts;
};

const Level& level() {
    static const Level the_one;
    return the_one;
}

std::vector<std::byte> seed(const lumel::SkyOptions& sky, const lumel::SunOptions& sun, const lumel::Include& include) {
    lumel::Json manifest{{"generator", "Lumel"}, {"input_hash", "0123456789abcdef"}};
    manifest["layers"]["included"] = lumel::layer_names(include);
    manifest["light"] = {{"sky", lumel::sky_json(sky, "fedcba9876543210", "out")},
                         {"sun", lumel::sun_json(sun)},
                         {"direct_scale", 2.0},
                         {"indirect_scale", 0.5}};
    manifest["pages"].push_back({{"width", 8}, {"height", 16}, {"files", {{"master", {{"file", "master_0.exr"}}}}}});
    manifest["density"] = 8.0;
    manifest["scene_wide_uvs"] = false;
    const lumel::ChartName name = lumel::chart_names(level().scene, level().charts)[0];
    char id[17];
    std::snprintf(id, sizeof id, "%016llx", static_cast<unsigned long long>(name.id));
    manifest["instances"].push_back({{"transform", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}}, {"charts", {0, 1}}});
    manifest["geometry_hash"] = "0123456789abcdef";
    manifest["source_path"] = "../scene.glb";
    manifest["charts"] = {
        {"id", {id}}, {"page", {0}}, {"scale", {{8.0, 8.0}}}, {"offset", {{0.0, 2.0}}}, {"box", {{0, 2, 8, 8}}}};
    manifest["options"] = {{"seams", true}};
    manifest["warnings"] = {{{"code", "uv-bleeding"}, {"message", "m"}, {"count", 2}, {"examples", {"mesh 0"}}}};
    return lumel::fuzz::bytes_of(manifest.dump());
}

// A layout that was read keeps what it can of it: all charts are placed, on pages that have not shrunk.
void keep_layout(const lumel::AtlasRecord& record) {
    lumel::Context context(1);
    lumel::ChartOptions options;
    options.max_page = 16384;
    options.previous = &record;
    const auto atlas = lumel::make_atlas(level().scene, level().geometry, level().charts, options, context);
    if (!atlas.ok()) return;
    for (std::size_t p = 0; p < std::min(record.pages.size(), atlas->pages.size()); ++p)
        LUMEL_CHECK(atlas->pages[p].width == record.pages[p].width && atlas->pages[p].height >= record.pages[p].height,
                    p);
    for (const lumel::ChartPlacement& place : atlas->placements) {
        LUMEL_CHECK(place.page < atlas->pages.size(), place.page);
        LUMEL_CHECK(place.box.x + place.box.width <= atlas->pages[place.page].width, place.box.x);
        LUMEL_CHECK(place.box.y + place.box.height <= atlas->pages[place.page].height, place.box.y);
    }
}

// Charts that are where a manifest says have texels there, wherever that is.
void rasterize(const lumel::Atlas& layout) {
    constexpr std::uint64_t kFewPixels = 1u << 20;  // a page of more is only slow
    lumel::Context context(1);
    const auto by_page = lumel::triangles_by_page(level().scene, level().geometry, level().charts, layout);
    for (std::uint32_t p = 0; p < by_page.size(); ++p) {
        if (std::uint64_t{layout.pages[p].width} * layout.pages[p].height > kFewPixels) continue;
        const auto texels =
            lumel::rasterize_page(level().scene, level().geometry, level().charts, layout, p, by_page[p], context);
        LUMEL_CHECK(texels.ok());
    }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    lumel::SkyOptions color, map;
    color.color = {1.0f, 2.0f, 3.0f};
    color.intensity = 2.0;
    map.file = "sky.hdr";
    map.rotation_degrees = 90.0;
    map.blur_degrees = 5.0;
    map.extract_sun = true;
    lumel::SunOptions sun;
    sun.direction = {1.0f, -2.0f, 0.0f};
    sun.angle_degrees = 0.5;
    lumel::fuzz::seed_corpus(
        *argc, *argv, {seed({}, {}, {}), seed(color, sun, {true, false, false}), seed(map, sun, {false, true, true})});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto masters = lumel::parse_master_list({reinterpret_cast<const char*>(data), size}, "out", "fuzz.json");
    if (masters.ok())
        for (const lumel::MasterFile& page : masters->pages) LUMEL_CHECK(page.file.parent_path() == "out");
    const auto record = lumel::parse_light_record({reinterpret_cast<const char*>(data), size}, "out", "fuzz.json");
    const auto atlas = lumel::parse_atlas_record({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    if (atlas.ok()) keep_layout(*atlas);
    const auto remarks = lumel::parse_remarks({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    if (remarks.ok())
        for (const lumel::Diagnostic& warning : remarks->warnings)
            LUMEL_CHECK(warning.examples.size() <= lumel::Diagnostics::kMaxExamples, warning.examples.size());
    const auto bake = lumel::parse_bake_record({reinterpret_cast<const char*>(data), size}, "out", "fuzz.json");
    if (bake.ok() && lumel::check_charts(*bake, level().scene, level().charts).ok()) rasterize(bake->layout);
    if (!record.ok()) return 0;
    lumel::BakeOptions options;
    options.sky = record->sky;
    options.sun = record->sun;
    // As if the map had been loaded.
    lumel::Scene scene;
    if (!options.sky.file.empty()) scene.sky.map = lumel::SkyMap{4, 2, std::vector<lumel::Vec3>(8, {1.0f, 1.0f, 1.0f})};
    if (lumel::apply_lighting(scene, options).ok()) LUMEL_CHECK(lumel::validate_lighting(scene).ok());
    return 0;
}
