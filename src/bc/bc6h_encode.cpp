// The encoder of BC6H. It works on half-float codes, which are nearly the logarithm of the value: squared errors are
// squared relative errors; "units" below are those of the format's 16-bit interpolation.
// Based on: Khronos Data Format Specification 1.3, section "BC6H"; Brown 2006, "DXT Compression Techniques" (end points
// by least squares), here with weights and with both end points of a channel rounded together.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/check.h"
#include "bc/bc6h.h"
#include "bc/bc6h_modes.h"
#include "bc/block_image.h"
#include "bc/partition_search.h"
#include "bc/subset_fit.h"

namespace lumel {
namespace {

using namespace bc;
using Pair = EndPair<3>;

constexpr unsigned kMode11 = 10, kPartitions = 32;
constexpr std::int32_t kReach = 4;                                     // steps around an end point that are searched
constexpr float kWidened = 2.0f;                                       // steps
constexpr std::array<unsigned, 4> kOneRegionModes = {13, 12, 11, 10};  // finest first
constexpr std::array<unsigned, 10> kTwoRegionModes = {2, 3, 4, 0, 5, 6, 7, 8, 1, 9};  // finest first

// What each quality spends.
struct Effort {
    unsigned one_region_rounds, partitions, two_region_rounds, polish;
    bool widened;
    float good_enough;  // squared error per texel, in units, below which two regions are not tried
};

constexpr Effort effort_of(BcQuality quality) {
    switch (quality) {
        case BcQuality::fast: return {1, 1, 1, 1, false, 3.0f * 16 * 16};
        case BcQuality::normal: return {2, 2, 1, 2, true, 3.0f * 6 * 6};
        default: return {4, 16, 3, 4, true, 0.0f};
    }
}

struct Block {
    Lanes x[3];  // units, less the mean
    Lanes weight;
    float mean[3];
    bool is_signed;
    Effort effort;
};

using Ends = std::array<std::array<std::int32_t, 3>, 4>;  // two of each region, as stored

struct Encoded {
    float error = 3e38f;
    unsigned mode = kMode11, partition = 0;
    Ends ends = {};  // before differences are taken
    Lanes index = {};
};

// Fractional half-float codes of values >= 0: between two codes they are linear in the value.
LUMEL_BC_INLINE Quad half_code(Quad value) {
    const Quad above = __builtin_convertvector(std::bit_cast<QuadInt>(value) - 0x38000000, Quad) * 0x1p-13f;
    const Quad below = value * 0x1p24f;
    return value < 0x1p-14f ? below : above;
}

// Decoders round down, to whole codes: half a code is added.
LUMEL_BC_INLINE Quad to_units(Quad value, bool is_signed) {
    const Quad size = value < 0.0f ? -value : value;
    const Quad largest = Quad{} + 65504.0f, top = Quad{} + (is_signed ? 32767.0f : 65535.0f);
    const Quad code = half_code(smaller(size, largest)) + 0.5f;
    const Quad scaled = smaller(code * (is_signed ? 32.0f / 31.0f : 64.0f / 31.0f), top);
    const Quad units = size > 0.0f ? scaled : Quad{};
    return value < 0.0f ? (is_signed ? -units : Quad{}) : units;
}

// Returns false for a block without a texel that counts.
LUMEL_BC_INLINE bool load(const BlockTexels<3>& texels, Block& block) {
    block.weight.load(texels.weight.data());
    const float total = sum(block.weight);
    if (!(total > 0.0f)) return false;
    const float scale = 1.0f / total;
    for (Quad& w : block.weight.q) w *= scale;
    for (unsigned c = 0; c < 3; ++c) {
        for (unsigned i = 0; i < kQuads; ++i)
            block.x[c].q[i] = to_units(load_quad(&texels.value[c][4 * i]), block.is_signed);
        block.mean[c] = dot(block.weight, block.x[c]);
        // What does not count lies on the mean, where it cannot spoil sums.
        for (unsigned i = 0; i < kQuads; ++i)
            block.x[c].q[i] = block.weight.q[i] > 0.0f ? block.x[c].q[i] - block.mean[c] : Quad{};
    }
    return true;
}

// Stored numbers of `bits` bits and the units that they mean.
struct Quantizer {
    float step, inverse_step, offset;
    std::int32_t low, high;  // smallest and largest number
    float top;               // what the largest means
    bool is_signed, exact;   // exact: numbers are units

