// The sample scenes; each is written as <name>.glb with its sidecar.
#pragma once

#include <filesystem>

#include "glb_builder.h"
#include "lumel/result.h"

namespace lumel::samples {

Status write_gallery(const std::filesystem::path& folder);

// A level of `buildings` instanced houses on streets: for tests of size. About 41 charts a house.
Status write_town(const std::filesystem::path& folder, std::uint32_t buildings);

// A closed room that `lamps` small glowing triangles light, spread over it and facing anywhere; however many, their
// area is half a square metre and their radiance the same.
Status write_lamps(const std::filesystem::path& folder, std::uint32_t lamps);

// A floor without light.
Status write_plain(const std::filesystem::path& folder);

// The scenes of the leak suite: see leaks.h.
Status write_leaks(const std::filesystem::path& folder);

// Chart masks for `lumel pack`, level.msk: see level_masks.h.
Status write_charts(const std::filesystem::path& folder, std::uint32_t charts, std::uint64_t seed);

}  // namespace lumel::samples
