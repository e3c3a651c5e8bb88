#include "pack/kernels.h"

#include <bit>
#include <cstring>

// The bodies below are inlined into one function per instruction set.
#define LUMEL_INLINE [[gnu::always_inline]] inline

namespace lumel {
namespace {

using Words = std::uint64_t __attribute__((vector_size(8 * FreeMap::kBlockWords)));

LUMEL_INLINE void load(Words& out, const std::uint64_t* from) { std::memcpy(&out, from, sizeof out); }
LUMEL_INLINE bool any(const Words& words) { return ((words[0] | words[1]) | (words[2] | words[3])) != 0; }

// ---- Positions where a chart fits -----------------------------------------------------------------------------------

// The first set bit at or after `at`, or `end` where there is none before it.
LUMEL_INLINE std::uint32_t next_set(const std::uint64_t* bits, std::uint32_t at, std::uint32_t end) {
    if (at >= end) return end;
    std::uint32_t word = at / 64;
    std::uint64_t left = bits[word] & (~std::uint64_t{0} << (at % 64));
    while (left == 0) {
        if (++word * 64 >= end) return end;
        left = bits[word];
    }
    return word * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
}

// Units of positions for which all of the first squares may be free.
LUMEL_INLINE std::uint64_t possible_units(const FreeMap& map, const CoverSquare* squares, std::size_t count,
                                          std::uint32_t y, std::uint64_t units) {
    const std::uint32_t shift = map.unit_shift(), rest = (1u << shift) - 1;
    for (std::size_t i = 0; i < count && units != 0; ++i) {
        const CoverSquare& s = squares[i];
        const std::uint64_t first = map.units(s.level)[y + s.y] >> (s.x >> shift);
        units &= (s.x & rest) == 0 ? first : first | first >> 1;
    }
    return units;
}

// Keeps those positions of a block that a square allows. `at`: the word of the block in the square's row.
LUMEL_INLINE void keep_free(const std::uint64_t* at, std::uint64_t shift, Words& fits) {
    Words low, high;
    load(low, at);
    load(high, at + 1);
    fits &= low >> shift | high << (63 - shift) << 1;
}

// Where the squares' bits are for a position of 0, 0.
struct Probe {
    const std::uint64_t* words;
    std::uint64_t shift;
};
LUMEL_INLINE Probe probe(const FreeMap& map, const CoverSquare& s) {
    return {map.row(s.level, s.y) + s.x / 64, s.x % 64};
}

// Positions of one block, `offset` words from 0, 0, where all squares are free. The branches on what is found cost more
// than the tests: the first squares are tested two at a time.
LUMEL_INLINE bool test_block(const FreeMap& map, const Probe* probes, std::size_t probe_count,
                             const CoverSquare* squares, std::size_t count, std::size_t offset, Words& fits) {
    std::size_t i = 0;
    for (; i + 2 <= probe_count; i += 2) {
        keep_free(probes[i].words + offset, probes[i].shift, fits);
        keep_free(probes[i + 1].words + offset, probes[i + 1].shift, fits);
        if (!any(fits)) return false;
    }
    for (; i < count; ++i) {
        const Probe p = probe(map, squares[i]);
        keep_free(p.words + offset, p.shift, fits);
        if (!any(fits)) return false;
    }
    return true;
}

LUMEL_INLINE bool next_fit_body(const FreeMap& map, const CoverSquare* squares, std::size_t count, std::uint32_t last_x,
                                std::uint32_t last_y, FitSearch& search) {
    const CoverSquare first = squares[0];
    const std::uint64_t* rows = map.rows(first.level).data();
    const std::uint32_t last_block = last_x / FreeMap::kBlockBits, rows_end = last_y + first.y + 1;
    // The first squares reject nearly all positions: their summaries are asked before their bits are, and where these
    // are is found once.
    constexpr std::size_t kFirst = 8;
    const std::size_t first_count = count < kFirst ? count : kFirst;
    Probe probes[kFirst];
    for (std::size_t i = 0; i < first_count; ++i) probes[i] = probe(map, squares[i]);
    const std::uint32_t units_per_block = FreeMap::kBlockBits >> map.unit_shift();
    const std::uint64_t of_block = (std::uint64_t{1} << units_per_block) - 1;
    const std::uint64_t in_width = ~std::uint64_t{0} >> (63 - (last_x >> map.unit_shift()));
    // Of the first row to look at.
    std::uint64_t here = search.block > last_block ? 0 : ~std::uint64_t{0} << (search.block * units_per_block);
    Words limit{~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}};  // of the last block
    for (std::uint32_t w = 0; w < FreeMap::kBlockWords; ++w) {
        const std::uint32_t x = last_block * FreeMap::kBlockBits + w * 64;
        if (x > last_x)
            limit[w] = 0;
        else if (last_x - x < 63)
            limit[w] = (std::uint64_t{2} << (last_x - x)) - 1;
    }
    for (std::uint32_t y = search.y;; ++y, here = ~std::uint64_t{0}) {
        const std::uint32_t row = next_set(rows, y + first.y, rows_end);
        if (row == rows_end) return false;
        if (row != y + first.y) here = ~std::uint64_t{0};
        y = row - first.y;
        std::uint64_t left = possible_units(map, squares, first_count, y, here & in_width);
        while (left != 0) {
            const std::uint32_t block = static_cast<std::uint32_t>(std::countr_zero(left)) / units_per_block;
            left &= ~(of_block << (block * units_per_block));
            Words fits = ~Words{};
            if (block == last_block) fits = limit;
            const std::size_t offset = std::size_t{y} * map.stride() + block * FreeMap::kBlockWords;
            if (!test_block(map, probes, first_count, squares, count, offset, fits)) continue;
            search.y = y;
            search.block = block;
            std::memcpy(search.fits.data(), &fits, sizeof fits);
            return true;
        }
    }
}

// ---- The cost of a position -----------------------------------------------------------------------------------------

// Free texels of the rim that lie in no free square of 2 x 2.
LUMEL_INLINE std::int32_t count_stranded(const FrameView& frame, const std::uint64_t* free, std::uint64_t* squares) {
    const std::size_t rows = frame.rows;
    // Squares begin where the texel, the one to its right and the two below are free.
    for (std::size_t c = 1; c <= frame.columns; ++c) {
        const std::uint64_t *here = free + c * rows, *right = here + rows;
        std::uint64_t* out = squares + c * rows;
        for (std::size_t r = 0; r < rows; ++r) out[r] = here[r] & (here[r] >> 1 | right[r] << 63);
    }
    std::int32_t count = 0;
    for (std::size_t c = 1; c <= frame.columns; ++c) {
        std::uint64_t* s = squares + c * rows;
        for (std::size_t r = 0; r + 1 < rows; ++r) s[r] &= s[r + 1];
        s[rows - 1] = 0;
        const std::uint64_t *here = free + c * rows, *rim = frame.rim + c * rows, *left = s - rows;
        for (std::size_t r = 1; r + 1 < rows; ++r) {
            const std::uint64_t both = s[r] | s[r - 1], before = left[r] | left[r - 1];
            count += std::popcount(here[r] & ~(both | both << 1 | before >> 63) & rim[r]);
        }
    }
    return count;
}

LUMEL_INLINE FrameRating rate_body(const FrameView& frame, const std::uint64_t* texels, std::size_t stride,
                                   std::uint32_t shift, std::uint64_t* scratch) {
    const std::size_t rows = frame.rows, size = (frame.columns + 2) * rows;
    std::uint64_t *before = scratch, *after = scratch + size, *squares = scratch + 2 * size;
    std::memset(before + (frame.columns + 1) * rows, 0, rows * sizeof *before);
    std::memset(after + (frame.columns + 1) * rows, 0, rows * sizeof *after);
    std::memset(squares, 0, rows * sizeof *squares);
    FrameRating out;
    for (std::size_t c = 1; c <= frame.columns; ++c) {
        const std::uint64_t* word = texels + (c - 1);
        for (std::size_t r = 0; r < rows; ++r, word += stride) {
            const std::size_t i = c * rows + r;
            before[i] = word[0] >> shift | word[1] << (63 - shift) << 1;
            after[i] = before[i] & ~frame.mask[i];
            out.open += std::popcount(before[i] & frame.side[i]);
        }
    }
    out.stranded = count_stranded(frame, after, squares) - count_stranded(frame, before, squares);
    return out;
}

// ---- Tiny charts ----------------------------------------------------------------------------------------------------

LUMEL_INLINE std::size_t first_disjoint_body(const std::uint64_t* a, const std::uint64_t* b, std::size_t begin,
                                             std::size_t end, std::uint64_t not_in_a, std::uint64_t not_in_b) {
    constexpr std::size_t kStep = 16;
    std::size_t i = begin;
    const auto meets = [&](std::size_t k) { return ((a[k] & not_in_a) | (b[k] & not_in_b)) != 0; };
    for (; i % kStep != 0 && i < end; ++i)
        if (!meets(i)) return i;
    for (; i < end; i += kStep) {
        std::uint64_t disjoint = 0;
        for (std::size_t k = 0; k < kStep; ++k)
            disjoint |= ((a[i + k] & not_in_a) | (b[i + k] & not_in_b)) == 0 ? ~std::uint64_t{0} : 0;
        if (disjoint == 0) continue;
        for (std::size_t k = i; k < i + kStep && k < end; ++k)
            if (!meets(k)) return k;
    }
    return end;
}

LUMEL_INLINE std::int32_t stranded_body(const TinyWindow& free) {
    constexpr std::size_t n = kTinyRows;
    constexpr std::uint32_t inner2 = 0x7ffffffeu, inner3 = 0x3ffffffcu;
    std::uint32_t pairs[n + 2] = {}, threes[n + 2] = {}, two[n + 2] = {}, three[n + 2] = {};
    for (std::size_t r = 0; r < n; ++r) {
        pairs[r] = free[r] & free[r] >> 1;
        threes[r] = pairs[r] & free[r] >> 2;
    }
    // Row r + 1 of `two`, `three`: texels covered by the squares that begin in row r.
    for (std::size_t r = 0; r + 1 < n; ++r) {
        const std::uint32_t s = pairs[r] & pairs[r + 1];
        two[r + 1] = s | s << 1;
    }
    for (std::size_t r = 0; r + 2 < n; ++r) {
        const std::uint32_t s = threes[r] & threes[r + 1] & threes[r + 2];
        three[r + 2] = s | s << 1 | s << 2;
    }
    std::int32_t out = 0;
    for (std::size_t r = 1; r + 1 < n; ++r) out += 2 * std::popcount(free[r] & ~(two[r + 1] | two[r]) & inner2);
    for (std::size_t r = 2; r + 2 < n; ++r)
        out += std::popcount(free[r] & ~(three[r + 2] | three[r + 1] | three[r]) & inner3);
    return out;
}

// ---- One set of functions per instruction set -----------------------------------------------------------------------

#define LUMEL_KERNELS(name, attribute)                                                                             \
    attribute bool next_fit_##name(const FreeMap& map, const CoverSquare* squares, std::size_t count,              \
                                   std::uint32_t last_x, std::uint32_t last_y, FitSearch& search) {                \
        return next_fit_body(map, squares, count, last_x, last_y, search);                                         \
    }                                                                                                              \
    attribute FrameRating rate_##name(const FrameView& frame, const std::uint64_t* texels, std::size_t stride,     \
                                      std::uint32_t shift, std::uint64_t* scratch) {                               \
        return rate_body(frame, texels, stride, shift, scratch);                                                   \
    }                                                                                                              \
    attribute std::size_t first_disjoint_##name(const std::uint64_t* a, const std::uint64_t* b, std::size_t begin, \
                                                std::size_t end, std::uint64_t not_in_a, std::uint64_t not_in_b) { \
        return first_disjoint_body(a, b, begin, end, not_in_a, not_in_b);                                          \
    }                                                                                                              \
    attribute std::int32_t stranded_##name(const TinyWindow& free) { return stranded_body(free); }                 \
    constexpr Kernels k_##name = {next_fit_##name, rate_##name, first_disjoint_##name, stranded_##name};

LUMEL_KERNELS(plain, )
#if defined(__x86_64__)
LUMEL_KERNELS(avx2, [[gnu::target("avx2,bmi,bmi2,popcnt")]])
LUMEL_KERNELS(avx512, [[gnu::target("avx2,bmi,bmi2,popcnt,avx512f,avx512bw,avx512dq,avx512vl,avx512vpopcntdq")]])
#endif

struct Available {
    std::array<const Kernels*, 3> sets{&k_plain, nullptr, nullptr};
    std::size_t count = 1;

    Available() {
#if defined(__x86_64__)
        if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi") || !__builtin_cpu_supports("bmi2") ||
            !__builtin_cpu_supports("popcnt"))
            return;
        sets[count++] = &k_avx2;
        if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
            __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vpopcntdq"))
            sets[count++] = &k_avx512;
#endif
    }
};

const Available& available() {
    static const Available found;
    return found;
}

}  // namespace

const Kernels& kernels() { return *available().sets[available().count - 1]; }

const Kernels* const* all_kernels(std::size_t& count) {
    count = available().count;
    return available().sets.data();
}

}  // namespace lumel