    LUMEL_BC_INLINE Quantizer(unsigned bits, bool with_sign) {
        is_signed = with_sign;
        exact = bits == 16;
        step = static_cast<float>(1u << (16 - bits));
        inverse_step = 1.0f / step;
        offset = exact ? 0.0f : 0.5f;
        high = with_sign ? (1 << (bits - 1)) - 1 : (1 << bits) - 1;
        low = with_sign ? -high : 0;
        top = with_sign ? 32767.0f : 65535.0f;
    }

    [[nodiscard]] LUMEL_BC_INLINE float units(std::int32_t q) const {
        if (q == 0) return 0.0f;
        if (q == high) return top;
        if (q == low) return -top;
        return (static_cast<float>(q) + (q < 0 ? -offset : offset)) * step;
    }

    // The largest number whose units do not exceed u, or a neighbour of it.
    [[nodiscard]] LUMEL_BC_INLINE std::int32_t below(float u) const {
        const float q = u * inverse_step - (u < 0.0f ? -offset : offset);
        const float from = static_cast<float>(low), to = static_cast<float>(high);
        const float inside = q > from ? (q < to ? q : to) : from;  // in floats: q may be beyond integers
        return static_cast<std::int32_t>(std::floor(inside));
    }
};

// Both end points of a channel, rounded together: the best of four.
LUMEL_BC_INLINE void round_channel(const Quadratic<3>& q, const Quantizer& grid, float mean, unsigned c, float a,
                                   float b, std::int32_t* out_a, std::int32_t* out_b) {
    const std::int32_t a0 = grid.below(a + mean), b0 = grid.below(b + mean);
    const std::int32_t as[2] = {a0, std::min(a0 + 1, grid.high)}, bs[2] = {b0, std::min(b0 + 1, grid.high)};
    const float av[2] = {grid.units(as[0]) - mean, grid.units(as[1]) - mean};
    const float bv[2] = {grid.units(bs[0]) - mean, grid.units(bs[1]) - mean};
    float best = 3e38f;
    for (unsigned i = 0; i < 4; ++i) {
        const float error = channel_error(q, c, av[i / 2], bv[i % 2]);
        if (!(error < best)) continue;
        best = error;
        *out_a = as[i / 2];
        *out_b = bs[i % 2];
    }
}

LUMEL_BC_INLINE bool fits(std::int32_t difference, unsigned bits) {
    const std::int32_t limit = (1 << (bits - 1)) - 1;
    return difference <= limit && difference >= -limit;
}

LUMEL_BC_INLINE bool differences_fit(const Bc6hMode& mode, const Ends& ends) {
    if (!mode.transformed) return true;
    for (unsigned e = 1; e < 2u * mode.regions; ++e)
        for (unsigned c = 0; c < 3; ++c)
            if (!fits(ends[e][c] - ends[0][c], mode.other_bits[c])) return false;
    return true;
}

// Whether differences of so many units can fit: spares the rounding of most modes that cannot.
LUMEL_BC_INLINE bool may_fit(const Bc6hMode& mode, const float* widest) {
    if (!mode.transformed) return true;
    const float step = static_cast<float>(1u << (16 - mode.end_bits));
    for (unsigned c = 0; c < 3; ++c)
        if (widest[c] > step * static_cast<float>(1u << (mode.other_bits[c] - 1))) return false;
    return true;
}

LUMEL_BC_INLINE void unrounded(const Block& block, const Quantizer& grid, const std::array<std::int32_t, 3>& a,
                               const std::array<std::int32_t, 3>& b, Pair& out) {
    for (unsigned c = 0; c < 3; ++c) {
        out.a[c] = grid.units(a[c]) - block.mean[c];
        out.b[c] = grid.units(b[c]) - block.mean[c];
    }
}

// The same by a search along the valley that the error is where all texels have nearly the same index: there, far more
// than the four neighbours are as good, and some come much nearer to the wanted values than the grid is fine.
LUMEL_BC_INLINE void round_channel_far(const Quadratic<3>& q, const Quantizer& grid, float mean, unsigned c, float a,
                                       std::int32_t* out_a, std::int32_t* out_b) {
    const std::int32_t first = grid.below(a + mean) - kReach + 1;
    float best = 3e38f;
    for (std::int32_t k = 0; k < 2 * kReach; ++k) {
        const std::int32_t qa = std::clamp(first + k, grid.low, grid.high);
        const float av = grid.units(qa) - mean;
        const float b = q.gamma > 0.0f ? (q.right[c] - q.beta * av) / q.gamma : av;
        const std::int32_t b0 = grid.below(b + mean);
        for (std::int32_t qb = b0; qb <= std::min(b0 + 1, grid.high); ++qb) {
            const float error = channel_error(q, c, av, grid.units(qb) - mean);
            if (!(error < best)) continue;
            best = error;
            *out_a = qa;
            *out_b = qb;
        }
    }
}

// End points moved apart to some steps of the grid, about their middle: their texels get indices near the middle.
LUMEL_BC_INLINE void widen(float step, Pair& ends) {
    float span = 0.0f;
    for (unsigned c = 0; c < 3; ++c) span = std::max(span, std::abs(ends.b[c] - ends.a[c]));
    const float wanted = kWidened * step;
    if (span >= wanted) return;
    for (unsigned c = 0; c < 3; ++c) {
        const float middle = 0.5f * (ends.a[c] + ends.b[c]), half = 0.5f * (ends.b[c] - ends.a[c]);
        const float far = span > 1e-3f ? half * (wanted / span) : 0.5f * wanted;
        ends.a[c] = middle - far;
        ends.b[c] = middle + far;
    }
}

// One or two regions, with the end points found so far for each.
struct Regions {
    unsigned count, partition;
    Subset<3> subset[2];
    Pair ends[2];
    Lanes limit;  // of indices: half of them at anchors
    float steps;
};

// Rounds the end points of all regions in the finest mode that holds them, chooses the indices anew and keeps what is
// better than what there was. The regions' end points become the least-squares ones of these indices.
void round_and_keep(const Block& block, Regions& regions, bool only_mode_11, bool widened, Encoded& best) {
    Lanes index[2];
    Quadratic<3> q[2];
    float widest[3] = {};
    for (unsigned r = 0; r < regions.count; ++r) {
        orient(block.x, anchor_of(regions.count, regions.partition, r), regions.ends[r]);
        nearest_indices(block.x, regions.ends[r], regions.steps, regions.limit, index[r]);
        make_quadratic(regions.subset[r], index[r], regions.steps, q[r]);
        for (unsigned c = 0; c < 3; ++c) {
            const float base = regions.ends[0].a[c];
            const float far = std::max(std::abs(regions.ends[r].a[c] - base), std::abs(regions.ends[r].b[c] - base));
            widest[c] = std::max(widest[c], far);
        }
    }
    const unsigned* modes = regions.count == 2 ? kTwoRegionModes.data() : kOneRegionModes.data();
    const unsigned* const past = modes + (regions.count == 2 ? kTwoRegionModes.size() : kOneRegionModes.size());
    Ends ends = {};
    const Bc6hMode* mode = nullptr;
    if (only_mode_11) modes += kOneRegionModes.size() - 1;
    for (;; ++modes) {
        LUMEL_CHECK(modes != past, regions.count);  // the last mode holds any end points
        mode = &kBc6hModeTable[*modes];
        if (!may_fit(*mode, widest)) continue;
        const Quantizer grid(mode->end_bits, block.is_signed);
        for (unsigned r = 0; r < regions.count; ++r) {
            Pair pair = regions.ends[r];
            if (widened) {
                widen(grid.step, pair);
                nearest_indices(block.x, pair, regions.steps, regions.limit, index[r]);
                make_quadratic(regions.subset[r], index[r], regions.steps, q[r]);
            }
            for (unsigned c = 0; c < 3; ++c) {
                if (widened)
                    round_channel_far(q[r], grid, block.mean[c], c, pair.a[c], &ends[2 * r][c], &ends[2 * r + 1][c]);
                else
                    round_channel(q[r], grid, block.mean[c], c, pair.a[c], pair.b[c], &ends[2 * r][c],
                                  &ends[2 * r + 1][c]);
            }
        }
        if (differences_fit(*mode, ends)) break;
    }
    const Quantizer grid(mode->end_bits, block.is_signed);
    float error = 0.0f;
    for (unsigned r = 0; r < regions.count; ++r) {
        Pair pair;
        unrounded(block, grid, ends[2 * r], ends[2 * r + 1], pair);
        nearest_indices(block.x, pair, regions.steps, regions.limit, index[r]);
        make_quadratic(regions.subset[r], index[r], regions.steps, q[r]);
        error += error_of(regions.subset[r], q[r], pair);
        solve(regions.subset[r], q[r], regions.ends[r]);
    }
    if (!(error < best.error)) return;
    best.error = error;
    best.mode = *modes;
    best.partition = regions.partition;
    best.ends = ends;
    best.index = index[0];
    if (regions.count == 2)
        for (unsigned i = 0; i < kTexels; ++i)
            if (subset_of(2, regions.partition, i) == 1) best.index.set(i, index[1].get(i));
}

void try_one_region(const Block& block, bool only_mode_11, Encoded& best) {
    Regions regions;
    regions.count = 1;
    regions.partition = 0;
    regions.steps = 15.0f;
    regions.limit.fill(15.0f);
    regions.limit.set(0, 7.0f);
    make_subset(block.x, block.weight, regions.subset[0]);
    fit_ends(regions.subset[0], regions.steps, block.effort.one_region_rounds, regions.ends[0]);
    for (unsigned round = 0; round < block.effort.polish; ++round)
        round_and_keep(block, regions, only_mode_11, false, best);
    if (block.effort.widened) round_and_keep(block, regions, only_mode_11, true, best);
}

void try_two_regions(const Block& block, unsigned partition, Encoded& best) {
    Regions regions;
    regions.count = 2;
    regions.partition = partition;
    regions.steps = 7.0f;
    regions.limit.fill(7.0f);
    for (unsigned r = 0; r < 2; ++r) {
        regions.limit.set(anchor_of(2, partition, r), 3.0f);
        const Lanes weight = weights_of(block.weight, partition, r);
        make_subset(block.x, weight, regions.subset[r]);
        fit_ends(regions.subset[r], regions.steps, block.effort.two_region_rounds, regions.ends[r]);
    }
    for (unsigned round = 0; round < block.effort.polish; ++round) round_and_keep(block, regions, false, false, best);
    if (block.effort.widened) round_and_keep(block, regions, false, true, best);
}

LUMEL_BC_INLINE std::uint32_t field_bits(const Bc6hField& field, std::int32_t value) {
    std::uint32_t bits = static_cast<std::uint32_t>(value) >> field.low & ((1u << field.count) - 1);
    if (!field.reversed) return bits;
    std::uint32_t out = 0;
    for (unsigned i = 0; i < field.count; ++i) out |= (bits >> i & 1u) << (field.count - 1 - i);
    return out;
}

BcBlock16 pack(const Encoded& encoded) {
    const Bc6hMode& mode = kBc6hModeTable[encoded.mode];
    BlockWriter writer;
    writer.write(mode.code, mode.code_bits);
    for (unsigned f = 0; f < mode.field_count; ++f) {
        const Bc6hField& field = mode.fields[f];
        const bool difference = mode.transformed && field.end > 0;
        const std::int32_t base = difference ? encoded.ends[0][field.channel] : 0;
        writer.write(field_bits(field, encoded.ends[field.end][field.channel] - base), field.count);
    }
    if (mode.regions == 2) writer.write(encoded.partition, 5);
    for (unsigned i = 0; i < kTexels; ++i)
        writer.write(static_cast<std::uint32_t>(encoded.index.get(i)),
                     mode.index_bits() - (is_anchor(mode.regions, encoded.partition, i) ? 1 : 0));
    return writer.block16();
}

BcBlock16 encode_block(const BlockTexels<3>& texels, const Bc6hOptions& options) {
    Block block;
    block.is_signed = options.is_signed;
    block.effort = effort_of(options.quality);
    if (!load(texels, block)) return {kBc6hModeTable[kMode11].code};
    Encoded best;
    try_one_region(block, options.only_mode_11, best);
    if (!options.only_mode_11 && best.error > block.effort.good_enough) {
        alignas(64) float score[kPartitions];
        score_two_subsets<3, kPartitions>(block.x, block.weight, 7.0f, score);
        unsigned partitions[kPartitions];
        best_partitions<kPartitions>(score, block.effort.partitions, partitions);
        for (unsigned k = 0; k < block.effort.partitions; ++k)
            if (score[partitions[k]] < best.error) try_two_regions(block, partitions[k], best);
    }
    return pack(best);
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_bc6h(const Image& image, std::span<const float> weights,
                                              const Bc6hOptions& options, Context& context) {
    return encode_blocks<16>(image, weights, context, [&](std::uint32_t x, std::uint32_t y) {
        BlockTexels<3> texels;
        load_block(image, weights, x, y, texels);
        return encode_block(texels, options);
    });
}

}  // namespace lumel
