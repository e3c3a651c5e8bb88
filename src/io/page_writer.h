// The files of one lightmap page.
#pragma once

#include <filesystem>
#include <vector>

#include "encode/irradiance.h"
#include "image/image.h"
#include "io/gltf_write.h"
#include "io/manifest.h"
#include "post/lightmap.h"

namespace lumel {

// A page made small: means over the covered texels of each block.
struct PagePreview {
    Image irradiance;  // I, 3 channels
    Image samples;     // valid samples per texel, 1 channel
    std::vector<std::uint8_t> covered;
};

// Writes lightmap, irradiance, l1, master, ao, bent_normal and sky_visibility of the page; returns what the manifest
// says of them.
Result<ManifestPage> write_page_files(const std::filesystem::path& folder, const Lightmap& map,
                                      const LayerWeights& weights, const Context& context);

// albedo x I + emission as 8-bit sRGB over its strength. Strength is at most twice the brightest reflected light of the
// page; lamps brighter than that are cut to it, channel by channel, as a screen would.
LitTexture lit_texture(const Lightmap& map, const LayerWeights& weights);

// At most `max_edge` texels along the longer side.
PagePreview preview_of(const Lightmap& map, const LayerWeights& weights, std::uint32_t max_edge);

}  // namespace lumel
