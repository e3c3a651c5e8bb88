#include "io/bake_writer.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "base/check.h"
#include "base/hash.h"
#include "base/memory_use.h"
#include "base/try.h"
#include "chart/chart_picture.h"
#include "encode/output_sizes.h"
#include "image/colormap.h"
#include "image/tonemap.h"
#include "io/atomic_file.h"
#include "io/baked.h"
#include "io/gltf_write.h"
#include "io/image_io.h"
#include "io/manifest.h"
#include "io/output_folder.h"
#include "io/page_files.h"
#include "io/page_writer.h"

namespace lumel {
namespace {

void put_color(std::vector<std::uint8_t>& rgb, std::size_t pixel, Vec3 color) {
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * pixel + c] = static_cast<std::uint8_t>(color[c] * 255.0f + 0.5f);
}

// A colour per chart, black between them; every block-th texel of the page.
std::vector<std::uint8_t> chart_picture(const std::vector<std::uint32_t>& ids, const AtlasPage& page,
                                        const Image& like) {
    const std::uint32_t block = preview_block(page.width, page.height, kPreviewEdge);
    std::vector<std::uint8_t> out(std::size_t{like.width} * like.height * 3);
    for (std::uint32_t y = 0; y < like.height; ++y)
        for (std::uint32_t x = 0; x < like.width; ++x) {
            const std::uint32_t id = ids[std::size_t{y * block} * page.width + x * block];
            if (id != kNone) put_color(out, std::size_t{y} * like.width + x, identity_color(id));
        }
    return out;
}

std::vector<std::uint8_t> heat_map(const PagePreview& preview, float most) {
    std::vector<std::uint8_t> out(preview.covered.size() * 3);
    for (std::size_t i = 0; i < preview.covered.size(); ++i) {
        if (preview.covered[i] == 0) continue;
        put_color(out, i, heat_color(most > 0.0f ? preview.samples.data[i] / most : 0.0f));
    }
    return out;
}

// One exposure for all pages, from their covered texels: all of them, or every k-th so that some million are enough.
float exposure_of(const std::vector<PagePreview>& previews) {
    constexpr std::size_t kEnough = std::size_t{1} << 20;
    std::size_t covered = 0;
    for (const PagePreview& preview : previews)
        covered += static_cast<std::size_t>(std::ranges::count_if(preview.covered, [](auto c) { return c != 0; }));
    const std::size_t step = covered / kEnough + 1;
    Image some(0, 1, 3);
    some.data.reserve(3 * (covered / step + 1));
    std::size_t seen = 0;
    for (const PagePreview& preview : previews)
        for (std::size_t i = 0; i < preview.covered.size(); ++i) {
            if (preview.covered[i] == 0 || seen++ % step != 0) continue;
            const float* const pixel = &preview.irradiance.data[3 * i];
            some.data.insert(some.data.end(), pixel, pixel + 3);
        }
    some.width = static_cast<std::uint32_t>(some.data.size() / 3);
    // Enclosed and overlapped surfaces make much of an atlas dark: what is lit decides.
    return auto_exposure(some, {}, {0.9, 0.6f});
}

float most_samples(const std::vector<PagePreview>& previews) {
    float most = 0.0f;
    for (const PagePreview& preview : previews)
        for (const float count : preview.samples.data) most = std::max(most, count);
    return most;
}

// The files of all pages before they are compressed: no bake writes more but scene.glb, which is small beside them.
std::uint64_t output_bytes(const Atlas& atlas) {
    std::uint64_t pixels = 0;
    for (const AtlasPage& page : atlas.pages) pixels += std::uint64_t{page.width} * page.height;
    return pixels * kPagePixelBytes;
}

std::uint64_t bytes_in(const std::filesystem::path& folder) {
    std::error_code error;
    std::uint64_t sum = 0;
    for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (const std::uintmax_t size = at->file_size(error); !error) sum += size;
    return sum;
}

// The files that are baked must outlive the bake: baking out/scene.glb into out/ would replace it.
Status check_not_input(const std::filesystem::path& output, const std::filesystem::path& input) {
    if (input.empty() || !is_output_file(input.filename().string())) return success();
    std::error_code ignored;
    const std::filesystem::path folder = input.has_parent_path() ? input.parent_path() : ".";
    if (!std::filesystem::equivalent(folder, output, ignored)) return success();
    return Error{ErrorCode::io, "is read by this bake and would be replaced by its output", input.string(),
                 "choose another folder with -o"};
}

}  // namespace

struct BakeWriter::Impl {
    OutputFolder output;
    const LoadedScene& loaded;
    BakeOptions options;
    Context& context;
    ChartSet charts;
    Atlas atlas;
    std::string geometry_hash;
    std::vector<ManifestPage> pages;
    std::vector<LitTexture> textures;
    std::vector<PagePreview> previews;

    [[nodiscard]] std::filesystem::path file(PageFile kind, std::uint32_t page) const {
        return output.path() / page_file(kind, page);
    }

    Status write_chart_preview(std::uint32_t page) {
        const Image& like = previews[page].irradiance;
        const std::vector<std::uint32_t> ids = chart_ids(loaded.scene, charts, atlas, page);
        return write_png(file(PageFile::preview_charts, page), like.width, like.height, 3,
                         chart_picture(ids, atlas.pages[page], like));
    }

