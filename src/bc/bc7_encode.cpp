// The encoder of BC7. Colour without alpha is tried in mode 6 (one line), 5 and 4 (one channel with indices of its own)
// and 1 and 3 (two subsets); with alpha in 6, 5, 4 and 7. What comes out of an image without alpha has alpha 255, or
// 254 where mode 6 has rounded it. Based on: Khronos Data Format Specification 1.3, section "BC7".
#include <algorithm>
#include <cmath>

#include "bc/bc7.h"
#include "bc/bc7_modes.h"
#include "bc/block_image.h"
#include "bc/partition_search.h"
#include "bc/subset_fit.h"

namespace lumel {
namespace {

using namespace bc;

constexpr unsigned kPartitions = kTwoSubsetPartitions;

// What each quality spends.
struct Effort {
    unsigned rounds, polish, partitions;
    unsigned separate_ways;  // of modes 5 and 4
    bool few_partitions;     // the first half, which are the plainest, and mode 1 alone
    float good_enough;       // squared error per texel, in codes, below which the search ends
};

constexpr Effort effort_of(BcQuality quality) {
    switch (quality) {
        case BcQuality::fast: return {1, 1, 1, 0, true, 0.5f};
        case BcQuality::normal: return {1, 2, 2, 1, false, 0.1f};
        default: return {3, 4, 16, 3, false, 0.0f};
    }
}

struct Block {
    Lanes x[4];  // codes 0..255, less the mean
    Lanes weight;
    float mean[4];
    Effort effort;
};

struct Encoded {
    float error = 3e38f;
    unsigned mode = 6, partition = 0, rotation = 0, selector = 0;
    std::uint32_t ends[4][4] = {};  // as stored, without the low bit; four end points, four channels
    std::uint32_t low[4] = {};      // the low bits
    Lanes index, second;            // second: of the channel with indices of its own
};

template <unsigned kChannels>
LUMEL_BC_INLINE bool load(const BlockTexels<kChannels>& texels, Block& block) {
    block.weight.load(texels.weight.data());
    const float total = sum(block.weight);
    if (!(total > 0.0f)) return false;
    for (Quad& w : block.weight.q) w /= total;
    for (unsigned c = 0; c < kChannels; ++c) {
        const std::array<float, 16> codes = to_codes(texels.value[c]);
        block.x[c].load(codes.data());
        block.mean[c] = dot(block.weight, block.x[c]);
        for (unsigned i = 0; i < kQuads; ++i)
            block.x[c].q[i] = block.weight.q[i] > 0.0f ? block.x[c].q[i] - block.mean[c] : Quad{};
    }
    return true;
}

// Stored numbers of an end point's channel and the codes they mean; `low` is the bit below them.
struct Grid {
    unsigned bits;  // stored
    bool has_low;

    [[nodiscard]] LUMEL_BC_INLINE std::uint32_t code(std::uint32_t stored, std::uint32_t low) const {
        const unsigned width = bits + (has_low ? 1 : 0);
        const std::uint32_t value = (has_low ? stored << 1 | low : stored) << (8 - width);
        return value | value >> width;
    }

