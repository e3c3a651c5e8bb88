#include "io/lit_materials.h"

#include "base/check.h"
#include "io/json_write.h"

namespace lumel {
namespace {

// Is this object a textureInfo, or KHR_texture_transform inside one, with texCoord 1? `extras` belong to others.
bool names_uv1(const Json& json) {
    if (json.is_array()) {
        for (const Json& item : json)
            if (names_uv1(item)) return true;
        return false;
    }
    if (!json.is_object()) return false;
    if (const Json* set = find(json, "texCoord"); set && *set == 1) return true;
    for (const auto& [key, value] : json.items())
        if (key != "extras" && names_uv1(value)) return true;
    return false;
}

void move_uv1(Json& json, std::uint32_t to) {
    if (json.is_array())
        for (Json& item : json) move_uv1(item, to);
    if (!json.is_object()) return;
    if (const auto set = json.find("texCoord"); set != json.end() && *set == 1) *set = to;
    for (const auto& [key, value] : json.items())
        if (key != "extras") move_uv1(value, to);
}

// Alpha and the texture that cuts it out, in both workflows.
struct Cutout {
    Json alpha = 1.0;
    const Json* texture = nullptr;
};

Cutout cutout_of(const Json& material) {
    Cutout out;
    const Json* glossy = find_extension(material, "KHR_materials_pbrSpecularGlossiness");
    const Json* pbr = glossy ? glossy : find(material, "pbrMetallicRoughness");
    if (!pbr) return out;
    const Json* factor = find(*pbr, glossy ? "diffuseFactor" : "baseColorFactor");
    if (factor && factor->is_array() && factor->size() == 4) out.alpha = (*factor)[3];
    out.texture = find(*pbr, glossy ? "diffuseTexture" : "baseColorTexture");
    return out;
}

bool shows_alpha(const Json& material) {
    const Json* mode = find(material, "alphaMode");
    return mode && (*mode == "MASK" || *mode == "BLEND");
}

std::string name_of(const Json& material) {
    const Json* name = find(material, "name");
    return name && name->is_string() ? name->get<std::string>() : std::string("material");
}

}  // namespace

bool uses_uv1(const Json& root, std::uint32_t material) {
    return material != kNone && names_uv1(root["materials"][material]);
}

bool LitMaterials::is_unlit(std::uint32_t material) const {
    return material != kNone && find_extension(root_["materials"][material], "KHR_materials_unlit") != nullptr;
}

std::uint32_t LitMaterials::append(Json material) {
    Json& list = root_["materials"];
    if (!list.is_array()) list = Json::array();
    list.push_back(std::move(material));
    return static_cast<std::uint32_t>(list.size() - 1);
}

// What a loader puts back: the file's material, a copy that looks for its TEXCOORD_1 where it is now, or glTF's default
// one spelled out.
std::uint32_t LitMaterials::original(std::uint32_t material, std::uint32_t old_uv1) {
    if (material != kNone && old_uv1 == 1) return material;
    const auto [at, added] = originals_.try_emplace({material, old_uv1}, 0);
    if (added) {
        Json copy = material == kNone ? Json{{"name", "default"}} : root_["materials"][material];
        if (material != kNone) move_uv1(copy, old_uv1);
        at->second = append(std::move(copy));
    }
    return at->second;
}

Json LitMaterials::clone(std::uint32_t material, std::uint32_t page, std::uint32_t old_uv1) {
    const std::uint32_t restored = original(material, old_uv1);
    const Json source = root_["materials"][restored];
    const Cutout cutout = cutout_of(source);
    Json out;
    out["name"] = name_of(source) + ", lightmap " + std::to_string(page);
    out["pbrMetallicRoughness"] = {
        {"baseColorFactor", {0, 0, 0, cutout.alpha}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
    if (shows_alpha(source)) {
        out["alphaMode"] = source["alphaMode"];
        if (cutout.texture) out["pbrMetallicRoughness"]["baseColorTexture"] = *cutout.texture;
        if (const Json* cutoff = find(source, "alphaCutoff"); cutoff && source["alphaMode"] == "MASK")
            out["alphaCutoff"] = *cutoff;
    }
    if (const Json* sides = find(source, "doubleSided")) out["doubleSided"] = *sides;
    out["emissiveFactor"] = {1, 1, 1};
    out["emissiveTexture"] = {{"index", pages_[page].texture}, {"texCoord", 1}};
    out["extensions"] = {
        {"KHR_materials_emissive_strength", {{"emissiveStrength", json_number(pages_[page].strength)}}},
        {"KHR_materials_specular", {{"specularFactor", 0}}}};
    if (const Json* extras = find(source, "extras"); extras && extras->is_object()) out["extras"] = *extras;
    out["extras"]["lumel"] = {{"original", restored}, {"page", page}};
    return out;
}

std::uint32_t LitMaterials::lit(std::uint32_t material, std::uint32_t page, std::uint32_t old_uv1) {
    LUMEL_CHECK(page < pages_.size(), page, pages_.size());
    if (is_unlit(material)) return original(material, old_uv1);
    const auto [at, added] = lit_.try_emplace({material, page, old_uv1}, 0);
    if (added) at->second = append(clone(material, page, old_uv1));
    return at->second;
}

}  // namespace lumel
