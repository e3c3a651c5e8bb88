#include "bake/chart_options.h"

#include <algorithm>

#include "chart/atlas_record.h"

namespace lumel {
namespace {

Uv1Policy uv1_policy(Uv1Choice choice) {
    switch (choice) {
        case Uv1Choice::automatic: return Uv1Policy::automatic;
        case Uv1Choice::scene: return Uv1Policy::scene;
        case Uv1Choice::mesh: return Uv1Policy::mesh;
        case Uv1Choice::ignore: return Uv1Policy::ignore;
    }
    return Uv1Policy::automatic;
}

}  // namespace

ChartOptions chart_options(const BakeOptions& options) {
    ChartOptions out;
    out.uv1 = uv1_policy(options.uv1);
    out.resolution_width = options.resolution_width;
    out.resolution_height = options.resolution_height;
    out.max_page = options.max_page;
    out.texels_per_metre = options.texels_per_metre;
    out.texel_budget = preset_values(options.preset).texel_budget;
    out.atlas_bytes = options.atlas_bytes;
    out.bytes_per_texel = options.bytes_per_texel;
    if (options.max_memory_bytes != 0) out.max_mask_bytes = std::min(out.max_mask_bytes, options.max_memory_bytes);
    out.page_clusters = options.page_clusters;
    out.pages = options.pages;
    out.previous = options.atlas.get();
    if (out.previous) out.masks = out.previous->masks;
    out.masks.filter = options.filter.value_or(out.masks.filter);
    out.masks.mips = options.mips.value_or(out.masks.mips);
    out.masks.block = options.block.value_or(out.masks.block);
    // What is looked at before anything is packed takes the bytes for texels.
    if (options.atlas_bytes > 0)
        out.texel_budget = static_cast<double>(options.atlas_bytes) / (options.bytes_per_texel * mip_sum(out.masks));
    return out;
}

}  // namespace lumel
