// The master of a page, read back: the light of its texels, summed over layers, from which encodings are solved.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "encode/irradiance.h"
#include "lumel/result.h"
#include "sh/coefficients.h"

namespace lumel {

// Covered texels row by row: those that were baked, filled and dilated.
struct MasterPage {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> texel_at;  // width*height: index of the texel, or kNone
    std::vector<std::uint8_t> coverage;   // 3 baked, 2 filled, 1 dilated
    std::vector<RadianceSh<Vec3, 9>> radiance;
    std::vector<Vec3> irradiance, normal;  // I about n_v; n_v, unit length

    [[nodiscard]] std::size_t size() const { return normal.size(); }
};

// A master as the manifest of its bake describes it.
struct MasterFile {
    std::filesystem::path file;
    std::uint32_t width = 0, height = 0;
    std::vector<MasterFile> mips;  // from mip 1 on, as many as the bake wrote; these have none
};
struct MasterList {
    std::filesystem::path manifest;
    std::string manifest_hash;
    std::vector<MasterFile> pages;
};

// The masters of an output folder, by its manifest. Errors: io; invalid_input where it is no manifest of ours.
Result<MasterList> list_masters(const std::filesystem::path& folder);
// The same from the manifest's text, which `where` names in messages.
Result<MasterList> parse_master_list(std::string_view manifest, const std::filesystem::path& folder,
                                     const std::string& where);
// An error where another bake has replaced this one.
Status check_unchanged(const MasterList& list);

// An error, too, where the file is of another size than the manifest says.
Result<MasterPage> read_master(const MasterFile& master, const LayerWeights& layers);

// master_<page>.exr. Errors: io; invalid_input where it is no master, or holds what is not finite, or no normals.
Result<MasterPage> read_master(const std::filesystem::path& file, const LayerWeights& layers);
Result<MasterPage> decode_master(std::span<const std::byte> exr, const LayerWeights& layers, const std::string& where);

}  // namespace lumel
