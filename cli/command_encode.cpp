// lumel encode DIR: the light of a bake in another encoding, solved from its master without tracing; --table: what each
// encoding would make of it.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cancelled.h"
#include "base/try.h"
#include "command.h"
#include "encode_table.h"
#include "interrupt.h"
#include "io/encoded_output.h"
#include "io/master.h"
#include "path/radiance_sums.h"

namespace lumel::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string folder, output, encoding, format, storage, quality, plot, progress;
    bool table = false;
    std::uint32_t threads = 0;
    std::optional<std::uint32_t> table_texels;
    std::optional<double> max_bytes;
};

constexpr const char* kAutomatic = "auto";
constexpr std::uint32_t kTableTexels = 4000;

struct QualityName {
    const char* name;
    BcQuality quality;
};
constexpr std::array kQualities{QualityName{"fast", BcQuality::fast}, QualityName{"medium", BcQuality::normal},
                                QualityName{"best", BcQuality::best}};
BcQuality quality_of(const Options& options) {
    for (const QualityName& q : kQualities)
        if (options.quality == q.name) return q.quality;
    return BcQuality::normal;
}

// What is written: an encoding, and as what.
struct Choice {
    const Encoding* encoding = nullptr;
    EncodedTarget target;
};

// Where KTX2 and DDS are not told.
constexpr const char* kUsualStorage = "bc7";

// The format that was asked for, or EXR.
const EncodedFormat& format_of(const Options& options) {
    return options.format.empty() ? encoded_formats()[0] : *find_encoded_format(options.format);
}

const TextureStorage* storage_of(const Options& options) {
    const EncodedFormat& format = format_of(options);
    if (format.file == EncodedFile::exr) return nullptr;
    if (format.storage) return find_texture_storage(format.storage);
    return find_texture_storage(options.storage.empty() ? kUsualStorage : options.storage);
}

// What auto chooses among: halves and blocks, or what the format can be.
std::vector<TableStorage> storages_of(const Options& options) {
    const EncodedFormat& format = format_of(options);
    const TableStorage half{nullptr, Storage::half};
    if (!options.format.empty() && format.file == EncodedFile::exr) return {half};
    if (format.storage || !options.storage.empty()) return {{storage_of(options), Storage::exact}};
    std::vector<TableStorage> out;
    if (options.format.empty()) out.push_back(half);
    for (const TextureStorage& storage : texture_storages()) {
        const bool of_blocks = format_info(storage.light).block_edge > 1;
        if (of_blocks || (!options.format.empty() && is_of_gpus(storage))) out.push_back({&storage, Storage::exact});
    }
    return out;
}

Result<Choice> choose(const Options& options, const BlockSample& sample, Context& context) {
    const std::vector<TableStorage> storages = storages_of(options);
    LUMEL_TRY(const std::vector<TableRow> rows, measure_all(sample, storages, quality_of(options), context));
    LUMEL_TRY(const TableRow row, choose_row(rows, options.max_bytes));
    const TextureStorage* storage = row.storage.texture;
    const EncodedFormat& format = options.format.empty() && storage ? *find_encoded_format("ktx2") : format_of(options);
    std::fprintf(stderr, "lumel: %s as %s, %s: nRMSE %.4f over the normals of the hemisphere, %g bytes a texel\n",
                 row.encoding->name, format.name, row.storage.name(), row.error.nrmse,
                 row.storage.bytes_per_texel(*row.encoding));
    return Choice{row.encoding, {&format, storage}};
}

// Pages of one size are the layers of one texture, where files have layers.
std::uint32_t layers_of(const EncodedFormat& format, const MasterList& masters) {
    if (format.file != EncodedFile::ktx2 && format.file != EncodedFile::dds) return 0;
    const bool one_size = std::ranges::all_of(masters.pages, [&](const MasterFile& page) {
        return page.width == masters.pages[0].width && page.height == masters.pages[0].height &&
               page.mips.size() == masters.pages[0].mips.size();
    });
    return one_size ? static_cast<std::uint32_t>(masters.pages.size()) : 0;
}

