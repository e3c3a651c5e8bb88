#include "image/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/check.h"

namespace lumel {
namespace {

constexpr double kRelativeFloor = 0.01;
constexpr std::uint32_t kBlock = 16;
constexpr double kWorstShare = 0.001;

bool finite_texel(const float* texel, std::uint32_t channels) {
    return std::all_of(texel, texel + channels, [](float v) { return std::isfinite(v); });
}

// Indices of the texels that the mask keeps and that are finite in both images; the others are counted.
std::vector<std::size_t> comparable_texels(const Image& a, const Image& b, std::span<const std::uint8_t> mask,
                                           std::uint64_t& non_finite) {
    std::vector<std::size_t> out;
    const std::size_t count = std::size_t{a.width} * a.height;
    for (std::size_t i = 0; i < count; ++i) {
        if (!mask.empty() && mask[i] == 0) continue;
        const std::size_t at = i * a.channels;
        if (finite_texel(&a.data[at], a.channels) && finite_texel(&b.data[at], b.channels))
            out.push_back(i);
        else
            ++non_finite;
    }
    return out;
}

// Mean over the given texels and all channels of f(index of the value).
template <class F>
double mean_over(const std::vector<std::size_t>& texels, std::uint32_t channels, F&& f) {
    double sum = 0.0;
    for (const std::size_t i : texels)
        for (std::uint32_t c = 0; c < channels; ++c) sum += f(i * channels + c);
    return texels.empty() ? 0.0 : sum / (static_cast<double>(texels.size()) * channels);
}

// Denominator of relMSE. Where reference and mean are zero there is nothing to be relative to.
double relative_square(double reference, double mean) {
    return std::max(reference * reference + kRelativeFloor * mean * mean, std::numeric_limits<double>::min());
}

void check_same_shape(const Image& a, const Image& b, std::span<const std::uint8_t> mask) {
    LUMEL_CHECK(a.width == b.width && a.height == b.height && a.channels == b.channels, a.width, a.height, a.channels,
                b.width, b.height, b.channels);
    LUMEL_CHECK(mask.empty() || mask.size() == std::size_t{a.width} * a.height, mask.size());
}

// Signed error of the mean of every 16x16 block that holds a compared texel.
std::vector<double> block_biases(const Image& image, const Image& reference, const std::vector<std::size_t>& texels) {
    const std::size_t columns = (image.width + kBlock - 1) / kBlock, rows = (image.height + kBlock - 1) / kBlock;
    std::vector<double> sum(columns * rows, 0.0);
    std::vector<std::uint64_t> count(columns * rows, 0);
    for (const std::size_t i : texels) {
        const std::size_t block = (i / image.width / kBlock) * columns + i % image.width / kBlock;
        for (std::size_t k = i * image.channels; k < (i + 1) * image.channels; ++k) {
            sum[block] += static_cast<double>(image.data[k]) - static_cast<double>(reference.data[k]);
            ++count[block];
        }
    }
    std::vector<double> out;
    for (std::size_t b = 0; b < sum.size(); ++b)
        if (count[b] > 0) out.push_back(sum[b] / static_cast<double>(count[b]));
    return out;
}

double block_bias_p95(const Image& image, const Image& reference, const std::vector<std::size_t>& texels,
                      double scale) {
    std::vector<double> biases = block_biases(image, reference, texels);
    for (double& bias : biases) bias = std::fabs(bias) / scale;
    return percentile(biases, 0.95);
}

double median_relative_error(const Image& image, const Image& reference, const std::vector<std::size_t>& texels,
                             double mean) {
    std::vector<double> errors;
    errors.reserve(texels.size());
    const double floor = kRelativeFloor * std::fabs(mean) * image.channels;
    for (const std::size_t i : texels) {
        double error = 0.0, size = 0.0;
        for (std::size_t k = i * image.channels; k < (i + 1) * image.channels; ++k) {
            const double r = static_cast<double>(reference.data[k]);
            error += std::fabs(static_cast<double>(image.data[k]) - r);
            size += std::fabs(r);
        }
        errors.push_back(error == 0.0 ? 0.0 : error / (size + floor));
    }
    return percentile(errors, 0.5);
}

double log_psnr(const Image& image, const Image& reference, const std::vector<std::size_t>& texels) {
    double top = 0.0;
    for (const std::size_t i : texels)
        for (std::uint32_t c = 0; c < image.channels; ++c)
            top = std::max(top, static_cast<double>(reference.data[i * image.channels + c]));
    if (!(top > 0.0)) return 0.0;
    const double scale = 1.0 / std::log1p(top);
    const auto y = [&](float v) { return std::log1p(std::max(0.0, static_cast<double>(v))) * scale; };
    const double mse = mean_over(texels, image.channels, [&](std::size_t k) {
        const double d = y(image.data[k]) - y(reference.data[k]);
        return d * d;
    });
    return mse > 0.0 ? -10.0 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

// The terms of relMSE, means over channels, one per texel.
std::vector<double> relative_squared_errors(const Image& image, const Image& reference,
                                            const std::vector<std::size_t>& texels, double mean) {
    std::vector<double> out;
    out.reserve(texels.size());
    for (const std::size_t i : texels) {
        double error = 0.0;
        for (std::size_t k = i * image.channels; k < (i + 1) * image.channels; ++k) {
            const double r = static_cast<double>(reference.data[k]), d = static_cast<double>(image.data[k]) - r;
            error += d * d / relative_square(r, mean);
        }
        out.push_back(error / image.channels);
    }
    return out;
}

std::vector<WorstTexel> worst_texels(const Image& image, const Image& reference, const std::vector<std::size_t>& texels,
                                     std::span<const double> errors, std::size_t count) {
    struct Ranked {
        double error;
        std::size_t texel;
    };
    std::vector<Ranked> ranked(texels.size());
    for (std::size_t k = 0; k < texels.size(); ++k) ranked[k] = {errors[k], texels[k]};
    count = std::min(count, ranked.size());
    std::partial_sort(
        ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count), ranked.end(),
        [](const Ranked& a, const Ranked& b) { return a.error != b.error ? a.error > b.error : a.texel < b.texel; });
    std::vector<WorstTexel> out(count);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t texel = ranked[k].texel;
        out[k].x = static_cast<std::uint32_t>(texel % image.width);
        out[k].y = static_cast<std::uint32_t>(texel / image.width);
        out[k].relative_squared_error = ranked[k].error;
        for (std::size_t c = 0; c < std::min<std::size_t>(4, image.channels); ++c) {
            out[k].value[c] = image.data[texel * image.channels + c];
            out[k].reference[c] = reference.data[texel * image.channels + c];
        }
    }
    return out;
}

std::vector<double> channel_biases(const Image& image, const Image& reference, const std::vector<std::size_t>& texels) {
    std::vector<double> out(image.channels, 0.0);
    for (const std::size_t i : texels)
        for (std::uint32_t c = 0; c < image.channels; ++c) {
            const std::size_t k = i * image.channels + c;
            out[c] += static_cast<double>(image.data[k]) - static_cast<double>(reference.data[k]);
        }
    for (double& bias : out) bias /= std::max<double>(1.0, static_cast<double>(texels.size()));
    return out;
}

}  // namespace

