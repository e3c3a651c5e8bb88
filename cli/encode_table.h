// The table of `lumel encode`: what each encoding, in each storage, makes of a bake; and the choice by it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/block_sample.h"
#include "io/encoded_target.h"

namespace lumel::cli {

// How numbers are stored: as textures, or as EXR files hold them.
struct TableStorage {
    const TextureStorage* texture = nullptr;
    Storage plain = Storage::half;  // where there is no texture

    [[nodiscard]] const char* name() const;
    [[nodiscard]] bool holds(const Encoding& encoding) const;
    [[nodiscard]] double bytes_per_texel(const Encoding& encoding) const;
};

struct TableRow {
    const Encoding* encoding = nullptr;
    TableStorage storage;
    ReconstructionError error;
};

// Error: invalid_input where no texel was baked.
Result<BlockSample> sample_masters(const MasterList& masters, const LayerWeights& layers, std::size_t texels);

// All that there is: floats, halves, textures.
std::vector<TableStorage> all_storages();

// Encodings in their order, of each the storages that hold it; one that stores it as another before does is left out.
Result<std::vector<TableRow>> measure_all(const BlockSample& sample, std::span<const TableStorage> storages,
                                          BcQuality quality, Context& context);

// As CSV, to standard output.
void print_table(std::span<const TableRow> rows);

// Error over bytes: a line for halves and for each storage of GPUs, of the encodings that no smaller one beats.
Status write_table_plot(const std::string& file, std::span<const TableRow> rows);

// The row of least error that fits, the smaller of equals. Error: usage where none does.
Result<TableRow> choose_row(std::span<const TableRow> rows, std::optional<double> max_bytes);

}  // namespace lumel::cli
