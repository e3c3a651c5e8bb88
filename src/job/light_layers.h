// The light of a bake's files as layers: what lookups read, component by component.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "inspect/layer.h"
#include "io/master.h"
#include "lumel/page.h"
#include "lumel/result.h"

namespace lumel {

// A layer of the files: named ones, and FILE:CHANNELS for any channels of the EXR files of the pages, such as
// "master:sky.L4", "l1:L1n.R" or "encoded_h4:H1".
struct LightLayer {
    TexelLayer layer;
    std::string stem;                   // of the file of each page
    std::string extension;              // ".exr", ".png"
    std::vector<std::string> channels;  // in the file; of a PNG the first alone
};

// Those with names of their own, in the order in which they are listed.
std::span<const LightLayer> light_layers();

// FILE:CHANNELS. Error: usage, naming what there is.
Result<LightLayer> find_channels(const std::filesystem::path& folder, const std::string& name);

// FILE:CHANNELS of all EXR files of page 0 in the folder, sorted.
std::vector<std::string> all_channels(const std::filesystem::path& folder);

// Whether each texel of a page is baked, filled, dilated or empty. Errors: io; invalid_input.
Result<std::vector<Coverage>> read_coverage(const MasterFile& master);

// Errors: io; invalid_input where the file is not of the page.
Result<LayerPage> read_light_layer(const LightLayer& light, const MasterFile& master, std::uint32_t page,
                                   std::span<const Coverage> coverage);

// What the numbers of the pages turn out to be: those that have a sign are shown around zero.
void choose_rule(std::span<const LayerPage> pages, TexelLayer& layer);

}  // namespace lumel
