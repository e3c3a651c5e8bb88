// Any text as the manifest of an output folder: the masters that it names, the light that it records, which lights a
// scene.
#include "base/check.h"
#include "fuzz/seed_corpus.h"
#include "io/light_json.h"
#include "io/light_record.h"
#include "io/master.h"
#include "lumel/bake.h"
#include "scene/world_geometry.h"

namespace {

std::vector<std::byte> seed(const lumel::SkyOptions& sky, const lumel::SunOptions& sun, const lumel::Include& include) {
    lumel::Json manifest{{"generator", "Lumel"}, {"input_hash", "0123456789abcdef"}};
    manifest["layers"]["included"] = lumel::layer_names(include);
    manifest["light"] = {{"sky", lumel::sky_json(sky, "fedcba9876543210", "out")},
                         {"sun", lumel::sun_json(sun)},
                         {"direct_scale", 2.0},
                         {"indirect_scale", 0.5}};
    manifest["pages"].push_back({{"width", 8}, {"height", 16}, {"files", {{"master", {{"file", "master_0.exr"}}}}}});
    return lumel::fuzz::bytes_of(manifest.dump());
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
