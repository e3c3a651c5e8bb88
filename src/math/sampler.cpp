#include "math/sampler.h"

namespace lumel {
std::uint32_t sampler_key(std::uint64_t seed, std::uint64_t id) {
    std::uint64_t x = seed * 0x9e3779b97f4a7c15ull + id;
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93ull;
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93ull;
    return static_cast<std::uint32_t>(x ^ (x >> 32));
}

}  // namespace lumel
