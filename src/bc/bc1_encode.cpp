// The encoder of BC1: weighted least squares for palettes of four and of three colours, both end points of a channel
// rounded together; blocks of one colour by a search of their own. The transparent code is not used.
// Based on: Khronos Data Format Specification 1.3, section "BC1"; Brown 2006, "DXT Compression Techniques" (end points
// by least squares).
#include <algorithm>

#include "bc/bc1.h"
#include "bc/block_image.h"
#include "bc/subset_fit.h"

namespace lumel {
namespace {

using namespace bc;
using Pair = EndPair<3>;

struct Effort {
    unsigned rounds, polish;
    bool three_colours;
};

constexpr Effort effort_of(BcQuality quality) {
    switch (quality) {
        case BcQuality::fast: return {1, 1, false};
        case BcQuality::normal: return {2, 2, false};
        default: return {4, 4, true};
    }
}

struct Block {
    Lanes x[3];  // codes 0..255, less the mean
    float mean[3];
    Subset<3> all;
};

struct Encoded {
    float error = 3e38f;
    std::int32_t a[3] = {}, b[3] = {};
    unsigned steps = 3;
    Lanes index = {};  // along the line from a to b
};

constexpr std::int32_t kTop[3] = {31, 63, 31};

LUMEL_BC_INLINE float code_of(std::int32_t q, unsigned c) {
    return static_cast<float>(q) * (255.0f / static_cast<float>(kTop[c]));
}

LUMEL_BC_INLINE std::int32_t below(float code, unsigned c) {
    const float top = static_cast<float>(kTop[c]), q = code * (top / 255.0f);
    return static_cast<std::int32_t>(q > 0.0f ? (q < top ? q : top) : 0.0f);
}

LUMEL_BC_INLINE bool load(const BlockTexels<3>& texels, Block& block) {
    Lanes weight;
    weight.load(texels.weight.data());
    const float total = sum(weight);
    if (!(total > 0.0f)) return false;
    for (Quad& w : weight.q) w /= total;
    for (unsigned c = 0; c < 3; ++c) {
        const std::array<float, 16> codes = to_codes(texels.value[c]);
        block.x[c].load(codes.data());
        block.mean[c] = dot(weight, block.x[c]);
        for (unsigned i = 0; i < kQuads; ++i)
            block.x[c].q[i] = weight.q[i] > 0.0f ? block.x[c].q[i] - block.mean[c] : Quad{};
    }
    make_subset(block.x, weight, block.all);
    return true;
}

// Rounds the end points, chooses indices for them, keeps what is better; `ends` become those of least squares.
void round_and_keep(const Block& block, unsigned steps, Pair& ends, Encoded& best) {
    const auto n = static_cast<float>(steps);
    Lanes limit, index;
    limit.fill(n);
    Quadratic<3> q;
    nearest_indices(block.x, ends, n, limit, index);
    make_quadratic<Palette::exact>(block.all, index, n, q);
    Encoded found;
    Pair rounded_ends = {};
    for (unsigned c = 0; c < 3; ++c) {
        const std::int32_t a0 = below(ends.a[c] + block.mean[c], c), b0 = below(ends.b[c] + block.mean[c], c);
        float smallest_error = 3e38f;
        for (std::int32_t k = 0; k < 4; ++k) {
            const std::int32_t a = std::min(a0 + k / 2, kTop[c]), b = std::min(b0 + k % 2, kTop[c]);
            const float av = code_of(a, c) - block.mean[c], bv = code_of(b, c) - block.mean[c];
            const float error = channel_error(q, c, av, bv);
            if (!(error < smallest_error)) continue;
            smallest_error = error;
            found.a[c] = a;
            found.b[c] = b;
            rounded_ends.a[c] = av;
            rounded_ends.b[c] = bv;
        }
    }
    nearest_indices(block.x, rounded_ends, n, limit, index);
    make_quadratic<Palette::exact>(block.all, index, n, q);
    found.error = error_of(block.all, q, rounded_ends);
    found.steps = steps;
    found.index = index;
    if (found.error < best.error) best = found;
    solve(block.all, q, ends);
}

void try_line(const Block& block, unsigned steps, const Effort& effort, Encoded& best) {
    Pair ends;
    fit_ends<Palette::exact>(block.all, static_cast<float>(steps), effort.rounds, ends);
    for (unsigned round = 0; round < effort.polish; ++round) round_and_keep(block, steps, ends, best);
}

// One colour, the mean, in between end points: a third of the way there are more colours than at the ends.
void try_one_colour(const Block& block, Encoded& best) {
    Encoded found;
    found.error = block.all.second;
    for (unsigned c = 0; c < 3; ++c) {
        float least = 3e38f;
        for (std::int32_t a = 0; a <= kTop[c]; ++a) {
            const float wanted = 3.0f * block.mean[c] - 2.0f * code_of(a, c);
            const std::int32_t b = below(wanted + 127.5f / static_cast<float>(kTop[c]), c);
            const float distance = (2.0f * code_of(a, c) + code_of(b, c)) / 3.0f - block.mean[c];
            if (!(distance * distance < least)) continue;
            least = distance * distance;
            found.a[c] = a;
            found.b[c] = b;
        }
        found.error += least;
    }
    found.index.fill(1.0f);
    if (found.error < best.error) best = found;
}

std::uint32_t packed(const std::int32_t* q) {
    return static_cast<std::uint32_t>(q[0]) << 11 | static_cast<std::uint32_t>(q[1]) << 5 |
           static_cast<std::uint32_t>(q[2]);
}

// Steps along the line as the format numbers them: the ends first. Which end comes first says how many steps there are.
BcBlock8 pack(const Encoded& encoded) {
    std::uint32_t a = packed(encoded.a), b = packed(encoded.b);
    const bool flip = encoded.steps == 3 ? a < b : a > b;
    if (flip) std::swap(a, b);
    BlockWriter writer;
    writer.write(a, 16);
    writer.write(b, 16);
    for (unsigned i = 0; i < kTexels; ++i) {
        auto k = static_cast<unsigned>(encoded.index.get(i));
        if (flip) k = encoded.steps - k;
        writer.write(a == b || k == 0 ? 0 : k == encoded.steps ? 1 : k + 1, 2);
    }
    return writer.block8();
}

BcBlock8 encode_block(const BlockTexels<3>& texels, BcQuality quality) {
    Block block;
    if (!load(texels, block)) return {};
    const Effort effort = effort_of(quality);
    Encoded best;
    try_line(block, 3, effort, best);
    if (effort.three_colours) try_line(block, 2, effort, best);
    if (quality != BcQuality::fast && block.all.second < best.error) try_one_colour(block, best);
    return pack(best);
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_bc1(const Image& image, std::span<const float> weights,
                                             const Bc1Options& options, Context& context) {
    return encode_blocks<8>(image, weights, context, [&](std::uint32_t x, std::uint32_t y) {
        BlockTexels<3> texels;
        load_block(image, weights, x, y, texels);
        return encode_block(texels, options.quality);
    });
}

}  // namespace lumel
