// Which division of a block into two subsets its texels fit best: for every division the squared distances of both
// subsets from their principal lines, and what their indices cannot resolve along these.
#pragma once

#include "bc/subset_fit.h"

namespace lumel::bc {

// 1 where texel i is in subset 1 of division p.
struct TwoSubsetMasks {
    alignas(64) float of[kTexels][kTwoSubsetPartitions];
};

constexpr TwoSubsetMasks make_two_subset_masks() {
    TwoSubsetMasks out{};
    for (unsigned i = 0; i < kTexels; ++i)
        for (unsigned p = 0; p < kTwoSubsetPartitions; ++p)
            out.of[i][p] = (kTwoSubsets[p] >> i & 1u) != 0 ? 1.0f : 0.0f;
    return out;
}

inline constexpr TwoSubsetMasks kTwoSubsetMasks = make_two_subset_masks();

// The weights of the texels of one subset, 0 for the others.
LUMEL_BC_INLINE Lanes weights_of(const Lanes& weight, unsigned partition, unsigned subset) {
    Lanes out = {};
    for (unsigned i = 0; i < kTexels; ++i)
        out.set(i, ((kTwoSubsets[partition] >> i) & 1u) == subset ? weight.get(i) : 0.0f);
    return out;
}

template <unsigned kChannels>
inline constexpr unsigned kMoments = 1 + kChannels + kChannels*(kChannels + 1) / 2;

// Of the sums over texels of w, w x and w x y: what the line through the subset leaves, plus `along` times the variance
// along it.
template <unsigned kChannels>
LUMEL_BC_INLINE Quad line_residual(const Quad* moment, float along) {
    const Quad inverse = moment[0] > 1e-12f ? 1.0f / moment[0] : Quad{};
    Quad m[kChannels][kChannels], trace = Quad{} + 1e-20f;
    unsigned at = 1 + kChannels;
    for (unsigned c = 0; c < kChannels; ++c)
        for (unsigned d = c; d < kChannels; ++d, ++at)
            m[c][d] = m[d][c] = moment[at] - moment[1 + c] * moment[1 + d] * inverse;
    for (unsigned c = 0; c < kChannels; ++c) trace += m[c][c];
    const Quad scale = 1.0f / trace;
    // The channel that varies most starts the power iteration.
    Quad axis[kChannels], widest = m[0][0];
    for (unsigned c = 0; c < kChannels; ++c) axis[c] = m[0][c] * scale;
    for (unsigned c = 1; c < kChannels; ++c) {
        const QuadInt wider = m[c][c] > widest;
        widest = wider ? m[c][c] : widest;
        for (unsigned d = 0; d < kChannels; ++d) axis[d] = wider ? m[c][d] * scale : axis[d];
    }
    Quad up = {}, down = {};
    for (unsigned round = 0; round < 2; ++round) {
        Quad next[kChannels];
        up = Quad{};
        down = Quad{} + 1e-30f;
        for (unsigned c = 0; c < kChannels; ++c) {
            next[c] = Quad{};
            for (unsigned d = 0; d < kChannels; ++d) next[c] += m[c][d] * scale * axis[d];
            up += next[c] * axis[c];
            down += axis[c] * axis[c];
        }
        for (unsigned c = 0; c < kChannels; ++c) axis[c] = next[c];
    }
    const Quad variance = trace * (up / down);
    return trace - variance * (1.0f - along);
}

// score[p] for the first kCount divisions; smaller is better. `steps`: indices have so many steps.
template <unsigned kChannels, unsigned kCount>
LUMEL_BC_INLINE void score_two_subsets(const Lanes* x, const Lanes& weight, float steps, float* score) {
    constexpr unsigned kAll = kMoments<kChannels>;
    Lanes value[kAll];
    value[0] = weight;
    unsigned at = 1 + kChannels;
    for (unsigned c = 0; c < kChannels; ++c)
        for (unsigned i = 0; i < kQuads; ++i) value[1 + c].q[i] = weight.q[i] * x[c].q[i];
    for (unsigned c = 0; c < kChannels; ++c)
        for (unsigned d = c; d < kChannels; ++d, ++at)
            for (unsigned i = 0; i < kQuads; ++i) value[at].q[i] = value[1 + c].q[i] * x[d].q[i];

    constexpr unsigned kStrip = 16;  // divisions at a time
    const float along = 1.0f / (steps * steps);
    float total[kAll];
    for (unsigned m = 0; m < kAll; ++m) total[m] = sum(value[m]);
    for (unsigned first = 0; first < kCount; first += kStrip) {
        Quad part[kAll][kStrip / 4];
        for (unsigned m = 0; m < kAll; ++m) {
            Quad s[kStrip / 4] = {};
            for (unsigned i = 1; i < kTexels; ++i)  // texel 0 is in subset 0 always
                for (unsigned l = 0; l < kStrip / 4; ++l)
                    s[l] += value[m].get(i) * load_quad(&kTwoSubsetMasks.of[i][first + 4 * l]);
            for (unsigned l = 0; l < kStrip / 4; ++l) part[m][l] = s[l];
        }
        for (unsigned l = 0; l < kStrip / 4; ++l) {
            Quad one[kAll], other[kAll];
            for (unsigned m = 0; m < kAll; ++m) {
                one[m] = part[m][l];
                other[m] = total[m] - part[m][l];
            }
            const Quad both = line_residual<kChannels>(one, along) + line_residual<kChannels>(other, along);
            std::memcpy(&score[first + 4 * l], &both, sizeof(both));
        }
    }
}

// The divisions of the smallest scores, best first; of equal ones the one with the smaller number.
template <unsigned kCount>
LUMEL_BC_INLINE void best_partitions(const float* score, unsigned wanted, unsigned* out) {
    bool taken[kCount] = {};
    for (unsigned k = 0; k < wanted; ++k) {
        unsigned best = kCount;
        for (unsigned p = 0; p < kCount; ++p)
            if (!taken[p] && (best == kCount || score[p] < score[best])) best = p;
        taken[best] = true;
        out[k] = best;
    }
}

}  // namespace lumel::bc
