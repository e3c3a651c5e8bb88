// PNG out through libpng.
#include <png.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/check.h"
#include "io/image_io.h"

namespace lumel {
namespace {

bool is_zero(std::span<const std::uint8_t> bytes) {
    return std::ranges::all_of(bytes, [](std::uint8_t byte) { return byte == 0; });
}

class PngWriter {
public:
    PngWriter() {
        // What libpng may find wrong here is a bug of ours.
        const auto fail = [](png_structp, png_const_charp reason) { LUMEL_CHECK(reason == nullptr, reason); };
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, fail);
        LUMEL_CHECK(png_ != nullptr);
        info_ = png_create_info_struct(png_);
        LUMEL_CHECK(info_ != nullptr);
        png_set_write_fn(png_, &out_, append, [](png_structp) {});
    }
    ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    void start(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
        constexpr std::array kTypes{PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                    PNG_COLOR_TYPE_RGB_ALPHA};
        png_set_IHDR(png_, info_, width, height, 8, kTypes[channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE,
                     PNG_FILTER_TYPE_BASE);
        png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
        png_write_info(png_, info_);
    }

    void add(std::span<const std::uint8_t> row) {
        // Much of an atlas is empty, and no filter makes less of nothing. (The first row goes with all filters: libpng
        // allocates then what they need.)
        if (!is_first_) png_set_filter(png_, PNG_FILTER_TYPE_BASE, is_zero(row) ? PNG_FILTER_NONE : PNG_ALL_FILTERS);
        is_first_ = false;
        png_write_row(png_, row.data());
    }

    std::vector<std::byte> finish() {
        png_write_end(png_, nullptr);
        return std::move(out_);
    }

private:
    static void append(png_structp png, png_bytep bytes, std::size_t size) noexcept {
        auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
        const auto added = std::as_bytes(std::span(bytes, size));
        out.insert(out.end(), added.begin(), added.end());
    }

    std::vector<std::byte> out_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    bool is_first_ = true;
};

}  // namespace

std::vector<std::byte> encode_png(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                                  std::span<const std::uint8_t> pixels) {
    LUMEL_CHECK(width > 0 && height > 0 && channels >= 1 && channels <= 4, width, height, channels);
    const std::size_t row = std::size_t{width} * channels;
    LUMEL_CHECK(pixels.size() == row * height, pixels.size(), width, height, channels);
    PngWriter writer;
    writer.start(width, height, channels);
    for (std::size_t y = 0; y < height; ++y) writer.add(pixels.subspan(y * row, row));
    return writer.finish();
}

Status write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                 std::span<const std::uint8_t> pixels) {
    return write_file(path, encode_png(width, height, channels, pixels));
}

}  // namespace lumel
