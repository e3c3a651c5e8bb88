// Radiance HDR, PFM and plain files. EXR is in exr_write.cpp, PNG in png_write.cpp.
#include <bit>
#include <cstring>

#include "base/check.h"
#include "io/atomic_file.h"
#include "io/image_io.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

namespace lumel {
namespace {

void append(void* context, void* data, int size) {
    auto& out = *static_cast<std::vector<std::byte>*>(context);
    const auto* bytes = static_cast<const std::byte*>(data);
    out.insert(out.end(), bytes, bytes + size);
}

void append_text(std::vector<std::byte>& out, const std::string& text) {
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    out.insert(out.end(), bytes, bytes + text.size());
}

}  // namespace

Status write_hdr(const std::filesystem::path& path, const Image& rgb) {
    LUMEL_CHECK(rgb.channels >= 1 && rgb.width > 0 && rgb.height > 0, rgb.channels, rgb.width, rgb.height);
    std::vector<std::byte> out;
    const int ok = stbi_write_hdr_to_func(append, &out, static_cast<int>(rgb.width), static_cast<int>(rgb.height),
                                          static_cast<int>(rgb.channels), rgb.data.data());
    LUMEL_CHECK(ok != 0, rgb.width, rgb.height);
    return write_file(path, out);
}

// Rows bottom-up, little-endian floats (a negative scale says so).
Status write_pfm(const std::filesystem::path& path, const Image& rgb) {
    static_assert(std::endian::native == std::endian::little);
    LUMEL_CHECK(rgb.channels == 1 || rgb.channels == 3, rgb.channels);
    std::vector<std::byte> out;
    append_text(out, std::string(rgb.channels == 3 ? "PF" : "Pf") + "\n" + std::to_string(rgb.width) + " " +
                         std::to_string(rgb.height) + "\n-1.0\n");
    const std::size_t row = std::size_t{rgb.width} * rgb.channels;
    for (std::uint32_t y = rgb.height; y-- > 0;) {
        const auto bytes = std::as_bytes(std::span(rgb.data).subspan(y * row, row));
        out.insert(out.end(), bytes.begin(), bytes.end());
    }
    return write_file(path, out);
}

Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    AtomicFile file(path);
    file.write(bytes);
    return file.commit();
}

}  // namespace lumel
