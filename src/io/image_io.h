// Image files: OpenEXR, Radiance HDR, PFM, PNG, JPEG. Bounded reading of foreign bytes, whole-or-nothing writing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

// Reading ------------------------------------------------------------------------------------------------------------

// By content (magic bytes), not by name. RGB(A) float images; for EXR the channels R, G, B (of the first layer that has
// them) or a single channel; 8-bit files are read as stored / 255, not linearised. At most 16384 x 16384 pixels.
Result<Image> read_image(const std::filesystem::path& path);
Result<Image> decode_image(std::span<const std::byte> bytes, const std::string& where);

// Whether read_image would give 8-bit codes (PNG, JPEG, PGM), which need not be proportional to light, and not floats.
Result<bool> is_eight_bit_image(const std::filesystem::path& path);

// PNG or JPEG to 8-bit RGBA for a Scene texture. Errors name `where`; textures above 8192 x 8192 are refused.
Result<Texture> decode_texture(std::span<const std::byte> bytes, const std::string& where, bool srgb);

// .hdr or .exr, 2:1 equirectangular. Negative and non-finite pixels are errors.
Result<SkyMap> read_sky(const std::filesystem::path& path);

// What EXR calls the channels of a colour.
inline constexpr std::array<const char*, 3> kRgbChannels{"R", "G", "B"};

// Named channels of an EXR (masters).
struct NamedChannels {
    std::uint32_t width = 0, height = 0;
    std::vector<std::string> names;
    std::vector<std::vector<float>> planes;
};
Result<NamedChannels> read_exr_channels(const std::filesystem::path& path, std::span<const std::string> names);
// Names of all of its channels, sorted.
Result<std::vector<std::string>> read_exr_channel_names(const std::filesystem::path& path);
// Gets some rows of all channels, as many as its height says, and where they start; an error ends the reading.
using ExrBand = std::function<Status(const NamedChannels& band, std::uint32_t first_row)>;

// Writing: beside the target, then renamed; nothing is left behind on failure -----------------------------------------

enum class ExrType { half, full };

struct ExrChannelSource {
    std::string name;
    ExrType type = ExrType::full;
};
// Fills row y of all channels: pixel x of channel c is out[c * width + x]. Returns false, and need not touch `out`,
// where all of it is zero. Rows are asked for a few at a time: large masters are never held as images.
using ExrRow = std::function<bool(std::uint32_t y, std::span<float> out)>;
// With a context its threads ask for rows, several at once, and as many compress them; the file is the same for any
// number. Stops where that is cancelled, with that error. `progress` is called on this thread with 0..1.
Status write_exr(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                 std::span<const ExrChannelSource> channels, const ExrRow& row, Context* context = nullptr,
                 const std::function<void(double)>& progress = {});
Status write_exr(const std::filesystem::path& path, const Image& rgb, ExrType type);

Status write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                 std::span<const std::uint8_t> pixels);
std::vector<std::byte> encode_png(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                                  std::span<const std::uint8_t> pixels);
Status write_hdr(const std::filesystem::path& path, const Image& rgb);
Status write_pfm(const std::filesystem::path& path, const Image& rgb);

// Any file, whole or not at all.
Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes);

}  // namespace lumel
