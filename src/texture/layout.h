// Which textures an encoding becomes. Fields of one kind whose names differ only in what follows the last dot are one
// texture ("L1n.R.X", "L1n.R.Y", "L1n.R.Z": "L1n.R"); the storage says in which format, and whether small textures
// share one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "encode/encoding.h"
#include "texture/texel_format.h"

namespace lumel {

// One row per way to store any encoding.
struct TextureStorage {
    const char* name;
    TexelFormat light, signed_light;
    bool has_negative;          // signed_light is one; else light of either sign cannot be stored
    TexelFormat eight_bits[3];  // of ratios and units: of one, two, three channels
    bool joins;                 // neighbouring ratios and units share a texture of up to three channels
};
// GPU formats, then those of PNG and .hdr.
std::span<const TextureStorage> texture_storages();
// nullptr where there is none of that name.
const TextureStorage* find_texture_storage(std::string_view name);
// Do GPUs read all of it?
bool is_of_gpus(const TextureStorage& storage);

struct StoredTexture {
    std::string name;  // "I", "w-d", "L1n.R": of files
    TexelFormat format = TexelFormat::rgba8;
    std::uint8_t first = 0, count = 0;  // fields; in the channels R, G, B

    bool operator==(const StoredTexture&) const = default;
};
// In the order of the fields; none where the storage cannot hold the encoding.
std::vector<StoredTexture> texture_layout(const Encoding& encoding, const TextureStorage& storage);

double bytes_per_texel(std::span<const StoredTexture> layout);

}  // namespace lumel
