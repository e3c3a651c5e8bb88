#include "io/light_record.h"

#include "base/hash.h"
#include "base/try.h"
#include "encode/irradiance.h"
#include "io/image_io.h"
#include "io/light_json.h"
#include "io/page_files.h"
#include "io/read_manifest.h"
#include "io/relative_path.h"
#include "path/radiance_sums.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxSkyFile = std::uint64_t{8} << 30;

Result<Vec3> color_or_white(const Json& object, const std::string& where) {
    LUMEL_TRY(const auto color, (numbers_or<3>(object, "color", {1, 1, 1}, where)));
    return Vec3{static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
}

Status read_sky_record(const Json& json, const fs::path& folder, const std::string& where, LightRecord& out) {
    LUMEL_TRY(const std::string source, required_string(json, "source", where));
    if (source == "color") {
        LUMEL_TRY(out.sky.color, color_or_white(json, where));
    }
    if (source == "file") {
        LUMEL_TRY(const std::string file, required_string(json, "file", where));
        out.sky.file = found_from_here(folder, file);
        LUMEL_TRY(out.sky_hash, required_string(json, "hash", where));
    }
    LUMEL_TRY(out.sky.intensity, number_or(json, "intensity", 1.0, where));
    LUMEL_TRY(out.sky.rotation_degrees, number_or(json, "rotation_degrees", 0.0, where));
    LUMEL_TRY(out.sky.blur_degrees, number_or(json, "blur_degrees", 0.0, where));
    LUMEL_TRY(out.sky.extract_sun, bool_or(json, "extract_sun", false, where));
    return success();
}

Status read_sun_record(const Json& json, const std::string& where, SunOptions& out) {
    if (json.is_null()) return success();
    LUMEL_TRY(const auto direction, (numbers_or<3>(json, "direction", {0, -1, 0}, where)));
    out.direction =
        Vec3{static_cast<float>(direction[0]), static_cast<float>(direction[1]), static_cast<float>(direction[2])};
    LUMEL_TRY(out.illuminance, number_or(json, "illuminance", out.illuminance, where));
    LUMEL_TRY(out.color, color_or_white(json, where));
    LUMEL_TRY(out.angle_degrees, number_or(json, "angle_degrees", 0.0, where));
    return success();
}

Result<Include> read_include(const Json& layers, const std::string& where) {
    Include out{false, false, false};
    LUMEL_TRY(const Json* names, optional_array(layers, "included", where));
    if (!names) return invalid(where, "does not say which layers are included");
    for (const Json& name : *names) {
        if (name == "direct") out.direct = true;
        if (name == "sky") out.sky = true;
        if (name == "indirect") out.indirect = true;
    }
    return out;
}

Result<LightRecord> read_record(const Json& manifest, const fs::path& folder, const std::string& where) {
    LightRecord out;
    LUMEL_TRY(out.input_hash, required_string(manifest, "input_hash", where));
    LUMEL_TRY(const Json* layers, optional_object(manifest, "layers", where));
    LUMEL_TRY(const Json* light, optional_object(manifest, "light", where));
    if (!layers || !light) return invalid(where, "does not say what lit the bake");
    LUMEL_TRY(out.include, read_include(*layers, where + ": layers"));
    LUMEL_TRY(const Json* sky, optional_object(*light, "sky", where));
    if (sky) LUMEL_TRY_STATUS(read_sky_record(*sky, folder, where + ": sky", out));
    if (const Json* sun = find(*light, "sun")) LUMEL_TRY_STATUS(read_sun_record(*sun, where + ": sun", out.sun));
    LUMEL_TRY(out.direct_scale, number_or(*light, "direct_scale", 1.0, where));
    LUMEL_TRY(out.indirect_scale, number_or(*light, "indirect_scale", 1.0, where));
    return out;
}

}  // namespace

Json sky_json(const SkyOptions& sky, const std::string& sky_hash, const fs::path& folder) {
    Json out;
    if (sky.color) {
        out["source"] = "color";
        out["color"] = json_array(*sky.color);
    } else if (!sky.file.empty()) {
        out["source"] = "file";
        out["file"] = relative_to(folder, sky.file);
        out["hash"] = sky_hash;
    } else {
        out["source"] = "scene";
    }
    out["intensity"] = sky.intensity;
    out["rotation_degrees"] = sky.rotation_degrees;
    out["blur_degrees"] = sky.blur_degrees;
    out["extract_sun"] = sky.extract_sun;
    return out;
}

Json sun_json(const SunOptions& sun) {
    if (!sun.direction) return nullptr;
    return {{"direction", json_array(*sun.direction)},
            {"illuminance", sun.illuminance},
            {"color", json_array(sun.color)},
            {"angle_degrees", sun.angle_degrees}};
}

Json layer_names(const Include& include) {
    const LayerWeights weights = layer_weights(include);
    Json out = Json::array();
    for (std::size_t l = 0; l < kLayerCount; ++l)
        if (weights[l] != 0.0f) out.push_back(kLayerNames[l]);
    return out;
}

Result<LightRecord> read_light_record(const fs::path& folder) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_manifest(folder));
    return parse_light_record({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, folder,
                              (folder / kManifestFile).string());
}

Result<LightRecord> parse_light_record(std::string_view manifest, const fs::path& folder, const std::string& where) {
    LUMEL_TRY(const Json json, parse_json(manifest, where));
    Result<LightRecord> record = read_record(json, folder, where);
    if (record.ok()) return record;
    Error error = record.error();
    if (error.remedy.empty())
        error.remedy = "give the output folder of lumel bake; bake again if an older one wrote it";
    return error;
}

Result<std::string> hash_file(const fs::path& path) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(path, kMaxSkyFile));
    return Hasher().bytes(bytes).finish().hex();
}

}  // namespace lumel
