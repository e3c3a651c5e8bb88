// What the encoders of BC6H, BC7 and BC1 share: the best two end points for the texels of a subset, by weighted least
// squares. Texels are 16 lanes a channel, centred on the block's mean, so that sums of squares lose nothing. Lanes are
// four vectors of four, which every 64-bit machine has, and sums have one fixed order: the same bits everywhere.
// (Compilers vectorise little of this by themselves; vectors of eight, on a machine without, fall apart where they are
// compared.)
#pragma once

#include <cstdint>
#include <cstring>

#include "bc/partitions.h"

// Small functions whose loops must unroll into their caller.
#define LUMEL_BC_INLINE [[gnu::always_inline]] inline

namespace lumel::bc {

inline constexpr unsigned kTexels = 16, kQuads = 4;

using Quad [[gnu::vector_size(16)]] = float;
using QuadInt [[gnu::vector_size(16)]] = std::int32_t;

struct Lanes {
    Quad q[kQuads];

    [[nodiscard]] LUMEL_BC_INLINE float get(unsigned i) const { return q[i / 4][i % 4]; }
    LUMEL_BC_INLINE void set(unsigned i, float value) { q[i / 4][i % 4] = value; }
    LUMEL_BC_INLINE void fill(float value) {
        for (Quad& quad : q) quad = Quad{value, value, value, value};
    }
    LUMEL_BC_INLINE void load(const float* values) { std::memcpy(q, values, sizeof(q)); }
};

LUMEL_BC_INLINE Quad load_quad(const float* values) {
    Quad out;
    std::memcpy(&out, values, sizeof(out));
    return out;
}

LUMEL_BC_INLINE Quad smaller(Quad a, Quad b) { return a < b ? a : b; }

LUMEL_BC_INLINE float sum(const Lanes& x) {
    const Quad s = (x.q[0] + x.q[1]) + (x.q[2] + x.q[3]);
    return (s[0] + s[2]) + (s[1] + s[3]);
}

LUMEL_BC_INLINE float smallest(const Lanes& x) {
    const Quad s = smaller(smaller(x.q[0], x.q[1]), smaller(x.q[2], x.q[3]));
    const float p = s[0] < s[2] ? s[0] : s[2], q = s[1] < s[3] ? s[1] : s[3];
    return p < q ? p : q;
}

LUMEL_BC_INLINE float dot(const Lanes& x, const Lanes& y) {
    const Quad s = (x.q[0] * y.q[0] + x.q[1] * y.q[1]) + (x.q[2] * y.q[2] + x.q[3] * y.q[3]);
    return (s[0] + s[2]) + (s[1] + s[3]);
}

// Nearest whole number of 0 <= x < 2^22: the sum has no bits left for a fraction.
LUMEL_BC_INLINE Quad rounded(Quad x) { return (x + 12582912.0f) - 12582912.0f; }

// How a format's palette divides the line between its end points: BC6H and BC7 in whole 64ths, BC1 and BC4 exactly.
enum class Palette : std::uint8_t { sixty_fourths, exact };

// Position 0..1 between the end points of a whole index of `steps` + 1.
template <Palette kPalette = Palette::sixty_fourths>
LUMEL_BC_INLINE Quad palette_position(Quad index, float steps) {
    if constexpr (kPalette == Palette::exact) return index * (1.0f / steps);
    return rounded(index * (64.0f / steps)) * (1.0f / 64.0f);
}

template <unsigned kChannels>
struct EndPair {
    float a[kChannels], b[kChannels];
};

// Texels and weights (0 outside the subset; those of a block add up to 1, so that no square of them is beyond float)
// and what is the same for all end points.
template <unsigned kChannels>
struct Subset {
    const Lanes* x = nullptr;  // one for each channel
    Lanes weight;
    float total = 0.0f;        // of the weights
    float first[kChannels]{};  // sum of w x
    float second = 0.0f;       // sum over channels of w x^2
};

template <unsigned kChannels>
LUMEL_BC_INLINE void make_subset(const Lanes* x, const Lanes& weight, Subset<kChannels>& out) {
    out.x = x;
    out.weight = weight;
    out.total = sum(weight);
    out.second = 0.0f;
    for (unsigned c = 0; c < kChannels; ++c) {
        Lanes p, q;
        for (unsigned i = 0; i < kQuads; ++i) {
            p.q[i] = weight.q[i] * x[c].q[i];
            q.q[i] = p.q[i] * x[c].q[i];
        }
        out.first[c] = sum(p);
        out.second += sum(q);
    }
}

// Direction in which the texels spread most: power iteration on their covariance, from the channel that varies most.
// Not normalised; 0 where nothing varies.
template <unsigned kChannels>
LUMEL_BC_INLINE void principal_axis(const Subset<kChannels>& s, const float* mean, float* axis) {
    float m[kChannels][kChannels];
    float trace = 0.0f;
    unsigned widest = 0;
    for (unsigned c = 0; c < kChannels; ++c) {
        Lanes p;
        for (unsigned i = 0; i < kQuads; ++i) p.q[i] = s.weight.q[i] * (s.x[c].q[i] - mean[c]);
        for (unsigned d = c; d < kChannels; ++d) m[c][d] = m[d][c] = dot(p, s.x[d]) - mean[d] * sum(p);
        trace += m[c][c];
        if (m[c][c] > m[widest][widest]) widest = c;
    }
    const float scale = trace > 0.0f ? 1.0f / trace : 0.0f;
    for (unsigned c = 0; c < kChannels; ++c) axis[c] = m[widest][c] * scale;
    for (unsigned round = 0; round < 4; ++round) {
        float next[kChannels];
        for (unsigned c = 0; c < kChannels; ++c) {
            next[c] = 0.0f;
            for (unsigned d = 0; d < kChannels; ++d) next[c] += m[c][d] * scale * axis[d];
        }
        for (unsigned c = 0; c < kChannels; ++c) axis[c] = next[c];
    }
}

// The ends of the texels' projection on their principal axis.
template <unsigned kChannels>
LUMEL_BC_INLINE void principal_ends(const Subset<kChannels>& s, EndPair<kChannels>& out) {
    float mean[kChannels], axis[kChannels];
    for (unsigned c = 0; c < kChannels; ++c) mean[c] = s.total > 0.0f ? s.first[c] / s.total : 0.0f;
    principal_axis(s, mean, axis);
    float length2 = 0.0f;
    for (unsigned c = 0; c < kChannels; ++c) length2 += axis[c] * axis[c];
    const Quad far = {3e38f, 3e38f, 3e38f, 3e38f};
    Lanes low, high;
    for (unsigned i = 0; i < kQuads; ++i) {
        Quad t = {};
        for (unsigned c = 0; c < kChannels; ++c) t += axis[c] * (s.x[c].q[i] - mean[c]);
        low.q[i] = s.weight.q[i] > 0.0f ? t : far;
        high.q[i] = s.weight.q[i] > 0.0f ? -t : far;
    }
    const bool flat = !(length2 > 1e-30f);
    const float from = flat ? 0.0f : smallest(low) / length2, to = flat ? 0.0f : -smallest(high) / length2;
    for (unsigned c = 0; c < kChannels; ++c) {
        out.a[c] = mean[c] + axis[c] * from;
        out.b[c] = mean[c] + axis[c] * to;
    }
}

// Indices of the palette's nearest entries along the line, at most limit[i].
template <unsigned kChannels>
LUMEL_BC_INLINE void nearest_indices(const Lanes* x, const EndPair<kChannels>& ends, float steps, const Lanes& limit,
                                     Lanes& index) {
    float d[kChannels], length2 = 0.0f;
    for (unsigned c = 0; c < kChannels; ++c) {
        d[c] = ends.b[c] - ends.a[c];
        length2 += d[c] * d[c];
    }
    const float scale = length2 > 0.0f ? steps / length2 : 0.0f;
    float offset = 0.0f;
    for (unsigned c = 0; c < kChannels; ++c) {
        d[c] *= scale;
        offset += d[c] * ends.a[c];
    }
    for (unsigned i = 0; i < kQuads; ++i) {
        Quad t = Quad{} - offset;
        for (unsigned c = 0; c < kChannels; ++c) t += d[c] * x[c].q[i];
        t = t > 0.0f ? t : Quad{};
        index.q[i] = rounded(smaller(t, limit.q[i]));
    }
}

// The error of a subset as a function of its end points, its indices given: for each channel
// alpha a^2 + 2 beta a b + gamma b^2 - 2 (left a + right b) + sum of w x^2.
template <unsigned kChannels>
struct Quadratic {
    float alpha, beta, gamma;
    float left[kChannels], right[kChannels];
};

template <Palette kPalette = Palette::sixty_fourths, unsigned kChannels>
LUMEL_BC_INLINE void make_quadratic(const Subset<kChannels>& s, const Lanes& index, float steps,
                                    Quadratic<kChannels>& out) {
    Lanes wt, wtt;
    for (unsigned i = 0; i < kQuads; ++i) {
        const Quad t = palette_position<kPalette>(index.q[i], steps);
        wt.q[i] = s.weight.q[i] * t;
        wtt.q[i] = wt.q[i] * t;
    }
    const float s1 = sum(wt), s2 = sum(wtt);
    out.alpha = s.total - 2.0f * s1 + s2;
    out.beta = s1 - s2;
    out.gamma = s2;
    for (unsigned c = 0; c < kChannels; ++c) {
        out.right[c] = dot(wt, s.x[c]);
        out.left[c] = s.first[c] - out.right[c];
    }
}

template <unsigned kChannels>
LUMEL_BC_INLINE float channel_error(const Quadratic<kChannels>& q, unsigned c, float a, float b) {
    return a * (q.alpha * a + 2.0f * (q.beta * b - q.left[c])) + b * (q.gamma * b - 2.0f * q.right[c]);
}

template <unsigned kChannels>
LUMEL_BC_INLINE float error_of(const Subset<kChannels>& s, const Quadratic<kChannels>& q,
                               const EndPair<kChannels>& ends) {
    float error = s.second;
    for (unsigned c = 0; c < kChannels; ++c) error += channel_error(q, c, ends.a[c], ends.b[c]);
    return error > 0.0f ? error : 0.0f;
}

// The best end points for these indices; the mean, twice, where all texels have the same index.
template <unsigned kChannels>
LUMEL_BC_INLINE void solve(const Subset<kChannels>& s, const Quadratic<kChannels>& q, EndPair<kChannels>& out) {
    const float determinant = q.alpha * q.gamma - q.beta * q.beta;
    if (!(determinant > 1e-6f * s.total * s.total)) {
        for (unsigned c = 0; c < kChannels; ++c) out.a[c] = out.b[c] = s.total > 0.0f ? s.first[c] / s.total : 0.0f;
        return;
    }
    const float scale = 1.0f / determinant;
    for (unsigned c = 0; c < kChannels; ++c) {
        out.a[c] = (q.gamma * q.left[c] - q.beta * q.right[c]) * scale;
        out.b[c] = (q.alpha * q.right[c] - q.beta * q.left[c]) * scale;
    }
}

// End points before they are rounded: the principal ends, then so many rounds of indices and least squares.
template <Palette kPalette = Palette::sixty_fourths, unsigned kChannels>
LUMEL_BC_INLINE void fit_ends(const Subset<kChannels>& s, float steps, unsigned rounds, EndPair<kChannels>& ends) {
    Lanes limit, index;
    limit.fill(steps);
    principal_ends(s, ends);
    for (unsigned round = 0; round < rounds; ++round) {
        nearest_indices(s.x, ends, steps, limit, index);
        Quadratic<kChannels> q;
        make_quadratic<kPalette>(s, index, steps, q);
        solve(s, q, ends);
    }
}

// Swaps the end points where the anchor is nearer to b: its index must be in the lower half.
template <unsigned kChannels>
LUMEL_BC_INLINE void orient(const Lanes* x, unsigned anchor, EndPair<kChannels>& ends) {
    float side = 0.0f;
    for (unsigned c = 0; c < kChannels; ++c)
        side += (ends.b[c] - ends.a[c]) * (2.0f * x[c].get(anchor) - ends.a[c] - ends.b[c]);
    if (!(side > 0.0f)) return;
    for (unsigned c = 0; c < kChannels; ++c) {
        const float a = ends.a[c];
        ends.a[c] = ends.b[c];
        ends.b[c] = a;
    }
}

}  // namespace lumel::bc
