// PNG in through libpng.
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>

#include "base/try.h"
#include "io/image_codecs.h"

namespace lumel {
namespace {

// A failed call of libpng leaves by longjmp: whatever has a destructor lives in this class, and its methods that call
// libpng hold nothing that has one.
class PngReader {
public:
    explicit PngReader(std::span<const std::byte> bytes) : rest_(bytes) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, [](png_structp, png_const_charp) {});
        if (png_ != nullptr) info_ = png_create_info_struct(png_);
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    // The first three return false with reason() said; to be called in this order.

    bool read_header() {
        if (info_ == nullptr) return false;
        if (setjmp(png_jmpbuf(png_)) != 0) return false;  // NOLINT(cert-err52-cpp): it is how libpng reports
        png_set_read_fn(png_, this, read);
        // Names, profiles and comments are of no use here, and may inflate to more than the image.
        png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_read_info(png_, info_);
        return true;
    }

    // Any kind of PNG as grey, grey and alpha, RGB or RGBA of 8 or 16 bits.
    bool start() {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;  // NOLINT(cert-err52-cpp)
        png_set_expand(png_);
        if constexpr (std::endian::native == std::endian::little) png_set_swap(png_);
        png_set_interlace_handling(png_);
        png_read_update_info(png_, info_);
        return true;
    }

    // `rows` are height() pointers to row_bytes() each.
    bool read_rows(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png_)) != 0) return false;  // NOLINT(cert-err52-cpp)
        png_read_image(png_, rows);
        png_read_end(png_, nullptr);
        return true;
    }

    [[nodiscard]] std::uint32_t width() const { return png_get_image_width(png_, info_); }
    [[nodiscard]] std::uint32_t height() const { return png_get_image_height(png_, info_); }
    [[nodiscard]] std::uint32_t channels() const { return png_get_channels(png_, info_); }
    [[nodiscard]] std::uint32_t bits() const { return png_get_bit_depth(png_, info_); }
    [[nodiscard]] std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
    [[nodiscard]] const char* reason() const { return reason_; }

private:
    static PngReader& self(void* pointer) { return *static_cast<PngReader*>(pointer); }

    [[noreturn]] static void fail(png_structp png, png_const_charp reason) {
        char* const kept = self(png_get_error_ptr(png)).reason_;
        std::strncpy(kept, reason, sizeof reason_ - 1);
        png_longjmp(png, 1);
    }

    static void read(png_structp png, png_bytep out, std::size_t size) {
        std::span<const std::byte>& rest = self(png_get_io_ptr(png)).rest_;
        if (size > rest.size()) png_error(png, "the file ends within the image");
        std::memcpy(out, rest.data(), size);
        rest = rest.subspan(size);
    }

    std::span<const std::byte> rest_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    char reason_[128] = "no memory for a PNG decoder";
};

constexpr std::size_t kSizeAt = 16;  // after the signature, and the length and name of the chunk IHDR

std::uint32_t big_endian(std::span<const std::byte, 4> bytes) {
    std::uint32_t value = 0;
    for (const std::byte byte : bytes) value = value << 8 | std::to_integer<std::uint32_t>(byte);
    return value;
}

Error undecodable(const PngReader& reader, const std::string& where) {
    return {ErrorCode::invalid_input, std::string("cannot be decoded: ") + reader.reason(), where,
            "the image is damaged or of an unusual kind; save it again as plain PNG or JPEG"};
}

}  // namespace

Result<CodedImage> decode_png(std::span<const std::byte> bytes, std::uint32_t max_edge, const std::string& where) {
    // A size that is too large shall be named even where the rest is damaged: the header should be the first chunk.
    if (bytes.size() >= kSizeAt + 8)
        LUMEL_TRY_STATUS(check_image_size(big_endian(bytes.subspan<kSizeAt, 4>()),
                                          big_endian(bytes.subspan<kSizeAt + 4, 4>()), 4, max_edge, bytes.size(), where,
                                          true));
    PngReader reader(bytes);
    if (!reader.read_header()) return undecodable(reader, where);
    // Where another chunk came first, that was not the size.
    LUMEL_TRY_STATUS(check_image_size(reader.width(), reader.height(), 4, max_edge, bytes.size(), where, true));
    if (!reader.start()) return undecodable(reader, where);
    CodedImage image{reader.width(), reader.height(), reader.channels(), reader.bits(), {}};
    const std::size_t row_bytes = reader.row_bytes();
    image.codes.resize(row_bytes * image.height);
    std::vector<png_bytep> rows(image.height);
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = image.codes.data() + y * row_bytes;
    if (!reader.read_rows(rows.data())) return undecodable(reader, where);
    return image;
}

}  // namespace lumel
