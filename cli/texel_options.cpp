// Options of density, pages and charts: what bake and atlas lay out alike.
#include <charconv>
#include <cstdio>

#include "base/try.h"
#include "chart/chart_mask.h"
#include "command.h"
#include "io/atlas_record_read.h"

namespace lumel::cli {
namespace {

constexpr std::uint32_t kMostPages = 1024;

}  // namespace

void TexelOptions::declare(CLI::App& app) {
    app.add_option("--preset", preset_,
                   "preview, medium or production: texels, and samples of a bake, where not asked otherwise")
        ->check(CLI::IsMember({"preview", "medium", "production"}));
    const std::string group = "Texels";
    app.add_option("--texels-per-metre", values_.texels_per_metre, "Density (0: from the preset's texel budget)")
        ->check(between(0.0, 1e6))
        ->group(group);
    app.add_option("--atlas-bytes", values_.atlas_bytes,
                   "Density such that all texels of pages and mips take no more (units: KiB, MiB, GiB; 0: not asked)")
        ->transform(CLI::AsSizeValue(false))
        ->group(group);
    app.add_option("--bytes-per-texel", values_.bytes_per_texel,
                   "What --atlas-bytes counts a texel as: 1 is BC6H or BC7")
        ->check(between(0.5, 1024.0))
        ->group(group);
    app.add_option("--resolution", resolution_, "WxH of the one page")
        ->default_str("pages as large as the density asks")
        ->check(not_empty())
        ->group(group);
    app.add_option("--max-page", values_.max_page, "Largest page edge in texels")
        ->check(CLI::Range(64u, 16384u))
        ->group(group);
    app.add_option("--pages", pages_, "auto (few), cluster (each holds what is near by) or how many of such, 1 to 1024")
        ->group(group);
    app.add_option("--uv1", uv1_,
                   "TEXCOORD_1: automatic, scene (keep as one atlas), mesh (keep charts, repack), ignore")
        ->check(CLI::IsMember({"automatic", "scene", "mesh", "ignore"}))
        ->group(group);
    app.add_option(
           "--atlas", atlas_,
           "manifest.json or atlas.json whose layout to keep: charts that are still the same stay where they were")
        ->default_str("a new layout")
        ->check(not_empty())
        ->group(group);
    filter_option_ = app.add_option("--filter", filter_, "How lightmaps are looked up: bilinear or bicubic")
                         ->check(CLI::IsMember({"bilinear", "bicubic"}))
                         ->group(group);
    mips_option_ = app.add_option("--mips", mips_, "Mips that hold no two charts in a texel, and are written: 1 to N")
                       ->check(CLI::Range(0u, MaskRule::kMaxMips))
                       ->group(group);
    block_option_ = app.add_option("--block", block_, "4: charts share no block of 4 x 4 texels, for BC formats; or 1")
                        ->check(CLI::IsMember({1u, 4u}))
                        ->group(group);
}

Status TexelOptions::read(BakeOptions& out) const {
    out.preset = preset_ == "preview" ? Preset::preview : preset_ == "medium" ? Preset::medium : Preset::production;
    out.texels_per_metre = values_.texels_per_metre;
    out.max_page = values_.max_page;
    out.atlas_bytes = values_.atlas_bytes;
    out.bytes_per_texel = values_.bytes_per_texel;
    if (pages_ == "cluster")
        out.page_clusters = true;
    else if (pages_ != "auto") {
        const auto [end, error] = std::from_chars(pages_.data(), pages_.data() + pages_.size(), out.pages);
        if (error != std::errc{} || end != pages_.data() + pages_.size() || out.pages == 0 || out.pages > kMostPages)
            return Error{ErrorCode::usage, "--pages: '" + pages_ + "' is none of auto, cluster and 1 to 1024", {}, {}};
    }
    if (!resolution_.empty()) {
        LUMEL_TRY(const Size size, parse_size(resolution_, "--resolution"));
        out.resolution_width = size.width;
        out.resolution_height = size.height;
    }
    out.uv1 = uv1_ == "scene"    ? Uv1Choice::scene
              : uv1_ == "mesh"   ? Uv1Choice::mesh
              : uv1_ == "ignore" ? Uv1Choice::ignore
                                 : Uv1Choice::automatic;
    if (filter_option_->count() > 0) out.filter = filter_ == "bicubic" ? LookupFilter::bicubic : LookupFilter::bilinear;
    if (mips_option_->count() > 0) out.mips = mips_;
    if (block_option_->count() > 0) out.block = block_;
    if (!atlas_.empty()) {
        LUMEL_TRY(out.atlas, read_atlas_record(atlas_));
    }
    return success();
}

void print_kept(std::uint64_t kept, std::uint64_t charts, const AtlasRecord& record) {
    std::printf("%llu of %llu charts lie where %s has them\n", static_cast<unsigned long long>(kept),
                static_cast<unsigned long long>(charts), record.where.c_str());
}

}  // namespace lumel::cli
