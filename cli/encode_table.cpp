#include "encode_table.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "base/try.h"
#include "io/image_io.h"
#include "plot/plot.h"
#include "texture/stored_page.h"

namespace lumel::cli {
namespace {

// Those of the sample in the encoding, there and back.
Result<std::vector<Numbers>> stored_numbers(const Encoding& encoding, const TableStorage& storage,
                                            const EncodedPage& page, BcQuality quality, Context& context) {
    if (storage.texture) {
        LUMEL_TRY(EncodedPage back,
                  as_stored(encoding, texture_layout(encoding, *storage.texture), page, quality, context));
        return std::move(back.numbers);
    }
    std::vector<Numbers> out = page.numbers;
    for (Numbers& numbers : out) quantise(encoding, storage.plain, numbers);
    return out;
}

// Would textures be those of a row before?
bool is_new(const TableStorage& storage, const Encoding& encoding, std::span<const TableStorage> before) {
    const auto formats = [&](const TextureStorage& s) {
        std::vector<TexelFormat> out;
        for (const StoredTexture& texture : texture_layout(encoding, s)) out.push_back(texture.format);
        return out;
    };
    return !storage.texture || std::ranges::none_of(before, [&](const TableStorage& other) {
        return other.texture && formats(*other.texture) == formats(*storage.texture);
    });
}

// One encoding in all storages.
Result<std::vector<TableRow>> measure_encoding(const Encoding& encoding, const BlockSample& sample,
                                               std::span<const TableStorage> storages, BcQuality quality,
                                               Context& context) {
    EncodedPage page = sample.page;
    page.numbers = solve_for_files(encoding, sample.light, sample.frame);
    std::vector<TableRow> rows;
    std::vector<std::vector<Numbers>> stored;  // of the baked texels
    for (std::size_t s = 0; s < storages.size(); ++s) {
        if (!storages[s].holds(encoding) || !is_new(storages[s], encoding, storages.first(s))) continue;
        LUMEL_TRY(const std::vector<Numbers> all, stored_numbers(encoding, storages[s], page, quality, context));
        std::vector<Numbers>& baked = stored.emplace_back();
        for (const std::uint32_t i : sample.baked) baked.push_back(all[i]);
        rows.push_back({&encoding, storages[s], {}});
    }
    const bool done = parallel_for(context, rows.size(), 1, [&](const ChunkRange& range) {
        for (std::size_t i = range.begin; i < range.end; ++i)
            rows[i].error = measure(encoding, stored[i], sample.texels);
    });
    if (!done) return cancelled_error();
    return rows;
}

}  // namespace

const char* TableStorage::name() const {
    if (texture) return texture->name;
    return plain == Storage::exact ? "float" : "half";
}

bool TableStorage::holds(const Encoding& encoding) const {
    return !texture || !texture_layout(encoding, *texture).empty();
}

double TableStorage::bytes_per_texel(const Encoding& encoding) const {
    if (texture) return lumel::bytes_per_texel(texture_layout(encoding, *texture));
    return static_cast<double>(lumel::bytes_per_texel(encoding, plain));
}

Result<BlockSample> sample_masters(const MasterList& masters, const LayerWeights& layers, std::size_t texels) {
    BlockSampler sampler(texels, masters.pages.size());
    for (const MasterFile& file : masters.pages) {
        LUMEL_TRY(const MasterPage master, read_master(file, layers));
        sampler.add(master);
    }
    BlockSample sample = std::move(sampler).finish();
    if (sample.baked.empty())
        return Error{ErrorCode::invalid_input, "no texel was baked", masters.manifest.parent_path().string(),
                     "bake the scene again"};
    return sample;
}

std::vector<TableStorage> all_storages() {
    std::vector<TableStorage> out{{nullptr, Storage::exact}, {nullptr, Storage::half}};
    for (const TextureStorage& storage : texture_storages()) out.push_back({&storage, Storage::exact});
    return out;
}

Result<std::vector<TableRow>> measure_all(const BlockSample& sample, std::span<const TableStorage> storages,
                                          BcQuality quality, Context& context) {
    std::vector<TableRow> rows;
    const auto encodings = list_encodings();
    for (std::size_t e = 0; e < encodings.size(); ++e) {
        LUMEL_TRY(const std::vector<TableRow> of_one,
                  measure_encoding(*encodings[e], sample, storages, quality, context));
        rows.insert(rows.end(), of_one.begin(), of_one.end());
        context.report("measure", static_cast<double>(e + 1) / static_cast<double>(encodings.size()));
    }
    return rows;
}

void print_table(std::span<const TableRow> rows) {
    std::fprintf(
        stderr,
        "errors of the light E/pi over the normals of each texel's hemisphere, of the mean of E/pi (at_normal: "
        "for the texel's own normal alone)\n");
    std::printf("encoding,storage,bytes_per_texel,decode_operations,nrmse,p99,worst,at_normal,between,outside\n");
    for (const TableRow& row : rows) {
        const ReconstructionError& e = row.error;
        std::printf("%s,%s,%g,%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f\n", row.encoding->name, row.storage.name(),
                    row.storage.bytes_per_texel(*row.encoding), row.encoding->decode_operations, e.nrmse, e.p99,
                    e.worst, e.at_normal, e.between, e.outside);
    }
}

Status write_table_plot(const std::string& file, std::span<const TableRow> rows) {
    PlotPanel panel{"encodings by storage: the least error for the bytes", "bytes per texel", "nRMSE", {}};
    for (const TableStorage& storage : all_storages()) {
        if (storage.texture ? !is_of_gpus(*storage.texture) : storage.plain == Storage::exact) continue;
        std::vector<const TableRow*> of_storage;
        for (const TableRow& row : rows)
            if (row.storage.name() == std::string(storage.name())) of_storage.push_back(&row);
        const auto bytes = [](const TableRow* row) { return row->storage.bytes_per_texel(*row->encoding); };
        std::ranges::stable_sort(of_storage, [&](const TableRow* a, const TableRow* b) {
            return bytes(a) != bytes(b) ? bytes(a) < bytes(b) : a->error.nrmse < b->error.nrmse;
        });
        PlotLine line{storage.name(), {}};
        double least = std::numeric_limits<double>::infinity();
        for (const TableRow* row : of_storage) {
            if (!(row->error.nrmse < least)) continue;
            least = row->error.nrmse;
            line.points.push_back({bytes(row), least});
        }
        panel.lines.push_back(std::move(line));
    }
    const Image image = draw_plot({panel});
    std::vector<std::uint8_t> pixels;
    for (const float v : image.data) pixels.push_back(static_cast<std::uint8_t>(v * 255.0f + 0.5f));
    return write_png(file, image.width, image.height, 3, pixels);
}

Result<TableRow> choose_row(std::span<const TableRow> rows, std::optional<double> max_bytes) {
    const TableRow* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const TableRow& row : rows) {
        const double bytes = row.storage.bytes_per_texel(*row.encoding);
        least = std::min(least, bytes);
        if (max_bytes && bytes > *max_bytes) continue;
        const bool smaller = best && bytes < best->storage.bytes_per_texel(*best->encoding);
        if (!best || row.error.nrmse < best->error.nrmse || (row.error.nrmse == best->error.nrmse && smaller))
            best = &row;
    }
    if (best) return *best;
    char text[80];
    std::snprintf(text, sizeof text, "--max-bytes: no encoding fits; the smallest takes %g bytes a texel", least);
    return Error{ErrorCode::usage, text, {}, "allow more, or another --format"};
}

}  // namespace lumel::cli
