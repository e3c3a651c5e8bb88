#include "math/sampler.h"

#include <array>
#include <bit>

namespace lumel {
namespace {

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

// A hash in which a bit depends on lower bits only: an Owen scramble of the reversed number.
// Constants: Vegdahl 2021 (improved Laine-Karras hash).
constexpr std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Dimension 1 of Sobol, bit-reversed: column k of the generator matrix reversed. Dimension 0 is the index reversed.
constexpr std::array<std::uint32_t, 32> make_reversed_second_dimension() {
    std::array<std::uint32_t, 32> columns{};
    std::uint32_t column = 1u << 31;  // v_1
    for (std::uint32_t k = 0; k < 32; ++k) {
        columns[k] = reverse_bits(column);
        column ^= column >> 1;  // primitive polynomial x + 1
    }
    return columns;
}

// Tables by byte: 4 look-ups and XORs instead of up to 32.
constexpr std::array<std::array<std::uint32_t, 256>, 4> make_byte_tables() {
    const auto columns = make_reversed_second_dimension();
    std::array<std::array<std::uint32_t, 256>, 4> tables{};
    for (std::uint32_t byte = 0; byte < 4; ++byte)
        for (std::uint32_t value = 0; value < 256; ++value)
            for (std::uint32_t bit = 0; bit < 8; ++bit)
                if (value >> bit & 1u) tables[byte][value] ^= columns[byte * 8 + bit];
    return tables;
}

constexpr auto kSecondDimension = make_byte_tables();

std::uint32_t reversed_sobol_1(std::uint32_t index) {
    return kSecondDimension[0][index & 255u] ^ kSecondDimension[1][(index >> 8) & 255u] ^
           kSecondDimension[2][(index >> 16) & 255u] ^ kSecondDimension[3][index >> 24];
}

}  // namespace

Vec2 Sampler::pair(std::uint32_t pair) const {
    const std::uint32_t seed = mix32(key_ + pair * 0x9e3779b9u);
    // Shuffle: an Owen scramble of the index keeps every aligned power-of-two block of samples a (0,2)-net.
    const std::uint32_t shuffled = reverse_bits(laine_karras(reverse_bits(index_), seed));
    const std::uint32_t x = reverse_bits(laine_karras(shuffled, mix32(seed ^ 0xa511e9b3u)));
    const std::uint32_t y = reverse_bits(laine_karras(reversed_sobol_1(shuffled), mix32(seed ^ 0x63d83595u)));
    return {unit_float(x), unit_float(y)};
}

std::uint32_t sampler_key(std::uint64_t seed, std::uint64_t id) {
    std::uint64_t x = seed * 0x9e3779b97f4a7c15ull + id;
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93ull;
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93ull;
    return static_cast<std::uint32_t>(x ^ (x >> 32));
}

}  // namespace lumel
