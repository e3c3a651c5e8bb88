// Chart masks as files (.msk, docs/formats.md): what `lumel pack` reads.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "lumel/result.h"
#include "pack/mask.h"

namespace lumel {

// Bounded reading: sizes are checked against the bytes that are there before anything is allocated. Errors name the
// chart.
Result<std::vector<ChartMask>> read_masks(const std::filesystem::path& path);
Result<std::vector<ChartMask>> decode_masks(std::span<const std::byte> bytes, const std::string& where);

// Precondition: sizes below 65536.
std::vector<std::byte> encode_masks(std::span<const ChartMask> masks);
// Writes only what read_masks() reads: up to 32 MiB and four million charts, none of more than 16384 texels along an
// edge or 2^26 in all.
Status write_masks(const std::filesystem::path& path, std::span<const ChartMask> masks);

}  // namespace lumel
