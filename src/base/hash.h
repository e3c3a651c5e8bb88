// A streaming 128-bit content hash of bytes (two independent 64-bit lanes of the FNV-1a/murmur finaliser family). It
// names inputs and artifacts; it is no defence against an adversary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace lumel {

// The finaliser of splitmix64: a bijection with full avalanche.
constexpr std::uint64_t mix64(std::uint64_t x) {
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

struct Hash128 {
    std::uint64_t high = 0, low = 0;
    friend constexpr bool operator==(const Hash128&, const Hash128&) = default;
    [[nodiscard]] std::string hex() const;  // 32 digits
};

class Hasher {
public:
    Hasher& bytes(std::span<const std::byte> data);
    Hasher& text(std::string_view text);  // its length too, so that "ab","c" differs from "a","bc"
    template <class T>
    Hasher& pod(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>,
                      "padding would make the hash depend on chance");
        return bytes(std::as_bytes(std::span(&value, 1)));
    }
    template <class T>
    Hasher& array(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        pod(static_cast<std::uint64_t>(values.size()));
        return bytes(std::as_bytes(values));
    }
    [[nodiscard]] Hash128 finish() const;

private:
    std::uint64_t a_ = 0x243f6a8885a308d3ull, b_ = 0x13198a2e03707344ull, length_ = 0;
};

}  // namespace lumel
