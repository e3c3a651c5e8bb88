#include "base/union_find.h"

#include <gtest/gtest.h>

#include <array>

namespace lumel {
namespace {

TEST(UnionFind, SetsAreNamedByTheirLeastMemberInAnyOrder) {
    const std::array<std::array<std::uint32_t, 2>, 4> pairs{{{7, 3}, {3, 5}, {9, 7}, {2, 8}}};
    for (const bool backwards : {false, true}) {
        UnionFind sets(10);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto& [a, b] = pairs[backwards ? pairs.size() - 1 - i : i];
            sets.unite(a, b);
        }
        constexpr std::array<std::uint32_t, 10> kNames{0, 1, 2, 3, 4, 3, 6, 3, 2, 3};
        for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(sets.find(i), kNames[i]) << i;
    }
}

TEST(UnionFind, WhoAbsorbsKeepsItsName) {
    UnionFind sets(4);
    sets.absorb(2, 0);
    sets.absorb(3, 2);
    EXPECT_EQ(sets.find(0), 3u);
    EXPECT_EQ(sets.find(1), 1u);
}

}  // namespace
}  // namespace lumel
