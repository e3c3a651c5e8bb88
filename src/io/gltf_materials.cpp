// Factors, alpha modes and emission of glTF materials; what a diffuse bake leaves out is noted.
#include "io/gltf_materials.h"

#include <algorithm>
#include <map>

#include "base/try.h"
#include "io/gltf_textures.h"

namespace lumel {
namespace {

Vec3 to_vec3(const std::array<double, 3>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

// Extensions that change how a surface looks in ways a diffuse bake leaves out.
constexpr const char* kIgnoredExtensions[] = {"KHR_materials_transmission", "KHR_materials_clearcoat",
                                              "KHR_materials_sheen", "KHR_materials_volume",
                                              "KHR_materials_iridescence"};

class MaterialReader {
public:
    MaterialReader(const GltfDocument& document, TextureLoader& textures, Diagnostics& diagnostics)
        : document_(document), textures_(textures), diagnostics_(diagnostics) {}

    Result<Material> read(std::size_t index, bool used) {
        LUMEL_TRY(const Json* json, element(document_.root, "materials", index, document_.where));
        name_ = label("material", index, *json);
        where_ = document_.where + ": " + name_;
        used_ = used;
        Material material;
        LUMEL_TRY(material.name, string_or(*json, "name", "material " + std::to_string(index), where_));
        LUMEL_TRY_STATUS(read_base_color(*json, material));
        LUMEL_TRY_STATUS(read_emission(*json, material));
        LUMEL_TRY_STATUS(read_alpha(*json, material));
        LUMEL_TRY(material.double_sided, bool_or(*json, "doubleSided", false, where_));
        if (used) note_extensions(*json);
        return material;
    }

private:
    Status read_base_color(const Json& json, Material& material) {
        if (const Json* gloss = find_extension(json, "KHR_materials_pbrSpecularGlossiness"))
            return read_color(*gloss, "diffuseFactor", "diffuseTexture", material);
        LUMEL_TRY(const Json* pbr, optional_object(json, "pbrMetallicRoughness", where_));
        return pbr ? read_color(*pbr, "baseColorFactor", "baseColorTexture", material) : success();
    }

    Status read_color(const Json& json, const char* factor_key, const char* texture_key, Material& material) {
        LUMEL_TRY(auto factor, (numbers_or<4>(json, factor_key, {1, 1, 1, 1}, where_)));
        for (double& value : factor) {
            if (value >= 0.0 && value <= 1.0) continue;
            diagnostics_.add("clamped-factor", "Colour factors outside [0, 1] were clamped", name_);
            value = std::clamp(value, 0.0, 1.0);
        }
        material.base_color = to_vec3({factor[0], factor[1], factor[2]});
        material.alpha = static_cast<float>(factor[3]);
        LUMEL_TRY(material.base_color_texture, read_texture(json, texture_key, used_));
        return success();
    }

    Status read_emission(const Json& json, Material& material) {
        LUMEL_TRY(const auto factor, (numbers_or<3>(json, "emissiveFactor", {0, 0, 0}, where_)));
        double strength = 1.0;
        if (const Json* extension = find_extension(json, "KHR_materials_emissive_strength")) {
            LUMEL_TRY(strength, number_or(*extension, "emissiveStrength", 1.0, where_));
        }
        material.emission = to_vec3(factor) * static_cast<float>(strength);
        if (!is_finite(material.emission) || std::min({factor[0], factor[1], factor[2], strength}) < 0.0)
            return invalid(where_, "its emission is negative or too large",
                           "correct emissiveFactor and emissiveStrength");
        const bool emits = max_component(material.emission) > 0.0f;
        LUMEL_TRY(material.emission_texture, read_texture(json, "emissiveTexture", used_ && emits));
        return success();
    }

    Status read_alpha(const Json& json, Material& material) {
        LUMEL_TRY(const std::string mode, string_or(json, "alphaMode", "OPAQUE", where_));
        if (mode == "MASK")
            material.alpha_mode = AlphaMode::mask;
        else if (mode == "BLEND")
            material.alpha_mode = AlphaMode::blend;
        else if (mode != "OPAQUE")
            return invalid(where_, "'alphaMode' is '" + mode + "', which glTF does not know");
        LUMEL_TRY(const double cutoff, number_or(json, "alphaCutoff", 0.5, where_));
        if (cutoff < 0.0) return invalid(where_, "'alphaCutoff' is negative");
        material.alpha_cutoff = static_cast<float>(cutoff);
        return success();
    }

    // The pixels are only fetched where they are `wanted`.
    Result<TextureRef> read_texture(const Json& json, const char* key, bool wanted) {
        LUMEL_TRY(const Json* info, optional_object(json, key, where_));
        if (!info || !wanted) return TextureRef{};
        return textures_.read(*info, std::string(key) + " of " + name_);
    }

    void note_extensions(const Json& json) {
        if (find_extension(json, "KHR_materials_diffuse_transmission"))
            diagnostics_.add("diffuse-transmission", "KHR_materials_diffuse_transmission is taken as opaque", name_);
        if (find_extension(json, "KHR_materials_unlit"))
            diagnostics_.add("unlit-material", "KHR_materials_unlit is taken as an ordinary diffuse surface", name_);
        for (const char* extension : kIgnoredExtensions)
            if (find_extension(json, extension))
                diagnostics_.add("ignored-extension", "Materials are baked as diffuse; these extensions change nothing",
                                 name_ + ": " + extension);
    }

    const GltfDocument& document_;
    TextureLoader& textures_;
    Diagnostics& diagnostics_;
    std::string name_, where_;
    bool used_ = false;
};

}  // namespace

Status read_materials(const GltfDocument& document, const std::vector<bool>& used, Scene& scene,
                      Diagnostics& diagnostics) {
    TextureLoader textures(document, scene.textures);
    MaterialReader reader(document, textures, diagnostics);
    for (std::size_t i = 0; i < array_size(document.root, "materials"); ++i) {
        LUMEL_TRY(Material material, reader.read(i, i < used.size() && used[i]));
        scene.materials.push_back(std::move(material));
    }
    Material fallback;
    fallback.name = "glTF default";
    scene.materials.push_back(std::move(fallback));
    return success();
}

}  // namespace lumel