    [[nodiscard]] LUMEL_BC_INLINE std::uint32_t below(float code, std::uint32_t low) const {
        const unsigned width = bits + (has_low ? 1 : 0);
        const float level = code * (static_cast<float>((1u << width) - 1) / 255.0f);
        const float q = has_low ? (level - static_cast<float>(low)) * 0.5f : level;
        const float top = static_cast<float>((1u << bits) - 1), positive = q > 0.0f ? q : 0.0f;
        return static_cast<std::uint32_t>(positive < top ? positive : top);
    }
};

// One line with its rounded end points.
template <unsigned kChannels>
struct RoundedEnds {
    std::uint32_t a[kChannels] = {}, b[kChannels] = {};  // stored
    std::uint32_t low_a = 0, low_b = 0;
    EndPair<kChannels> codes = {};
    float error = 3e38f;
};

// Both end points of each channel, rounded together, for given low bits.
template <unsigned kChannels>
LUMEL_BC_INLINE void round_with(const Quadratic<kChannels>& q, const Grid& grid, const float* mean,
                                const EndPair<kChannels>& ends, std::uint32_t low_a, std::uint32_t low_b,
                                RoundedEnds<kChannels>& out) {
    const std::uint32_t top = (1u << grid.bits) - 1;
    out.low_a = low_a;
    out.low_b = low_b;
    out.error = 0.0f;
    for (unsigned c = 0; c < kChannels; ++c) {
        const std::uint32_t a0 = grid.below(ends.a[c] + mean[c], low_a), b0 = grid.below(ends.b[c] + mean[c], low_b);
        const std::uint32_t as[2] = {a0, std::min(a0 + 1, top)}, bs[2] = {b0, std::min(b0 + 1, top)};
        float av[2], bv[2];
        for (unsigned k = 0; k < 2; ++k) {
            av[k] = static_cast<float>(grid.code(as[k], low_a)) - mean[c];
            bv[k] = static_cast<float>(grid.code(bs[k], low_b)) - mean[c];
        }
        float least = 3e38f;
        for (unsigned k = 0; k < 4; ++k) {
            const float error = channel_error(q, c, av[k / 2], bv[k % 2]);
            if (!(error < least)) continue;
            least = error;
            out.a[c] = as[k / 2];
            out.b[c] = bs[k % 2];
            out.codes.a[c] = av[k / 2];
            out.codes.b[c] = bv[k % 2];
        }
        out.error += least;
    }
}

// The best of all low bits that the mode allows.
template <unsigned kChannels>
LUMEL_BC_INLINE void round_ends(const Quadratic<kChannels>& q, const Grid& grid, Bc7LowBit low_bit, const float* mean,
                                const EndPair<kChannels>& ends, RoundedEnds<kChannels>& best) {
    const unsigned count = low_bit == Bc7LowBit::each ? 4 : low_bit == Bc7LowBit::shared ? 2 : 1;
    for (unsigned k = 0; k < count; ++k) {
        RoundedEnds<kChannels> found;
        round_with(q, grid, mean, ends, k & 1, low_bit == Bc7LowBit::each ? k >> 1 : k & 1, found);
        if (found.error < best.error) best = found;
    }
}

// For each texel the better of the two palette entries around it, by the codes that come out; returns the error.
template <unsigned kChannels>
LUMEL_BC_INLINE float exact_indices(const Lanes* x, const Lanes& weight, const float* mean,
                                    const EndPair<kChannels>& ends, float steps, const Lanes& limit, Lanes& index) {
    float d[kChannels], length2 = 0.0f, offset = 0.0f;
    for (unsigned c = 0; c < kChannels; ++c) {
        d[c] = ends.b[c] - ends.a[c];
        length2 += d[c] * d[c];
        offset += d[c] * ends.a[c];
    }
    const float scale = length2 > 0.0f ? steps / length2 : 0.0f;
    Lanes error;
    for (unsigned i = 0; i < kQuads; ++i) {
        Quad t = Quad{} - offset;
        for (unsigned c = 0; c < kChannels; ++c) t += d[c] * x[c].q[i];
        t *= scale;
        t = t > 0.0f ? t : Quad{};
        t = smaller(t, limit.q[i]);
        const Quad k0 = __builtin_convertvector(__builtin_convertvector(t, QuadInt), Quad);
        const Quad k1 = smaller(k0 + 1.0f, limit.q[i]);
        const Quad t0 = palette_position(k0, steps), t1 = palette_position(k1, steps);
        Quad e0 = {}, e1 = {};
        for (unsigned c = 0; c < kChannels; ++c) {
            // Codes are multiples of 1/64 before rounding; halves go up.
            const float base = ends.a[c] + mean[c] + 1.0f / 128.0f;
            const Quad texel = x[c].q[i] + mean[c];
            const Quad p0 = texel - rounded(base + d[c] * t0), p1 = texel - rounded(base + d[c] * t1);
            e0 += p0 * p0;
            e1 += p1 * p1;
        }
        index.q[i] = e1 < e0 ? k1 : k0;
        error.q[i] = weight.q[i] * smaller(e1, e0);
    }
    return sum(error);
}

// One line for the texels of `subset`, rounded and polished. Returns the error.
template <unsigned kChannels>
float fit_line(const Subset<kChannels>& subset, const float* mean, const Grid& grid, Bc7LowBit low_bit, float steps,
               unsigned anchor, const Effort& effort, RoundedEnds<kChannels>& best, Lanes& best_index) {
    Lanes limit, index;
    limit.fill(steps);
    limit.set(anchor, (steps - 1.0f) * 0.5f);
    EndPair<kChannels> ends;
    fit_ends(subset, steps, effort.rounds, ends);
    float least = 3e38f;
    for (unsigned round = 0; round < effort.polish; ++round) {
        orient(subset.x, anchor, ends);
        nearest_indices(subset.x, ends, steps, limit, index);
        Quadratic<kChannels> q;
        make_quadratic(subset, index, steps, q);
        RoundedEnds<kChannels> found;
        round_ends(q, grid, low_bit, mean, ends, found);
        const float error = exact_indices(subset.x, subset.weight, mean, found.codes, steps, limit, index);
        if (error < least) {
            least = error;
            best = found;
            best_index = index;
        }
        if (round + 1 == effort.polish) break;
        make_quadratic(subset, index, steps, q);
        solve(subset, q, ends);
    }
    return least;
}

template <unsigned kChannels>
LUMEL_BC_INLINE void store_ends(const RoundedEnds<kChannels>& ends, unsigned at, Encoded& out) {
    for (unsigned c = 0; c < kChannels; ++c) {
        out.ends[at][c] = ends.a[c];
        out.ends[at + 1][c] = ends.b[c];
    }
    out.low[at] = ends.low_a;
    out.low[at + 1] = ends.low_b;
}

// Mode 6, or one without alpha in it.
template <unsigned kChannels>
void try_one_subset(const Block& block, Encoded& best) {
    Subset<kChannels> subset;
    make_subset(block.x, block.weight, subset);
    RoundedEnds<kChannels> ends;
    Lanes index;
    const float error =
        fit_line(subset, block.mean, Grid{7, true}, Bc7LowBit::each, 15.0f, 0, block.effort, ends, index);
    if (!(error < best.error)) return;
    best.error = error;
    best.mode = 6;
    best.partition = best.rotation = best.selector = 0;
    best.ends[0][3] = best.ends[1][3] = 127;
    store_ends(ends, 0, best);
    best.index = index;
}

// Modes 1, 3 and 7.
template <unsigned kChannels>
void try_two_subsets(const Block& block, unsigned number, unsigned partition, Encoded& best) {
    const Bc7Mode& mode = kBc7ModeTable[number];
    const auto steps = static_cast<float>((1u << mode.index_bits) - 1);
    const Grid grid{mode.colour_bits, mode.low_bit != Bc7LowBit::none};
    RoundedEnds<kChannels> ends[2];
    Lanes index[2];
    float error = 0.0f;
    for (unsigned s = 0; s < 2; ++s) {
        const Lanes weight = weights_of(block.weight, partition, s);
        Subset<kChannels> subset;
        make_subset(block.x, weight, subset);
        error += fit_line(subset, block.mean, grid, mode.low_bit, steps, anchor_of(2, partition, s), block.effort,
                          ends[s], index[s]);
        if (!(error < best.error)) return;
    }
    best.error = error;
    best.mode = number;
    best.partition = partition;
    best.rotation = best.selector = 0;
    for (unsigned s = 0; s < 2; ++s) store_ends(ends[s], 2 * s, best);
    for (unsigned i = 0; i < kTexels; ++i) best.index.set(i, index[subset_of(2, partition, i)].get(i));
}

// Modes 4 and 5: `kColour` channels share indices, channel `apart` has its own. Without alpha, which then is constant,
// two share and one is apart: it is stored in the place of alpha, and alpha in its.
template <unsigned kColour>
void try_separate(const Block& block, unsigned number, unsigned apart, unsigned selector, Encoded& best) {
    const Bc7Mode& mode = kBc7ModeTable[number];
    const unsigned colour_bits = selector == 0 ? mode.index_bits : mode.second_index_bits;
    const unsigned apart_bits = selector == 0 ? mode.second_index_bits : mode.index_bits;
    Lanes x[kColour];
    float mean[kColour];
    unsigned slot[kColour], at = 0;  // where each shared channel is stored
    for (unsigned c = 0; c < kColour + 1; ++c) {
        if (c == apart) continue;
        x[at] = block.x[c];
        mean[at] = block.mean[c];
        slot[at++] = c == 3 ? apart : c;
    }
    Subset<kColour> shared;
    make_subset(x, block.weight, shared);
    RoundedEnds<kColour> colour;
    Lanes index, second;
    float error = fit_line(shared, mean, Grid{mode.colour_bits, false}, Bc7LowBit::none,
                           static_cast<float>((1u << colour_bits) - 1), 0, block.effort, colour, index);
    if (!(error < best.error)) return;
    Subset<1> single;
    make_subset(&block.x[apart], block.weight, single);
    RoundedEnds<1> ends;
    error += fit_line(single, &block.mean[apart], Grid{mode.alpha_bits, false}, Bc7LowBit::none,
                      static_cast<float>((1u << apart_bits) - 1), 0, block.effort, ends, second);
    if (!(error < best.error)) return;
    best.error = error;
    best.mode = number;
    best.partition = 0;
    best.rotation = apart == 3 ? 0 : apart + 1;
    best.selector = selector;
    for (unsigned c = 0; c < 3; ++c) best.ends[0][c] = best.ends[1][c] = (1u << mode.colour_bits) - 1;  // alpha's 255
    for (unsigned c = 0; c < kColour; ++c) {
        best.ends[0][slot[c]] = colour.a[c];
        best.ends[1][slot[c]] = colour.b[c];
    }
    best.ends[0][3] = ends.a[0];
    best.ends[1][3] = ends.b[0];
    best.index = index;
    best.second = second;
}

void write_indices(BlockWriter& writer, const Lanes& index, unsigned subsets, unsigned partition, unsigned bits) {
    for (unsigned i = 0; i < kTexels; ++i)
        writer.write(static_cast<std::uint32_t>(index.get(i)), bits - (is_anchor(subsets, partition, i) ? 1 : 0));
}

BcBlock16 pack(const Encoded& encoded) {
    const Bc7Mode& mode = kBc7ModeTable[encoded.mode];
    BlockWriter writer;
    writer.write(1u << encoded.mode, encoded.mode + 1);
    writer.write(encoded.partition, mode.partition_bits);
    writer.write(encoded.rotation, mode.rotation_bits);
    writer.write(encoded.selector, mode.selector_bits);
    const unsigned ends = 2u * mode.subsets;
    for (unsigned c = 0; c < 4; ++c)
        for (unsigned e = 0; e < ends; ++e)
            writer.write(c < 3 || mode.alpha_bits > 0 ? encoded.ends[e][c] : 0,
                         c < 3 ? mode.colour_bits : mode.alpha_bits);
    for (unsigned e = 0; e < ends; ++e)
        if (mode.low_bit == Bc7LowBit::each || (mode.low_bit == Bc7LowBit::shared && e % 2 == 0))
            writer.write(encoded.low[e], 1);
    const bool own = mode.second_index_bits > 0;
    write_indices(writer, own && encoded.selector != 0 ? encoded.second : encoded.index, mode.subsets,
                  encoded.partition, mode.index_bits);
    if (own)
        write_indices(writer, encoded.selector != 0 ? encoded.index : encoded.second, 1, 0, mode.second_index_bits);
    return writer.block16();
}

template <unsigned kChannels>
constexpr auto two_subset_modes() {
    if constexpr (kChannels == 3)
        return std::array<unsigned, 2>{1, 3};
    else
        return std::array<unsigned, 1>{7};
}

// kChannels is 3 (no alpha) or 4.
template <unsigned kChannels>
void search(const Block& block, Encoded& best) {
    const Effort& effort = block.effort;
    // Mode 5, then mode 4 with its two ways to share the bits of indices.
    for (unsigned way = 0; way < effort.separate_ways; ++way)
        for (unsigned apart = 0; apart < kChannels; ++apart)
            try_separate<kChannels - 1>(block, way == 0 ? 5 : 4, apart, way == 2 ? 1 : 0, best);
    alignas(64) float score[kPartitions];
    if (effort.few_partitions) {
        std::fill(score, score + kPartitions, 3e38f);
        score_two_subsets<kChannels, kPartitions / 2>(block.x, block.weight, 7.0f, score);
    } else {
        score_two_subsets<kChannels, kPartitions>(block.x, block.weight, 7.0f, score);
    }
    unsigned partitions[kPartitions];
    constexpr auto modes = two_subset_modes<kChannels>();
    best_partitions<kPartitions>(score, effort.partitions, partitions);
    for (unsigned k = 0; k < effort.partitions; ++k) {
        if (!(score[partitions[k]] < best.error)) break;
        for (const unsigned mode : modes) {
            try_two_subsets<kChannels>(block, mode, partitions[k], best);
            if (effort.few_partitions) break;
        }
    }
}

template <unsigned kChannels>
BcBlock16 encode_block(const BlockTexels<kChannels>& texels, const Bc7Options& options) {
    Block block;
    block.effort = effort_of(options.quality);
    if (!load(texels, block)) return {1 << 5};  // mode 5, all zero
    Encoded best;
    try_one_subset<kChannels>(block, best);
    if (!options.only_mode_6 && best.error > block.effort.good_enough) search<kChannels>(block, best);
    return pack(best);
}

template <unsigned kChannels>
Result<std::vector<std::uint8_t>> encode_with(const Image& image, std::span<const float> weights,
                                              const Bc7Options& options, Context& context) {
    return encode_blocks<16>(image, weights, context, [&](std::uint32_t x, std::uint32_t y) {
        BlockTexels<kChannels> texels;
        load_block(image, weights, x, y, texels);
        return encode_block(texels, options);
    });
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_bc7(const Image& image, std::span<const float> weights,
                                             const Bc7Options& options, Context& context) {
    if (image.channels < 4) return encode_with<3>(image, weights, options, context);
    return encode_with<4>(image, weights, options, context);
}

}  // namespace lumel
