// Disjoint sets of the numbers 0 .. n - 1.
// Based on: Tarjan and van Leeuwen 1984, "Worst-case analysis of set union algorithms" (path halving).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace lumel {

class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

    // The member that names the set of `i`.
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    // The least name of the two stays, so that whatever the order of calls a set is named by its least member.
    void unite(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    // The set named `b` becomes part of that named `a`, which keeps its name.
    void absorb(std::uint32_t a, std::uint32_t b) { parent_[b] = a; }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace lumel