// What there is now; of many pages the first few.
void print_files(const fs::path& folder, const EncodedOutput::Files& files) {
    constexpr std::size_t kNamed = 8;
    std::printf("description: %s\n", (folder / files.description).c_str());
    for (std::size_t i = 0; i < std::min(kNamed, files.pages.size()); ++i)
        std::printf("light: %s\n", (folder / files.pages[i]).c_str());
    if (files.pages.size() > kNamed) std::printf("and %zu more\n", files.pages.size() - kNamed);
}

// A page and the mips that the bake made of it: their masters are means per chart, which no filter of ours would be.
Result<std::vector<EncodedPage>> encode_levels(const Encoding& encoding, const MasterFile& file,
                                               const LayerWeights& layers, Context& context) {
    std::vector<EncodedPage> out;
    const auto add = [&](const MasterFile& level) -> Status {
        LUMEL_TRY(const MasterPage master, read_master(level, layers));
        LUMEL_TRY(EncodedPage page, encode_page(encoding, master, context));
        out.push_back(std::move(page));
        return success();
    };
    LUMEL_TRY_STATUS(add(file));
    for (const MasterFile& mip : file.mips) LUMEL_TRY_STATUS(add(mip));
    return out;
}

Status write_pages(const Options& options, const Choice& choice, const MasterList& masters, const LayerWeights& layers,
                   const LightRecord& record, RunContext& run) {
    Context& context = run.get();
    const fs::path folder = options.output.empty() ? options.folder : options.output;
    LUMEL_TRY(EncodedOutput output, EncodedOutput::create(folder, *choice.encoding, record, choice.target));
    run.interrupt().set_cleaner(output.cleaner());
    for (std::size_t p = 0; p < masters.pages.size(); ++p) {
        LUMEL_TRY(const std::vector<EncodedPage> page,
                  encode_levels(*choice.encoding, masters.pages[p], layers, context));
        LUMEL_TRY_STATUS(output.page(page, context));
        context.report("encode", static_cast<double>(p + 1) / static_cast<double>(masters.pages.size()));
    }
    if (!run.interrupt().begin_commit()) return cancelled_error();
    LUMEL_TRY_STATUS(output.commit(masters));
    run.finish();
    print_files(folder, output.files());
    return success();
}

Error usage(std::string what, std::string remedy = {}) {
    return {ErrorCode::usage, std::move(what), {}, std::move(remedy)};
}

Result<Choice> named_choice(const Options& options) {
    const Encoding* encoding = find_encoding(options.encoding);
    if (!encoding) {
        std::string all;
        for (const Encoding* e : list_encodings()) all += std::string(all.empty() ? "" : ", ") + e->name;
        return usage("--encoding: there is no '" + options.encoding + "'", "one of auto, " + all);
    }
    const TextureStorage* storage = storage_of(options);
    if (storage && texture_layout(*encoding, *storage).empty())
        return usage("--encoding: " + options.encoding + " has negative light, which " + storage->name + " cannot hold",
                     "write it as exr, or as ktx2 or dds with --storage bc7, bc1 or rgba16f");
    return Choice{encoding, {&format_of(options), storage}};
}

Status check_usage(const Options& options) {
    if (options.encoding.empty() && !options.table) return usage("one of --encoding and --table is needed");
    if (options.table && !options.encoding.empty())
        return usage("--table measures every encoding: it does not go with --encoding");
    if (options.table && !options.output.empty()) return usage("--table prints: there is nothing to write with -o");
    if (options.table && !options.format.empty()) return usage("--table prints: there is nothing to write as --format");
    if (!options.plot.empty() && !options.table) return usage("--plot needs --table");
    if (options.max_bytes && options.encoding != kAutomatic) return usage("--max-bytes needs --encoding auto");
    if (options.table_texels && !options.table && options.encoding != kAutomatic)
        return usage("--table-texels needs --table or --encoding auto");
    const EncodedFile file = format_of(options).file;
    if (!options.storage.empty() && file != EncodedFile::ktx2 && file != EncodedFile::dds)
        return usage("--storage needs --format ktx2 or dds: the others have one each");
    const bool compresses = options.table || file == EncodedFile::ktx2 || file == EncodedFile::dds ||
                            (options.encoding == kAutomatic && options.format.empty());
    if (!options.quality.empty() && !compresses) return usage("--quality needs blocks: --format ktx2 or dds");
    return success();
}

