// The content hash: what must differ does, how the bytes arrive does not matter, and the value is fixed for ever.
#include "base/hash.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

namespace lumel {
namespace {

std::string hash_of(const std::vector<unsigned char>& bytes) {
    return Hasher().bytes(std::as_bytes(std::span(bytes))).finish().hex();
}

TEST(Hash, EveryBitOfTheInputCounts) {
    std::vector<unsigned char> bytes(19, 0);
    std::set<std::string> seen{hash_of(bytes)};
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        auto flipped = bytes;
        flipped[bit / 8] = static_cast<unsigned char>(1u << (bit % 8));
        seen.insert(hash_of(flipped));
    }
    EXPECT_EQ(seen.size(), bytes.size() * 8 + 1);
}

TEST(Hash, LengthCounts) {
    std::set<std::string> seen;
    for (std::size_t length = 0; length < 40; ++length) seen.insert(hash_of(std::vector<unsigned char>(length, 0)));
    EXPECT_EQ(seen.size(), 40u);
}

TEST(Hash, TextKeepsItsBounds) {
    EXPECT_NE(Hasher().text("ab").text("c").finish(), Hasher().text("a").text("bc").finish());
}

TEST(Hash, OrderCounts) { EXPECT_NE(Hasher().pod(1).pod(2).finish(), Hasher().pod(2).pod(1).finish()); }

TEST(Hash, HexIsTheValueInOrder) {
    EXPECT_EQ((Hash128{0x0123456789abcdefull, 0xfedcba9876543210ull}.hex()), "0123456789abcdeffedcba9876543210");
}

// A flip of one input bit flips each output bit half of the time: 4 standard errors of a mean over 64 * 64 coin tosses.
TEST(Hash, FinaliserAvalanches) {
    int flips = 0;
    for (int bit = 0; bit < 64; ++bit)
        for (int k = 0; k < 64; ++k) {
            const std::uint64_t x = mix64(static_cast<std::uint64_t>(k) + 1);
            flips += __builtin_popcountll(mix64(x) ^ mix64(x ^ (1ull << bit)));
        }
    const double mean = flips / (64.0 * 64.0);
    EXPECT_NEAR(mean, 32.0, 4.0 * 4.0 / 64.0);  // popcount of 64 fair bits has standard deviation 4
}

}  // namespace
}  // namespace lumel
