// How far a bake is from a reference of two independent halves A and B.
//   relMSE of I         mean over texels and channels of (x - A)(x - B) / (r^2 + 0.01 mean(r)^2), r = (A + B)/2: the
//                       reference's own noise is not in it (and it may fall a little below zero)
//   relMSE of (L0, L1)  the same of the vector of four coefficients: products and squares are dot products, and the
//                       mean is that of the vector's length; a single coefficient has no scale of its own where it
//                       passes through zero
//   coverage            share of texels and channels whose 95 % interval, 1.96 deviations by the stated variance
//                       (and the reference's, by its halves), contains r; lowest and highest decile by brightness
//   block bias          of the mean light of 16 x 16 texels, relative: (x - r) / (r + 0.01 mean(r)), all channels
//                       together; 95th percentile over blocks of its size. Noise that has not averaged out over a block
//                       is in it: `block_noise` is what noise alone would give, by the texels' own variance (of the
//                       peer an upper estimate, for it takes samples as independent)
// Based on: Rousselle et al. 2011 (relMSE).
#pragma once

#include "bench_scene.h"
#include "reference.h"

namespace lumel::bench {

struct Score {
    std::size_t texels = 0;
    double relmse = 0.0;
    double relmse_without_worst = 0.0;  // without the worst 0.1 % of texels
    double relmse_sh = 0.0;
    double bias = 0.0;  // of the mean of all texels, signed, relative
    double coverage = 0.0, lowest_coverage = 0.0, highest_coverage = 0.0;
    double block_bias = 0.0, block_noise = 0.0;
    double reference_relmse = 0.0;  // of r itself: mean of ((A - B)/2)^2 / (...)
};

// Over the texels that are valid in all three. `scene`: for the blocks. The first three spans are by texel of the
// range, `sums` by texel of the page.
Score score(const RadianceSums& sums, const ReferenceHalf& a, const ReferenceHalf& b, const TexelBuffer& texels,
            TexelRange range);

// Size that 95 of 100 draws stay below, each from a normal distribution about zero with the deviation of one of the
// entries, all equally likely.
double joint_p95(std::span<const double> deviations);

}  // namespace lumel::bench
