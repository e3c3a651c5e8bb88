// The files of one lightmap page.
#pragma once

#include <filesystem>
#include <vector>

#include "encode/irradiance.h"
#include "image/image.h"
#include "io/gltf_write.h"
#include "io/manifest.h"
#include "io/page_files.h"
#include "lumel/context.h"
#include "post/lightmap.h"

namespace lumel {

// A page made small: means over the covered texels of each block.
struct PagePreview {
    Image irradiance;  // I, 3 channels
    Image samples;     // samples per texel, 1 channel
    std::vector<std::uint8_t> covered;
};

// How far the writing of a page is: stage "write" of the context. A unit of work is a channel of an EXR file.
class WriteProgress {
public:
    WriteProgress(Context& context, double total) : context_(context), total_(total) {}

    [[nodiscard]] Context& context() { return context_; }
    void within(double work) const { context_.report("write", (done_ + work) / total_); }
    void add(double work) {
        done_ += work;
        within(0.0);
    }

private:
    Context& context_;
    double total_, done_ = 0.0;
};

inline constexpr double kPngWork = 2.0;  // of a channel of 8 bits, compressed on one thread
// Of write_page_files: lightmap, irradiance, l1, bent normal; master; two grey pictures.
inline constexpr double kPageWork = 3 + 3 + 12 + 3 + kLayerCount * (3 * kShCoefficients + 3) + 8 + 2 * kPngWork;

// Of a pixel in all its files, previews and picture too, uncompressed and at their widest.
inline constexpr std::uint64_t kPagePixelBytes =
    sizeof(float) * (3 + 3 + 12 + kLayerCount * (3 * kShCoefficients + 3) + 8) + 3 * sizeof(float) / 2 + 2 + 4 * 3;

// Writes lightmap, irradiance, l1, master, ao, bent_normal and sky_visibility of the page; returns what the manifest
// says of them. `unit`: of the light in each file; tests ask for others than the manifest states. Errors: io;
// cancelled.
Result<ManifestPage> write_page_files(const std::filesystem::path& folder, const Lightmap& map,
                                      const LayerWeights& weights, WriteProgress& progress,
                                      LightUnit (*unit)(PageFile) = unit_of);

// albedo x I + emission as 8-bit sRGB over its strength. Strength is at most twice the brightest reflected light of the
// page; lamps brighter than that are cut to it, channel by channel, as a screen would.
LitTexture lit_texture(const Lightmap& map, const LayerWeights& weights);

// At most `max_edge` texels along the longer side.
PagePreview preview_of(const Lightmap& map, const LayerWeights& weights, std::uint32_t max_edge);

}  // namespace lumel
