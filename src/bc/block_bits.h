// The bits of a block of 8 or 16 bytes, least significant first, as all BC formats number them.
#pragma once

#include <array>
#include <cstdint>

namespace lumel {

using BcBlock8 = std::array<std::uint8_t, 8>;
using BcBlock16 = std::array<std::uint8_t, 16>;

// Bits beyond the end read as 0.
class BlockReader {
public:
    template <std::size_t kBytes>
    explicit BlockReader(const std::array<std::uint8_t, kBytes>& block) {
        static_assert(kBytes <= 16);
        for (std::size_t i = 0; i < kBytes; ++i) words_[i / 8] |= std::uint64_t{block[i]} << (8 * (i % 8));
    }

    // 0 <= count <= 32
    std::uint32_t read(unsigned count) {
        std::uint64_t bits = position_ < 64    ? words_[0] >> position_
                             : position_ < 128 ? words_[1] >> (position_ - 64)
                                               : 0;
        if (position_ > 0 && position_ < 64) bits |= words_[1] << (64 - position_);
        position_ += count;
        return static_cast<std::uint32_t>(bits & ((std::uint64_t{1} << count) - 1));
    }

    [[nodiscard]] unsigned position() const { return position_; }

private:
    std::array<std::uint64_t, 2> words_{};
    unsigned position_ = 0;
};

class BlockWriter {
public:
    // 0 <= count <= 32; `value` has no bits above these.
    void write(std::uint32_t value, unsigned count) {
        const std::uint64_t bits = value;
        if (position_ < 64) {
            words_[0] |= bits << position_;
            if (position_ > 0) words_[1] |= bits >> (64 - position_);
        } else {
            words_[1] |= bits << (position_ - 64);
        }
        position_ += count;
    }

    [[nodiscard]] unsigned position() const { return position_; }

    [[nodiscard]] BcBlock16 block16() const { return bytes<16>(); }
    [[nodiscard]] BcBlock8 block8() const { return bytes<8>(); }

private:
    template <std::size_t kBytes>
    [[nodiscard]] std::array<std::uint8_t, kBytes> bytes() const {
        std::array<std::uint8_t, kBytes> out;
        for (std::size_t i = 0; i < kBytes; ++i) out[i] = static_cast<std::uint8_t>(words_[i / 8] >> (8 * (i % 8)));
        return out;
    }

    std::array<std::uint64_t, 2> words_{};
    unsigned position_ = 0;
};

}  // namespace lumel
