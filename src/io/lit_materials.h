// The materials of the no-code form: one clone per material and page that shows albedo x E/pi as its emission and
// reflects nothing. The originals stay, so that a loader can have them back.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "io/gltf_document_internal.h"

namespace lumel {

struct PageTexture {
    std::uint32_t texture = 0;  // glTF texture of the page
    float strength = 1.0f;      // times its value is albedo x E/pi
};

// Does any texture of the material (kNone: the default one) use TEXCOORD_1?
bool uses_uv1(const Json& root, std::uint32_t material);

class LitMaterials {
public:
    // Appends to root["materials"]; borrows it.
    LitMaterials(Json& root, std::vector<PageTexture> pages) : root_(root), pages_(std::move(pages)) {}

    // `material` is kNone for glTF's default one. `old_uv1`: the set to which the file's own TEXCOORD_1 moved to make
    // room; 1 where the material does not use it. Materials of KHR_materials_unlit show their colour whatever the light
    // is: they are returned as they are.
    std::uint32_t lit(std::uint32_t material, std::uint32_t page, std::uint32_t old_uv1);

    [[nodiscard]] bool is_unlit(std::uint32_t material) const;

private:
    std::uint32_t original(std::uint32_t material, std::uint32_t old_uv1);
    [[nodiscard]] Json clone(std::uint32_t material, std::uint32_t page, std::uint32_t old_uv1);
    std::uint32_t append(Json material);

    Json& root_;
    std::vector<PageTexture> pages_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> lit_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> originals_;
};

}  // namespace lumel
