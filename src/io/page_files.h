// The names of the files in the output folder, in one place.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "encode/units.h"

namespace lumel {

inline constexpr const char* kSceneFile = "scene.glb";
inline constexpr const char* kManifestFile = "manifest.json";
inline constexpr const char* kReportFile = "report.json";
inline constexpr const char* kViewStem = "preview_view_";  // preview_view_0.png: the truth beside the bake

// What marks scene.glb as ours, its nodes and primitives too (docs/formats.md).
inline constexpr const char* kLightmapExtension = "LUMEL_lightmap";

inline constexpr std::uint64_t kLargestPage = 16384;  // texels along an edge that a page may have

// What is written for each page.
enum class PageFile : std::uint8_t {
    lightmap,         // I = E/pi over the included layers
    irradiance,       // E, for three.js lightMap
    l1,               // first directional encoding
    master,           // all moments of all layers
    ao,               // ambient occlusion
    bent_normal,      // mean free direction
    sky_visibility,   // share of the sky that is seen
    preview_atlas,    // tone-mapped
    preview_charts,   // a colour per chart
    preview_samples,  // heat map of the sample counts
};
inline constexpr PageFile kPageFiles[] = {PageFile::lightmap,
                                          PageFile::irradiance,
                                          PageFile::l1,
                                          PageFile::master,
                                          PageFile::ao,
                                          PageFile::bent_normal,
                                          PageFile::sky_visibility,
                                          PageFile::preview_atlas,
                                          PageFile::preview_charts,
                                          PageFile::preview_samples};

struct PageFileName {
    const char* stem;
    const char* extension;
};
constexpr PageFileName page_file_name(PageFile kind) {
    switch (kind) {
        case PageFile::lightmap: return {"lightmap_", ".exr"};
        case PageFile::irradiance: return {"irradiance_", ".exr"};
        case PageFile::l1: return {"l1_", ".exr"};
        case PageFile::master: return {"master_", ".exr"};
        case PageFile::ao: return {"ao_", ".png"};
        case PageFile::bent_normal: return {"bent_normal_", ".exr"};
        case PageFile::sky_visibility: return {"sky_visibility_", ".png"};
        case PageFile::preview_atlas: return {"preview_atlas_", ".png"};
        case PageFile::preview_charts: return {"preview_charts_", ".png"};
        case PageFile::preview_samples: return {"preview_samples_", ".png"};
    }
    return {"", ""};
}

// The unit of light in a file: what the writer writes, the manifest says and readers take back. Files of other things
// have none.
constexpr LightUnit unit_of(PageFile kind) {
    return kind == PageFile::irradiance ? LightUnit::e : LightUnit::e_over_pi;
}

// "lightmap_0.exr"; of a mip of the page "lightmap_0_mip1.exr".
inline constexpr const char* kMipMark = "_mip";
inline std::string page_and_mip(std::uint32_t page, std::uint32_t mip) {
    return std::to_string(page) + (mip == 0 ? std::string() : kMipMark + std::to_string(mip));
}
inline std::string page_file(PageFile kind, std::uint32_t page, std::uint32_t mip = 0) {
    const PageFileName name = page_file_name(kind);
    return name.stem + page_and_mip(page, mip) + name.extension;
}

// Is a name this stem, digits, this extension?
inline bool is_numbered(std::string_view name, std::string_view stem, std::string_view extension) {
    if (name.size() <= stem.size() + extension.size() || !name.starts_with(stem) || !name.ends_with(extension))
        return false;
    const std::string_view number = name.substr(stem.size(), name.size() - stem.size() - extension.size());
    return std::ranges::all_of(number, [](char c) { return c >= '0' && c <= '9'; });
}

// The same, or with a mip behind the number: this stem, digits, "_mip", digits, this extension?
inline bool is_numbered_with_mip(std::string_view name, std::string_view stem, std::string_view extension) {
    if (is_numbered(name, stem, extension)) return true;
    const std::size_t mark = name.find(kMipMark, stem.size());
    if (mark == std::string_view::npos) return false;
    return is_numbered(name.substr(mark), kMipMark, extension) && is_numbered(name.substr(0, mark), stem, "");
}

// Is it page_file() of some page or mip?
inline bool is_page_file(PageFile kind, std::string_view name) {
    const PageFileName pattern = page_file_name(kind);
    return is_numbered_with_mip(name, pattern.stem, pattern.extension);
}

// "encoded_l2": of what `lumel encode` writes, as .json and, for each page and mip, _<page>.exr, _<page>_mip<k>.exr;
// textures are in encoded_target.h.
inline std::string encoded_stem(const std::string& encoding) { return "encoded_" + encoding; }
inline std::string encoded_page_file(const std::string& encoding, std::uint32_t page, std::uint32_t mip = 0) {
    return encoded_stem(encoding) + "_" + page_and_mip(page, mip) + ".exr";
}

}  // namespace lumel
