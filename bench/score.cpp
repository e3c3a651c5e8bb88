#include "score.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "image/metrics.h"
#include "math/normal_quantile.h"

namespace lumel::bench {
namespace {

constexpr double kRelativeFloor = 0.01;
constexpr std::uint32_t kBlock = 16;
constexpr double kInterval = 1.96;  // deviations either side that contain 95 of 100

// Of a texel and a colour channel: the values that are scored together.
using Values = std::array<double, kScoredSh>;

Values irradiance_of(const TexelLight& light, std::size_t c) { return {static_cast<double>(light.irradiance[c])}; }
Values sh_of(const TexelLight& light, std::size_t c) {
    Values out{};
    for (std::size_t k = 0; k < kScoredSh; ++k) out[k] = static_cast<double>(light.sh[k][c]);
    return out;
}

double dot(const Values& a, const Values& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kScoredSh; ++k) sum += a[k] * b[k];
    return sum;
}
Values combine(double s, const Values& a, double t, const Values& b) {
    Values out;
    for (std::size_t k = 0; k < kScoredSh; ++k) out[k] = s * a[k] + t * b[k];
    return out;
}

struct Compared {
    TexelLight x, a, b;
};

// The terms of relMSE, one per texel; `error` has the product that is scored.
template <class Read, class Error>
std::vector<double> relative_errors(const std::vector<Compared>& texels, const Read& read, const Error& error) {
    double mean = 0.0;
    const auto reference = [&](const Compared& t, std::size_t c) {
        return combine(0.5, read(t.a, c), 0.5, read(t.b, c));
    };
    for (const Compared& t : texels)
        for (std::size_t c = 0; c < 3; ++c) {
            const Values r = reference(t, c);
            mean += std::sqrt(dot(r, r));
        }
    mean /= 3.0 * static_cast<double>(std::max<std::size_t>(1, texels.size()));
    std::vector<double> out;
    for (const Compared& t : texels) {
        double sum = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            const Values r = reference(t, c);
            const double scale = dot(r, r) + kRelativeFloor * mean * mean;
            if (scale > 0.0) sum += error(read(t.x, c), read(t.a, c), read(t.b, c)) / scale;
        }
        out.push_back(sum / 3.0);
    }
    return out;
}

double product_of_errors(const Values& x, const Values& a, const Values& b) {
    return dot(combine(1.0, x, -1.0, a), combine(1.0, x, -1.0, b));
}

double mean_of(std::span<const double> values) {
    double sum = 0.0;
    for (const double v : values) sum += v;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double sum_of_channels(Vec3 v) {
    return static_cast<double>(v.x) + static_cast<double>(v.y) + static_cast<double>(v.z);
}

struct Coverage {
    double brightness = 0.0, share = 0.0;  // of the texel's three channels
};

Coverage coverage_of(const Compared& t, Vec3 variance) {
    Coverage out;
    for (std::size_t c = 0; c < 3; ++c) {
        const double a = static_cast<double>(t.a.irradiance[c]), b = static_cast<double>(t.b.irradiance[c]);
        const double d = static_cast<double>(t.x.irradiance[c]) - 0.5 * (a + b);
        const double total_variance = static_cast<double>(variance[c]) + 0.25 * (a - b) * (a - b);
        out.brightness += a + b;
        out.share += d * d <= kInterval * kInterval * total_variance ? 1.0 / 3.0 : 0.0;
    }
    return out;
}

void score_coverage(std::vector<Coverage> texels, Score& out) {
    std::ranges::sort(texels, {}, [](const Coverage& t) { return std::pair(t.brightness, t.share); });
    out.lowest_coverage = 1.0;
    constexpr std::size_t kParts = 10;
    for (std::size_t part = 0; part < kParts; ++part) {
        const std::size_t first = part * texels.size() / kParts, last = (part + 1) * texels.size() / kParts;
        if (first == last) continue;
        double sum = 0.0;
        for (std::size_t i = first; i < last; ++i) sum += texels[i].share;
        out.coverage += sum / static_cast<double>(texels.size());
        const double mean = sum / static_cast<double>(last - first);
        out.lowest_coverage = std::min(out.lowest_coverage, mean);
        out.highest_coverage = std::max(out.highest_coverage, mean);
    }
}

struct Block {
    double x = 0.0, r = 0.0, variance = 0.0;
    std::size_t texels = 0;
};

}  // namespace

double joint_p95(std::span<const double> deviations) {
    if (deviations.empty()) return 0.0;
    double low = 0.0, high = 4.0 * *std::ranges::max_element(deviations);
    for (int i = 0; i < 60; ++i) {
        const double limit = 0.5 * (low + high);
        double beyond = 0.0;
        for (const double d : deviations)
            if (d > 0.0) beyond += 2.0 * normal_cdf(-limit / d);
        (beyond > 0.05 * static_cast<double>(deviations.size()) ? low : high) = limit;
    }
    return high;
}

Score score(const RadianceSums& sums, const ReferenceHalf& a, const ReferenceHalf& b, const TexelBuffer& texels,
            TexelRange range) {
    std::vector<Compared> compared;
    std::vector<Coverage> covered;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Block> blocks;
    Block all;
    for (std::size_t i = 0; i < range.count; ++i) {
        const std::size_t texel = range.first + i;
        if (!sums.valid(texel) || !a.valid[i] || !b.valid[i]) continue;
        compared.push_back({light_of(sums, texel), a.light[i], b.light[i]});
        covered.push_back(coverage_of(compared.back(), sums.variance[texel]));
        const double x = sum_of_channels(compared.back().x.irradiance);
        const double r = 0.5 * (sum_of_channels(a.light[i].irradiance) + sum_of_channels(b.light[i].irradiance));
        // Channels of one path rise and fall together: their deviations add.
        double deviation = 0.0;
        for (std::size_t c = 0; c < 3; ++c) deviation += std::sqrt(static_cast<double>(sums.variance[texel][c]));
        for (Block* block : {&blocks[{texels.y[texel] / kBlock, texels.x[texel] / kBlock}], &all}) {
            block->x += x;
            block->r += r;
            block->variance += deviation * deviation;
            ++block->texels;
        }
    }
    Score out;
    out.texels = compared.size();
    if (compared.empty()) return out;

    const std::vector<double> errors = relative_errors(compared, irradiance_of, product_of_errors);
    out.relmse = mean_of(errors);
    out.relmse_without_worst = mean_without_worst(errors);
    out.relmse_sh = mean_of(relative_errors(compared, sh_of, product_of_errors));
    out.reference_relmse =
        mean_of(relative_errors(compared, irradiance_of, [](const Values&, const Values& in_a, const Values& in_b) {
            const Values half = combine(0.5, in_a, -0.5, in_b);
            return dot(half, half);
        }));

    score_coverage(std::move(covered), out);

    const double mean = all.r / static_cast<double>(all.texels);
    if (!(mean > 0.0)) return out;
    out.bias = all.x / all.r - 1.0;
    std::vector<double> biases, deviations;
    for (const auto& [place, block] : blocks) {
        const double scale = block.r + kRelativeFloor * mean * static_cast<double>(block.texels);
        biases.push_back(std::fabs(block.x - block.r) / scale);
        deviations.push_back(std::sqrt(block.variance) / scale);
    }
    out.block_bias = percentile(biases, 0.95);
    out.block_noise = joint_p95(deviations);
    return out;
}

}  // namespace lumel::bench