Status print_measured(const Options& options, const BlockSample& sample, Context& context) {
    LUMEL_TRY(const std::vector<TableRow> rows, measure_all(sample, all_storages(), quality_of(options), context));
    print_table(rows);
    if (options.plot.empty()) return success();
    LUMEL_TRY_STATUS(write_table_plot(options.plot, rows));
    std::fprintf(stderr, "plot: %s\n", options.plot.c_str());
    return success();
}

Status run(const Options& options) {
    LUMEL_TRY_STATUS(check_usage(options));
    RunContext run_context(options.threads, options.progress);
    Context& context = run_context.get();
    Choice choice;
    if (!options.encoding.empty() && options.encoding != kAutomatic) {
        LUMEL_TRY(choice, named_choice(options));
    }
    LUMEL_TRY(const LightRecord record, read_light_record(options.folder));
    const LayerWeights layers = layer_weights(record.include);
    LUMEL_TRY(const MasterList masters, list_masters(options.folder));
    if (!choice.encoding) {
        LUMEL_TRY(const BlockSample sample,
                  sample_masters(masters, layers, options.table_texels.value_or(kTableTexels)));
        if (options.table) return print_measured(options, sample, context);
        LUMEL_TRY(choice, choose(options, sample, context));
    }
    choice.target.quality = quality_of(options);
    choice.target.layers = layers_of(*choice.target.format, masters);
    return write_pages(options, choice, masters, layers, record, run_context);
}

template <class Rows>
std::vector<std::string> names_of(const Rows& rows) {
    std::vector<std::string> out;
    out.reserve(std::size(rows));
    for (const auto& row : rows) out.emplace_back(row.name);
    return out;
}
std::vector<std::string> gpu_storages() {
    std::vector<std::string> out;
    for (const TextureStorage& storage : texture_storages())
        if (is_of_gpus(storage)) out.emplace_back(storage.name);
    return out;
}

}  // namespace

Run add_encode(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("DIR", options->folder, "Output folder of lumel bake")->required();
    app.add_option("--encoding", options->encoding,
                   "Name of an encoding, or auto: the one of least error; needed, or --table")
        ->check(not_empty());
    app.add_option("--format", options->format, "exr: named channels; ktx2, dds: textures; PNG or .hdr")
        ->default_str("exr; with auto, exr or ktx2")
        ->check(CLI::IsMember(names_of(encoded_formats())));
    app.add_option("--storage", options->storage, "Of ktx2 and dds: what textures are compressed to, if anything")
        ->default_str(kUsualStorage + std::string("; with auto, the best"))
        ->check(CLI::IsMember(gpu_storages()));
    app.add_option("--quality", options->quality, "How hard block compression searches")
        ->default_str("medium")
        ->check(CLI::IsMember(names_of(kQualities)));
    app.add_option("--max-bytes", options->max_bytes, "With auto: at most so many bytes per texel")
        ->default_str("any")
        ->check(between(0.1, 1000.0));
    app.add_flag("--table", options->table,
                 "Instead of writing: print the error and the cost of every encoding as CSV");
    app.add_option("--plot", options->plot, "With --table: a PNG of error over bytes")->check(not_empty());
    app.add_option("--table-texels", options->table_texels, "Texels that auto and --table measure")
        ->default_str(std::to_string(kTableTexels))
        ->check(CLI::Range(1u, 10000000u));
    app.add_option("-o,--output", options->output, "Folder to write to")->default_str("DIR")->check(not_empty());
    app.add_option("--threads", options->threads, "0: one per core")->check(CLI::Range(0u, 1024u));
    declare_progress(app, options->progress);
    return [options] {
        const Status status = run(*options);
        return status.ok() ? static_cast<int>(kDone) : fail(status.error(), "encode");
    };
}

}  // namespace lumel::cli
