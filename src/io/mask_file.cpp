#include "io/mask_file.h"

#include "base/check.h"
#include "base/try.h"
#include "io/image_io.h"

namespace lumel {
namespace {

constexpr std::uint32_t kMagic = 0x4b534d43, kMaskVersion = 1;  // "CMSK"
constexpr std::size_t kHeaderBytes = 16, kChartHeaderBytes = 4;
// In memory rows of a mask take up to eight times their bytes, and the smallest masks eighteen times. What packing
// takes on top grows with the largest mask, so that is bounded on its own, and with the page: see page_bytes() in
// pack/pack_pages.h.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{32} << 20;
constexpr std::uint32_t kMaxCharts = 4'000'000, kMaxEdge = 16384;
constexpr std::uint64_t kMaxTexels = std::uint64_t{1} << 26;  // of a chart's box

std::uint32_t little_endian(std::span<const std::byte> bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) value |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
    return value;
}

Status check_size(std::uint32_t width, std::uint32_t height, const std::string& name, const std::string& where) {
    if (width <= kMaxEdge && height <= kMaxEdge && std::uint64_t{width} * height <= kMaxTexels) return success();
    return Error{ErrorCode::unsupported,
                 name + " has " + std::to_string(width) + "x" + std::to_string(height) + " texels, more than " +
                     std::to_string(kMaxEdge) + " along an edge or " + std::to_string(kMaxTexels) + " in all",
                 where, "make it smaller, or several charts"};
}

class MaskDecoder {
public:
    MaskDecoder(std::span<const std::byte> bytes, const std::string& where) : bytes_(bytes), where_(where) {}

    Result<std::vector<ChartMask>> run() {
        LUMEL_TRY(const std::uint32_t count, header());
        std::vector<ChartMask> masks;
        masks.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            LUMEL_TRY(ChartMask mask, chart(i));
            masks.push_back(std::move(mask));
        }
        if (at_ != bytes_.size())
            return damaged(std::to_string(bytes_.size() - at_) + " bytes follow the last of " + std::to_string(count) +
                           " charts");
        return masks;
    }

private:
    [[nodiscard]] Error damaged(std::string message) const {
        return {ErrorCode::invalid_input, std::move(message), where_, "write the file again"};
    }
    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
    std::uint32_t take(std::size_t size) {
        at_ += size;
        return little_endian(bytes_.subspan(at_ - size, size));
    }

    Result<std::uint32_t> header() {
        if (left() < kHeaderBytes) return damaged("is too short for a file of chart masks");
        if (take(4) != kMagic)
            return Error{ErrorCode::invalid_input, "is no file of chart masks", where_, "give a .msk file"};
        const std::uint32_t version = take(4), count = take(4), reserved = take(4);
        if (version != kMaskVersion || reserved != 0)
            return Error{ErrorCode::unsupported, "is of version " + std::to_string(version) + ", not 1", where_,
                         "write it as version 1"};
        if (count > kMaxCharts)
            return Error{ErrorCode::unsupported, "has more than " + std::to_string(kMaxCharts) + " charts", where_,
                         "make it several files"};
        // The smallest chart has one row of one byte.
        if (count > left() / (kChartHeaderBytes + 1))
            return damaged("ends before the last of " + std::to_string(count) + " charts");
        return count;
    }

    Result<ChartMask> chart(std::uint32_t index) {
        const std::string name = "chart " + std::to_string(index);
        if (left() < kChartHeaderBytes) return damaged("ends before " + name);
        const std::uint32_t width = take(2), height = take(2);
        if (width == 0 || height == 0) return damaged(name + " has no width or no height");
        LUMEL_TRY_STATUS(check_size(width, height, name, where_));
        const std::size_t row_bytes = (width + 7) / 8;
        if (left() / row_bytes < height) return damaged("ends within " + name);
        ChartMask mask(width, height);
        for (std::uint32_t y = 0; y < height; ++y) {
            for (std::size_t b = 0; b < row_bytes; ++b)
                mask.bits[std::size_t{y} * mask.words_per_row + b / 8] |= std::uint64_t{take(1)} << (8 * (b % 8));
            const std::uint64_t last = mask.bits[(std::size_t{y} + 1) * mask.words_per_row - 1];
            if (width % 64 != 0 && last >> (width % 64) != 0)
                return damaged(name + " has texels beyond its width of " + std::to_string(width));
        }
        mask.used = mask.count();
        if (mask.used == 0) return damaged(name + " has no texel");
        return mask;
    }

    std::span<const std::byte> bytes_;
    std::string where_;
    std::size_t at_ = 0;
};

void append(std::vector<std::byte>& out, std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i) & 255));
}

}  // namespace

Result<std::vector<ChartMask>> decode_masks(std::span<const std::byte> bytes, const std::string& where) {
    return MaskDecoder(bytes, where).run();
}

Result<std::vector<ChartMask>> read_masks(const std::filesystem::path& path) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(path, kMaxFileBytes));
    return decode_masks(bytes, path.string());
}

std::vector<std::byte> encode_masks(std::span<const ChartMask> masks) {
    std::vector<std::byte> out;
    append(out, kMagic, 4);
    append(out, kMaskVersion, 4);
    append(out, masks.size(), 4);
    append(out, 0, 4);
    for (const ChartMask& mask : masks) {
        LUMEL_CHECK(mask.width < 65536 && mask.height < 65536, mask.width, mask.height);
        append(out, mask.width, 2);
        append(out, mask.height, 2);
        for (std::uint32_t y = 0; y < mask.height; ++y)
            for (std::size_t b = 0; b < (mask.width + 7) / 8; ++b)
                append(out, mask.bits[std::size_t{y} * mask.words_per_row + b / 8] >> (8 * (b % 8)), 1);
    }
    return out;
}

Status write_masks(const std::filesystem::path& path, std::span<const ChartMask> masks) {
    const auto too_large = [&](const std::string& what) {
        return Error{ErrorCode::unsupported, "would have more than " + what, path.string(), "make it several files"};
    };
    if (masks.size() > kMaxCharts) return too_large(std::to_string(kMaxCharts) + " charts");
    std::uint64_t bytes = kHeaderBytes;
    for (std::size_t i = 0; i < masks.size(); ++i) {
        LUMEL_TRY_STATUS(check_size(masks[i].width, masks[i].height, "chart " + std::to_string(i), path.string()));
        bytes += kChartHeaderBytes + std::uint64_t{(masks[i].width + 7) / 8} * masks[i].height;
    }
    if (bytes > kMaxFileBytes) return too_large(std::to_string(kMaxFileBytes) + " bytes");
    return write_file(path, encode_masks(masks));
}

}  // namespace lumel
