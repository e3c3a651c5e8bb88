// lumel encode DIR: the light of a bake in another encoding, solved from its master without tracing; --table: what each
// encoding would make of it.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "base/try.h"
#include "command.h"
#include "encode/reconstruction_error.h"
#include "interrupt.h"
#include "io/encoded_output.h"
#include "io/master.h"
#include "path/radiance_sums.h"

namespace lumel::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string folder, output, encoding, format, progress;
    bool table = false;
    std::uint32_t threads = 0;
    std::optional<std::uint32_t> table_texels;
    std::optional<double> max_bytes;
};

constexpr const char* kAutomatic = "auto";
constexpr std::uint32_t kTableTexels = 4000;
// EXR files store halves.
constexpr Storage kStorageOfExr = Storage::half;

// Texels that stand for all: evenly spread over the baked ones, and of each the neighbour to its right on one plane.
class TexelPicker {
public:
    TexelPicker(std::size_t wanted, std::size_t pages) : per_page_(std::max<std::size_t>(wanted / pages, 1)) {}

    void add(const MasterPage& master) {
        std::vector<std::uint32_t> baked;
        for (std::uint32_t i = 0; i < master.texel_at.size(); ++i)
            if (is_baked(master, master.texel_at[i])) baked.push_back(i);
        const std::size_t count = std::min(per_page_, baked.size());
        for (std::size_t k = 0; k < count; ++k) add_with_neighbour(master, baked[k * baked.size() / count]);
    }
    [[nodiscard]] const MeasuredTexels& texels() const { return texels_; }

private:
    static bool is_baked(const MasterPage& master, std::uint32_t texel) {
        return texel != kNone && master.coverage[texel] == 3;
    }

    std::uint32_t add_texel(const MasterPage& master, std::uint32_t texel) {
        texels_.light.push_back(light_of_texel(master, texel));
        texels_.frame.push_back(tangent_frame(master.normal[texel]));
        return static_cast<std::uint32_t>(texels_.light.size() - 1);
    }

    void add_with_neighbour(const MasterPage& master, std::uint32_t pixel) {
        constexpr float kOnePlane = 0.99999f;
        const std::uint32_t texel = master.texel_at[pixel], first = add_texel(master, texel);
        if ((pixel + 1) % master.width == 0 || !is_baked(master, master.texel_at[pixel + 1])) return;
        const std::uint32_t next = master.texel_at[pixel + 1];
        if (dot(master.normal[texel], master.normal[next]) < kOnePlane) return;
        texels_.neighbours.push_back({first, add_texel(master, next)});
    }

    std::size_t per_page_;
    MeasuredTexels texels_;
};

Result<MeasuredTexels> pick_texels(const Options& options, const MasterList& masters, const LayerWeights& layers) {
    TexelPicker picker(options.table_texels.value_or(kTableTexels), masters.pages.size());
    for (const MasterFile& file : masters.pages) {
        LUMEL_TRY(const MasterPage master, read_master(file, layers));
        picker.add(master);
    }
    if (picker.texels().light.empty())
        return Error{ErrorCode::invalid_input, "no texel was baked", options.folder, "bake the scene again"};
    return picker.texels();
}

struct TableRow {
    const Encoding* encoding;
    Storage storage;
    ReconstructionError error;
};

Result<std::vector<TableRow>> measure_all(const MeasuredTexels& texels, std::span<const Storage> storages,
                                          Context& context) {
    std::vector<TableRow> rows;
    for (const Encoding* encoding : list_encodings())
        for (const Storage storage : storages) rows.push_back({encoding, storage, {}});
    const bool done = parallel_for(context, rows.size(), 1, [&](const ChunkRange& range) {
        for (std::size_t i = range.begin; i < range.end; ++i)
            rows[i].error = measure(*rows[i].encoding, rows[i].storage, texels);
    });
    if (!done) return cancelled_error();
    return rows;
}

void print_table(const std::vector<TableRow>& rows) {
    static constexpr const char* kStorageNames[] = {"float", "half", "texture"};
    std::printf("encoding,storage,bytes_per_texel,decode_operations,nrmse,p99,worst,at_normal,between,outside\n");
    for (const TableRow& row : rows) {
        const ReconstructionError& e = row.error;
        std::printf("%s,%s,%zu,%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n", row.encoding->name,
                    kStorageNames[static_cast<std::size_t>(row.storage)], bytes_per_texel(*row.encoding, row.storage),
                    row.encoding->decode_operations, e.nrmse, e.p99, e.worst, e.at_normal, e.between, e.outside);
    }
}

