// Numbers in files, least significant byte first; so are those of the machines that Lumel runs on.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace lumel {

static_assert(std::endian::native == std::endian::little);

// The caller has checked that four bytes follow `at`.
inline std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

}  // namespace lumel
