// PNG: 8 bits, filtered row by row, compressed by zlib. The only file that includes zlib.
// Based on: ISO/IEC 15948:2004, "Portable Network Graphics"; its heuristic of the least sum of absolute differences.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#include "base/check.h"
#include "io/image_io.h"

namespace lumel {
namespace {

constexpr int kZlibLevel = 6;

std::array<std::byte, 4> big_endian(std::uint32_t value) {
    std::array<std::byte, 4> out;
    for (std::size_t i = 0; i < 4; ++i) out[i] = static_cast<std::byte>(value >> (24 - 8 * i));
    return out;
}

void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
    const std::size_t before = out.size();
    out.resize(before + bytes.size());
    std::ranges::copy(bytes, out.begin() + static_cast<std::ptrdiff_t>(before));
}

void append_chunk(std::vector<std::byte>& out, const char* type, std::span<const std::byte> data) {
    append(out, big_endian(static_cast<std::uint32_t>(data.size())));
    const std::size_t start = out.size();
    append(out, std::as_bytes(std::span(type, 4)));
    append(out, data);
    const auto* const bytes = reinterpret_cast<const Bytef*>(out.data() + start);
    append(out, big_endian(static_cast<std::uint32_t>(crc32_z(0, bytes, out.size() - start))));
}

std::array<std::byte, 13> header(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
    constexpr std::array<std::uint8_t, 4> kColorTypes{0, 4, 2, 6};  // grey, grey and alpha, RGB, RGBA
    std::array<std::byte, 13> out{};
    std::ranges::copy(big_endian(width), out.begin());
    std::ranges::copy(big_endian(height), out.begin() + 4);
    out[8] = std::byte{8};  // bits
    out[9] = std::byte{kColorTypes[channels - 1]};
    return out;
}

// The neighbour (left, above, above left) that is nearest to their plane.
std::uint8_t paeth(int left, int above, int corner) {
    const int p = left + above - corner;
    const int to_left = std::abs(p - left), to_above = std::abs(p - above), to_corner = std::abs(p - corner);
    if (to_left <= to_above && to_left <= to_corner) return static_cast<std::uint8_t>(left);
    return static_cast<std::uint8_t>(to_above <= to_corner ? above : corner);
}

// Filters rows; each is what the row and the one above give.
class RowFilter {
public:
    RowFilter(std::size_t bytes, std::uint32_t channels) : channels_(channels), above_(channels + bytes) {
        row_ = above_;
        for (auto& candidate : candidates_) candidate.resize(1 + bytes);
        for (std::uint8_t f = 0; f < kFilters; ++f) candidates_[f][0] = f;
    }

    // The row with the number of its filter before it; valid until the next call.
    std::span<const std::uint8_t> filter(std::span<const std::uint8_t> pixels) {
        std::swap(row_, above_);
        std::ranges::copy(pixels, row_.begin() + channels_);
        // Much of an atlas is empty, and any filter of nothing is nothing.
        const bool was_empty = std::exchange(empty_, is_zero(pixels));
        if (empty_ && was_empty) {
            std::ranges::fill(candidates_[0], std::uint8_t{0});
            return candidates_[0];
        }
        std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
        std::size_t best = 0;
        for (std::size_t f = 0; f < kFilters; ++f) {
            apply(f);
            const std::uint64_t cost = cost_of(candidates_[f]);
            if (cost < least) {
                least = cost;
                best = f;
            }
        }
        return candidates_[best];
    }

private:
    static constexpr std::size_t kFilters = 5;  // none, left, above, mean of the two, Paeth

    static bool is_zero(std::span<const std::uint8_t> bytes) {
        return bytes[0] == 0 && std::memcmp(bytes.data(), bytes.data() + 1, bytes.size() - 1) == 0;
    }

    void apply(std::size_t f) {
        std::uint8_t* const out = candidates_[f].data() + 1;
        const std::size_t count = candidates_[f].size() - 1;
        // The pixel left of the first is zero.
        const std::uint8_t *const row = row_.data() + channels_, *const left = row_.data();
        const std::uint8_t *const above = above_.data() + channels_, *const corner = above_.data();
        const auto store = [&](auto&& predict) {
            for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<std::uint8_t>(row[i] - predict(i));
        };
        switch (f) {
            case 0: return store([](std::size_t) { return 0; });
            case 1: return store([&](std::size_t i) { return left[i]; });
            case 2: return store([&](std::size_t i) { return above[i]; });
            case 3: return store([&](std::size_t i) { return (left[i] + above[i]) / 2; });
            default: return store([&](std::size_t i) { return paeth(left[i], above[i], corner[i]); });
        }
    }

    static std::uint64_t cost_of(std::span<const std::uint8_t> filtered) {
        std::uint64_t sum = 0;
        for (const std::uint8_t byte : filtered.subspan(1))
            sum += static_cast<std::uint64_t>(std::abs(int{static_cast<std::int8_t>(byte)}));
        return sum;
    }

    std::uint32_t channels_;
    std::vector<std::uint8_t> above_, row_;  // a zero pixel before each
    bool empty_ = true;                      // of the row above: the first has none
    std::array<std::vector<std::uint8_t>, kFilters> candidates_;
};

class Deflater {
public:
    Deflater() { LUMEL_CHECK(deflateInit(&stream_, kZlibLevel) == Z_OK, kZlibLevel); }
    ~Deflater() { deflateEnd(&stream_); }
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;

    void add(std::span<const std::uint8_t> bytes, bool last) {
        stream_.next_in = const_cast<Bytef*>(bytes.data());  // which it only reads
        stream_.avail_in = static_cast<uInt>(bytes.size());
        do {
            std::array<std::byte, 1 << 16> buffer;
            stream_.next_out = reinterpret_cast<Bytef*>(buffer.data());
            stream_.avail_out = static_cast<uInt>(buffer.size());
            const int result = deflate(&stream_, last ? Z_FINISH : Z_NO_FLUSH);
            LUMEL_CHECK(result != Z_STREAM_ERROR, result);
            append(out_, std::span(buffer).first(buffer.size() - stream_.avail_out));
        } while (stream_.avail_out == 0);
    }

    [[nodiscard]] std::span<const std::byte> bytes() const { return out_; }

private:
    z_stream stream_{};
    std::vector<std::byte> out_;
};

}  // namespace

std::vector<std::byte> encode_png(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                                  std::span<const std::uint8_t> pixels) {
    LUMEL_CHECK(width > 0 && height > 0 && channels >= 1 && channels <= 4, width, height, channels);
    LUMEL_CHECK(pixels.size() == std::size_t{width} * height * channels, pixels.size(), width, height, channels);
    const std::size_t row = std::size_t{width} * channels;
    RowFilter filter(row, channels);
    Deflater deflater;
    for (std::uint32_t y = 0; y < height; ++y)
        deflater.add(filter.filter(pixels.subspan(y * row, row)), y + 1 == height);
    constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    std::vector<std::byte> out;
    out.reserve(deflater.bytes().size() + 64);
    append(out, std::as_bytes(std::span(kSignature)));
    append_chunk(out, "IHDR", header(width, height, channels));
    append_chunk(out, "IDAT", deflater.bytes());
    append_chunk(out, "IEND", {});
    return out;
}

Status write_png(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                 std::span<const std::uint8_t> pixels) {
    return write_file(path, encode_png(width, height, channels, pixels));
}

}  // namespace lumel