Mask mask_from_image(const Image& image) {
    Mask mask(std::size_t{image.width} * image.height);
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = image.data[i * image.channels] >= 0.5f ? 1 : 0;
    return mask;
}

ImageMetrics compare_images(const Image& image, const Image& reference, std::span<const std::uint8_t> mask,
                            std::size_t worst_count) {
    check_same_shape(image, reference, mask);
    ImageMetrics out;
    const std::vector<std::size_t> texels = comparable_texels(image, reference, mask, out.non_finite);
    out.texels = texels.size();
    const std::uint32_t channels = image.channels;
    const auto x = [&](std::size_t k) { return static_cast<double>(image.data[k]); };
    const auto r = [&](std::size_t k) { return static_cast<double>(reference.data[k]); };
    const auto squared_error = [&](std::size_t k) { return (x(k) - r(k)) * (x(k) - r(k)); };

    out.mean = mean_over(texels, channels, x);
    out.reference_mean = mean_over(texels, channels, r);
    // A black reference has no scale of its own: figures that divide by its mean are then absolute.
    const double scale = out.reference_mean != 0.0 ? std::fabs(out.reference_mean) : 1.0;
    out.bias = out.mean - out.reference_mean;
    out.relative_bias = out.bias / scale;
    out.channel_bias = channel_biases(image, reference, texels);
    out.nrmse = std::sqrt(mean_over(texels, channels, squared_error)) / scale;
    const std::vector<double> errors = relative_squared_errors(image, reference, texels, scale);
    for (const double error : errors) out.relmse += error / static_cast<double>(errors.size());
    out.relmse_without_worst = mean_without_worst(errors);
    out.block_bias_p95 = block_bias_p95(image, reference, texels, scale);
    out.median_relative_error = median_relative_error(image, reference, texels, scale);
    out.log_psnr = log_psnr(image, reference, texels);
    out.worst = worst_texels(image, reference, texels, errors, worst_count);
    if (out.non_finite > 0) out.nrmse = out.relmse = out.relmse_without_worst = std::numeric_limits<double>::infinity();
    return out;
}

double cross_relmse(const Image& image, const Image& a, const Image& b, std::span<const std::uint8_t> mask) {
    check_same_shape(image, a, mask);
    check_same_shape(image, b, mask);
    std::uint64_t non_finite = 0;
    Image reference = a;
    for (std::size_t k = 0; k < reference.data.size(); ++k) reference.data[k] = 0.5f * (a.data[k] + b.data[k]);
    const std::vector<std::size_t> texels = comparable_texels(image, reference, mask, non_finite);
    if (non_finite > 0) return std::numeric_limits<double>::infinity();
    const auto r = [&](std::size_t k) {
        return 0.5 * (static_cast<double>(a.data[k]) + static_cast<double>(b.data[k]));
    };
    const double mean = mean_over(texels, image.channels, r);
    return mean_over(texels, image.channels, [&](std::size_t k) {
        const double x = static_cast<double>(image.data[k]);
        return (x - static_cast<double>(a.data[k])) * (x - static_cast<double>(b.data[k])) /
               relative_square(r(k), mean);
    });
}

double mean_without_worst(std::vector<double> errors) {
    const auto left_out = static_cast<std::size_t>(std::ceil(kWorstShare * static_cast<double>(errors.size())));
    if (errors.size() <= left_out) return 0.0;
    const std::size_t kept = errors.size() - left_out;
    std::sort(errors.begin(), errors.end());
    return std::accumulate(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(kept), 0.0) /
           static_cast<double>(kept);
}

double percentile(std::span<double> values, double fraction) {
    if (values.empty()) return 0.0;
    const double position = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(values.size() - 1);
    const std::size_t below = static_cast<std::size_t>(position);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
    std::nth_element(values.begin(), at, values.end());
    const double low = *at;
    if (below + 1 == values.size()) return low;
    const double high = *std::min_element(at + 1, values.end());
    return low + (high - low) * (position - static_cast<double>(below));
}

}  // namespace lumel
