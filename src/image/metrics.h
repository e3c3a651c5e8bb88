// How far an image is from a reference, over the texels of a mask and all channels. The definitions:
//   nRMSE   = sqrt(mean((x-r)^2)) / mean(r)
//   relMSE  = mean((x-r)^2 / (r^2 + 0.01 mean(r)^2))
//   relMSE without the worst: of the 99.9 % of texels with the smallest terms
//   bias    = mean(x) - mean(r); block bias: the same of each 16x16-texel block
//   logPSNR = -10 log10 mean((y(x)-y(r))^2), y(v) = ln(1+v) / ln(1+max r)
// Based on: Rousselle et al. 2011, "Adaptive Sampling and Reconstruction using Greedy Error Minimization" (relMSE). We
// scale its constant by the mean, so that the figure does not depend on the unit of light.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "image/image.h"

namespace lumel {

// A texel counts where mask[y * width + x] != 0; an empty mask counts all.
using Mask = std::vector<std::uint8_t>;

// 1 where the first channel is at least one half: mask images store 255 (or 1.0) for valid.
Mask mask_from_image(const Image& image);

struct WorstTexel {
    std::uint32_t x = 0, y = 0;
    double relative_squared_error = 0.0;        // mean over channels of the terms of relMSE
    std::array<float, 4> value{}, reference{};  // first channels
};

struct ImageMetrics {
    std::uint64_t texels = 0;      // compared
    std::uint64_t non_finite = 0;  // texels with a NaN or infinity in either image; nrmse and relmse are infinite then
    double mean = 0.0, reference_mean = 0.0;
    double nrmse = 0.0, relmse = 0.0;
    double relmse_without_worst = 0.0;
    double bias = 0.0;           // signed, in the unit of the images
    double relative_bias = 0.0;  // bias / mean(r)
    std::vector<double> channel_bias;
    double block_bias_p95 = 0.0;         // 95th percentile over blocks of |block bias| / mean(r)
    double median_relative_error = 0.0;  // over texels: sum |x-r| / (sum |r| + 0.01 channels mean(r))
    double log_psnr = 0.0;               // dB; infinite for equal images
    std::vector<WorstTexel> worst;       // descending; ties by row, then column
};

// Precondition: equal sizes and channel counts; mask empty or of width * height. With no texel to compare all figures
// are 0 and texels = 0: the caller decides what that means.
ImageMetrics compare_images(const Image& image, const Image& reference, std::span<const std::uint8_t> mask = {},
                            std::size_t worst_count = 8);

// relMSE against two independent halves of a reference: mean((x-a)(x-b) / (r^2 + 0.01 mean(r)^2)), r = (a+b)/2. The
// references' own noise does not bias it; it may be slightly negative.
double cross_relmse(const Image& image, const Image& a, const Image& b, std::span<const std::uint8_t> mask = {});

// Mean without the largest thousandth of the errors (rounded up to whole ones), which few rare texels can own; 0 for
// none.
double mean_without_worst(std::vector<double> errors);

// Value below which `fraction` (0..1) of the values lie, linear between neighbours; 0 for none. Reorders.
double percentile(std::span<double> values, double fraction);

}  // namespace lumel