    // Of the page that was written last.
    Status write_mip(const Lightmap& lightmap) {
        LUMEL_CHECK(lightmap.page + 1 == pages.size() && lightmap.mip == pages.back().mips.size() + 1, lightmap.page,
                    lightmap.mip);
        WriteProgress progress(context, kPageWork);
        LUMEL_TRY(ManifestPage mip,
                  write_page_files(output.path(), lightmap, layer_weights(options.include), progress));
        pages.back().mips.push_back(std::move(mip));
        return success();
    }

    Status write_page(const Lightmap& lightmap) {
        LUMEL_CHECK(lightmap.page == pages.size(), lightmap.page, pages.size());
        const LayerWeights weights = layer_weights(options.include);
        WriteProgress progress(context, kPageWork + 3 * kPngWork);
        LUMEL_TRY(ManifestPage page, write_page_files(output.path(), lightmap, weights, progress));
        textures.push_back(lit_texture(lightmap, weights));
        warn_of_cut_light(textures.back(), lightmap.page);
        progress.add(3 * kPngWork);
        page.display_strength = textures.back().strength;
        previews.push_back(preview_of(lightmap, weights, kPreviewEdge));
        LUMEL_TRY_STATUS(write_chart_preview(lightmap.page));
        for (const PageFile kind : {PageFile::preview_atlas, PageFile::preview_charts, PageFile::preview_samples})
            page.files.push_back({kind, "8-bit"});
        pages.push_back(std::move(page));
        return success();
    }

    void warn_of_cut_light(const LitTexture& texture, std::uint32_t page) const {
        if (texture.cut_texels == 0) return;
        char where[80];
        std::snprintf(where, sizeof where, "page %u, the brightest %.1f times too dark", page,
                      static_cast<double>(texture.cut_ratio));
        context.diagnostics.add("display-cut",
                                "The 8-bit texture of scene.glb shows these texels darker than they are, so that "
                                "all others keep their codes; the .exr files have their light",
                                where, texture.cut_texels);
    }

    [[nodiscard]] Status write_scene() const {
        return write_lit_gltf(output.path() / kSceneFile, {*loaded.document, loaded.scene, charts, atlas, textures,
                                                           options.include, geometry_hash});
    }

    Status finish(BakeReport& report, const Diagnostics& diagnostics) {
        LUMEL_TRY_STATUS(write_previews());
        const ManifestInput input{loaded.scene, charts,        atlas,           options,      report,
                                  pages,        geometry_hash, loaded.sky_hash, output.path()};
        LUMEL_TRY_STATUS(write_manifest(input));
        report.peak_memory_bytes = peak_memory();
        return write_report(input, diagnostics);
    }

    Status write_previews() {
        // Where texels stop by themselves the heat is their share of the budget.
        const float exposure = exposure_of(previews), most = options.stop == StopRule::fixed
                                                                 ? most_samples(previews)
                                                                 : static_cast<float>(sample_budget(options));
        for (std::uint32_t p = 0; p < previews.size(); ++p) {
            const Image& image = previews[p].irradiance;
            LUMEL_TRY_STATUS(
                write_png(file(PageFile::preview_atlas, p), image.width, image.height, 3, tonemap(image, exposure)));
            LUMEL_TRY_STATUS(write_png(file(PageFile::preview_samples, p), image.width, image.height, 3,
                                       heat_map(previews[p], most)));
        }
        return success();
    }
};

BakeWriter::BakeWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BakeWriter::~BakeWriter() = default;
BakeWriter::BakeWriter(BakeWriter&&) noexcept = default;
BakeWriter& BakeWriter::operator=(BakeWriter&&) noexcept = default;

Result<BakeWriter> BakeWriter::create(const std::filesystem::path& output, const LoadedScene& loaded,
                                      const BakeOptions& options, Context& context) {
    LUMEL_TRY_STATUS(check_not_input(output, loaded.scene.source));
    LUMEL_TRY_STATUS(check_not_input(output, options.sky.file));
    LUMEL_TRY(OutputFolder folder, OutputFolder::create(output));
    return BakeWriter(
        std::unique_ptr<Impl>(new Impl{std::move(folder), loaded, options, context, {}, {}, {}, {}, {}, {}}));
}

const std::filesystem::path& BakeWriter::folder() const { return impl_->output.path(); }

Status BakeWriter::explain(Status status) const {
    if (status.ok()) return status;
    Error error = impl_->output.as_in_target(std::move(status).error());
    if (error.code == ErrorCode::io && is_disk_full(error) && !impl_->atlas.pages.empty())
        error.remedy += "; the whole output takes up to " + megabytes(output_bytes(impl_->atlas)) + ", of which " +
                        megabytes(bytes_in(folder())) + " were written";
    return error;
}

Status BakeWriter::layout(const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas) {
    impl_->charts = charts;
    impl_->atlas = atlas;
    impl_->geometry_hash = hash_geometry(geometry);
    return success();
}

Status BakeWriter::page(const Lightmap& lightmap) {
    return explain(lightmap.mip == 0 ? impl_->write_page(lightmap) : impl_->write_mip(lightmap));
}

Status BakeWriter::write_scene() { return explain(impl_->write_scene()); }

Status BakeWriter::write_view(std::size_t k, std::uint32_t width, std::uint32_t height,
                              std::span<const std::uint8_t> rgb) {
    return explain(write_png(folder() / (kViewStem + std::to_string(k) + ".png"), width, height, 3, rgb));
}

Status BakeWriter::finish(BakeReport& report, const Diagnostics& diagnostics) {
    return explain(impl_->finish(report, diagnostics));
}

Status BakeWriter::commit() { return explain(impl_->output.commit()); }

}  // namespace lumel