// The least error among those that fit.
Result<const Encoding*> choose(const Options& options, const MeasuredTexels& texels, Context& context) {
    LUMEL_TRY(const std::vector<TableRow> rows, measure_all(texels, std::span(&kStorageOfExr, 1), context));
    const TableRow* best = nullptr;
    std::size_t least = rows.front().encoding->fields.size() * sizeof(float);
    for (const TableRow& row : rows) {
        const std::size_t bytes = bytes_per_texel(*row.encoding, row.storage);
        least = std::min(least, bytes);
        if (options.max_bytes && static_cast<double>(bytes) > *options.max_bytes) continue;
        if (!best || row.error.nrmse < best->error.nrmse) best = &row;
    }
    if (!best)
        return Error{ErrorCode::usage,
                     "--max-bytes: no encoding fits; the smallest takes " + std::to_string(least) + " bytes a texel",
                     {},
                     "allow more"};
    std::fprintf(stderr, "lumel: %s: nRMSE %.4f over the normals of the hemisphere, %zu bytes a texel as halves\n",
                 best->encoding->name, best->error.nrmse, bytes_per_texel(*best->encoding, best->storage));
    return best->encoding;
}

Status write_pages(const Options& options, const Encoding& encoding, const MasterList& masters,
                   const LayerWeights& layers, const LightRecord& record, RunContext& run) {
    Context& context = run.get();
    const fs::path folder = options.output.empty() ? options.folder : options.output;
    LUMEL_TRY(EncodedOutput output, EncodedOutput::create(folder, encoding, record));
    run.interrupt().set_cleaner([partial = output.partial()] {
        std::error_code ignored;
        fs::remove_all(partial, ignored);
    });
    for (std::size_t p = 0; p < masters.pages.size(); ++p) {
        LUMEL_TRY(const MasterPage master, read_master(masters.pages[p], layers));
        LUMEL_TRY(const EncodedPage page, encode_page(encoding, master, context));
        LUMEL_TRY_STATUS(output.page(page, context));
        context.report("encode", static_cast<double>(p + 1) / static_cast<double>(masters.pages.size()));
    }
    if (!run.interrupt().begin_commit()) return cancelled_error();
    return output.commit(masters);
}

Result<const Encoding*> named_encoding(const std::string& name) {
    if (const Encoding* encoding = find_encoding(name)) return encoding;
    std::string all;
    for (const Encoding* encoding : list_encodings()) all += std::string(all.empty() ? "" : ", ") + encoding->name;
    return Error{ErrorCode::usage, "--encoding: there is no '" + name + "'", {}, "one of auto, " + all};
}

Status check_usage(const Options& options) {
    const auto usage = [](const char* what) { return Error{ErrorCode::usage, what, {}, {}}; };
    if (options.encoding.empty() && !options.table) return usage("one of --encoding and --table is needed");
    if (options.table && !options.encoding.empty())
        return usage("--table measures every encoding: it does not go with --encoding");
    if (options.table && !options.output.empty()) return usage("--table prints: there is nothing to write with -o");
    if (options.table && !options.format.empty()) return usage("--table prints: there is nothing to write as --format");
    if (options.max_bytes && options.encoding != kAutomatic) return usage("--max-bytes needs --encoding auto");
    if (options.table_texels && !options.table && options.encoding != kAutomatic)
        return usage("--table-texels needs --table or --encoding auto");
    return success();
}

Status run_in(const Options& options, RunContext& run) {
    LUMEL_TRY_STATUS(check_usage(options));
    Context& context = run.get();
    const Encoding* encoding = nullptr;
    if (!options.encoding.empty() && options.encoding != kAutomatic) {
        LUMEL_TRY(encoding, named_encoding(options.encoding));
    }
    LUMEL_TRY(const LightRecord record, read_light_record(options.folder));
    const LayerWeights layers = layer_weights(record.include);
    LUMEL_TRY(const MasterList masters, list_masters(options.folder));
    if (!encoding) {
        LUMEL_TRY(const MeasuredTexels texels, pick_texels(options, masters, layers));
        if (options.table) {
            constexpr std::array<Storage, 3> kAll{Storage::exact, Storage::half, Storage::texture};
            LUMEL_TRY(const std::vector<TableRow> rows, measure_all(texels, kAll, context));
            print_table(rows);
            return success();
        }
        LUMEL_TRY(encoding, choose(options, texels, context));
    }
    return write_pages(options, *encoding, masters, layers, record, run);
}

Status run(const Options& options) {
    RunContext context(options.threads, options.progress);
    Status status = run_in(options, context);
    context.finish();
    return status;
}

}  // namespace

Run add_encode(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("DIR", options->folder, "Output folder of lumel bake")->required();
    app.add_option("--encoding", options->encoding, "Name of an encoding, or auto: the one of least error")
        ->check(not_empty());
    app.add_option("--format", options->format, "exr: named channels of half or float")->check(CLI::IsMember({"exr"}));
    app.add_option("--max-bytes", options->max_bytes, "With auto: at most so many bytes per texel")
        ->check(between(1.0, 1000.0));
    app.add_flag("--table", options->table, "Print the error and the cost of every encoding as CSV");
    app.add_option("--table-texels", options->table_texels, "Texels that auto and --table measure")
        ->check(CLI::Range(1u, 10000000u));
    app.add_option("-o,--output", options->output, "Folder to write to, if not DIR")->check(not_empty());
    app.add_option("--threads", options->threads, "0: one per core")->check(CLI::Range(0u, 1024u));
    declare_progress(app, options->progress);
    return [options] {
        const Status status = run(*options);
        return status.ok() ? static_cast<int>(kDone) : fail(status.error(), "encode");
    };
}

}  // namespace lumel::cli
