#include "base/hash.h"

#include <cstring>

namespace lumel {

std::string Hash128::hex() const {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string out(32, '0');
    for (std::size_t i = 0; i < 16; ++i) {
        out[i] = kDigits[(high >> (60 - 4 * i)) & 15];
        out[16 + i] = kDigits[(low >> (60 - 4 * i)) & 15];
    }
    return out;
}

Hasher& Hasher::bytes(std::span<const std::byte> data) {
    for (std::size_t i = 0; i < data.size(); i += 8) {
        std::uint64_t word = 0;
        const std::size_t n = data.size() - i < 8 ? data.size() - i : 8;
        std::memcpy(&word, data.data() + i, n);
        length_ += n;
        a_ = mix64(a_ ^ word) * 0x9e3779b97f4a7c15ull + length_;
        b_ = mix64(b_ + word) ^ (length_ * 0xc2b2ae3d27d4eb4full);
    }
    return *this;
}

Hasher& Hasher::text(std::string_view text) {
    pod(static_cast<std::uint64_t>(text.size()));
    return bytes(std::as_bytes(std::span(text.data(), text.size())));
}

Hash128 Hasher::finish() const { return {mix64(a_ ^ mix64(length_)), mix64(b_ + length_)}; }

}  // namespace lumel
