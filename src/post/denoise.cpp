// Based on: Rousselle, Knaus, Zwicker 2012, "Adaptive Rendering with Non-local Means Filtering" (patch distances that
// allow for the variance of both patches). Different here: the window is cut by the surface, not by auxiliary images;
// the variance is that of the texels' means, as pool_variance() leaves it; one buffer instead of two halves; distances
// are the same both ways.
#include "post/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"

namespace lumel {
namespace {

constexpr float kPlaneOffset = 0.5f;  // from each other's tangent plane, in texels
constexpr float kReach = 1.8f;        // how much farther apart in the world than in texels neighbours may be
constexpr float kUnseen = 0.01f;      // differences of so much of the brighter texel are of no interest
constexpr float kTiny = 1e-30f;
constexpr std::size_t kRowsPerBand = 16;  // at least the largest radius

struct Guide {
    Vec3 irradiance, variance;
};

class Denoiser {
public:
    Denoiser(const TexelBuffer& texels, const DenoiseOptions& options, const RadianceSums& sums)
        : texels_(texels),
          sums_(sums),
          radius_(static_cast<int>(options.radius)),
          k2_(options.strength * options.strength) {
        read_guides(options.included);
        find_row_starts();
    }

    // First texel of a row of the page, and one past the last row's last.
    [[nodiscard]] std::size_t row_start(std::size_t row) const {
        return row_start_[std::min(row, row_start_.size() - 1)];
    }
    [[nodiscard]] std::size_t rows() const { return texels_.height; }

    void filter(std::size_t i, std::array<LayerMoments, kLayerCount>& out) const {
        out = sums_.layers[i];
        if (!sums_.valid(i)) return;
        float total = 1.0f;  // the texel itself has the largest weight there is
        for (int dy = -radius_; dy <= radius_; ++dy)
            for (int dx = -radius_; dx <= radius_; ++dx) {
                if (dx == 0 && dy == 0) continue;
                const std::uint32_t j = valid_at(texels_.x[i] + dx, texels_.y[i] + dy);
                if (j == kNone || !are_neighbours(i, j, dx, dy)) continue;
                const float weight = patch_weight(i, j, dx, dy);
                if (weight <= 0.0f) continue;
                total += weight;
                add(out, sums_.layers[j], weight);
            }
        const float inverse = 1.0f / total;
        for (LayerMoments& layer : out) {
            for (Vec3& coefficient : layer.sh) coefficient *= inverse;
            layer.irradiance *= inverse;
        }
    }

private:
    static void add(std::array<LayerMoments, kLayerCount>& to, const std::array<LayerMoments, kLayerCount>& from,
                    float weight) {
        for (std::size_t l = 0; l < kLayerCount; ++l) {
            for (std::size_t k = 0; k < kShCoefficients; ++k) to[l].sh[k] += from[l].sh[k] * weight;
            to[l].irradiance += from[l].irradiance * weight;
        }
    }

    [[nodiscard]] std::uint32_t valid_at(int x, int y) const {
        const std::uint32_t i = texels_.at(x, y);
        return i != kNone && sums_.valid(i) ? i : kNone;
    }

    [[nodiscard]] bool are_neighbours(std::size_t i, std::size_t j, int dx, int dy) const {
        if (!texels_.on_one_surface(i, j)) return false;
        const Vec3 d = texels_.position[j] - texels_.position[i];
        const auto off_plane = [&](std::size_t t) {
            return std::fabs(dot(texels_.normal[t], d)) > kPlaneOffset * texels_.world_size[t];
        };
        if (off_plane(i) || off_plane(j)) return false;
        const float reach = kReach * std::max(texels_.world_size[i], texels_.world_size[j]);
        return dot(d, d) <= reach * reach * static_cast<float>(dx * dx + dy * dy);
    }

    // The squared difference of two texels in units of what their noise explains; about 0 where noise is all there is.
    [[nodiscard]] float distance(const Guide& p, const Guide& q) const {
        float sum = 0.0f;
        for (std::size_t c = 0; c < 3; ++c) {
            const float d = p.irradiance[c] - q.irradiance[c];
            // The same both ways: with the lesser variance for the neighbour's, as published, a bright texel takes from
            // dark ones that do not take from it, and rare light gets lost.
            const float noise = p.variance[c] + q.variance[c];
            const float level = std::max(p.irradiance[c], q.irradiance[c]);
            const float unseen = kUnseen * kUnseen * level * level + kTiny;
            sum += (d * d - noise) / (unseen + k2_ * (p.variance[c] + q.variance[c]));
        }
        return sum * (1.0f / 3.0f);
    }

    [[nodiscard]] float patch_weight(std::size_t i, std::size_t j, int dx, int dy) const {
        float sum = distance(guides_[i], guides_[j]);
        float count = 1.0f;
        for (int py = -1; py <= 1; ++py)
            for (int px = -1; px <= 1; ++px) {
                if (px == 0 && py == 0) continue;
                const std::uint32_t p = valid_at(texels_.x[i] + px, texels_.y[i] + py);
                const std::uint32_t q = valid_at(texels_.x[i] + dx + px, texels_.y[i] + dy + py);
                if (p == kNone || q == kNone) continue;
                if (texels_.chart[p] != texels_.chart[i] || texels_.chart[q] != texels_.chart[i]) continue;
                sum += distance(guides_[p], guides_[q]);
                count += 1.0f;
            }
        // e^-d by its rational neighbour: a bell all the same, and without the math library on the path of the bake.
        const float d = std::max(0.0f, sum / count);
        const float near = std::max(0.0f, 1.0f - 0.25f * d);
        return near * near * near * near;
    }

    void read_guides(const std::array<bool, kLayerCount>& included) {
        guides_.resize(texels_.size());
        for (std::size_t i = 0; i < guides_.size(); ++i) {
            if (!sums_.valid(i)) continue;
            for (std::size_t l = 0; l < kLayerCount; ++l)
                if (included[l]) guides_[i].irradiance += sums_.layers[i][l].irradiance;
            guides_[i].variance = sums_.variance[i];
        }
    }

    void find_row_starts() {
        row_start_.resize(texels_.height + 1, texels_.size());
        std::size_t i = 0;
        for (std::size_t row = 0; row < texels_.height; ++row) {
            while (i < texels_.size() && texels_.y[i] < row) ++i;
            row_start_[row] = i;
        }
    }

    const TexelBuffer& texels_;
    const RadianceSums& sums_;
    int radius_;
    float k2_;
    std::vector<Guide> guides_;
    std::vector<std::size_t> row_start_;
};

using Band = std::vector<std::array<LayerMoments, kLayerCount>>;

void write_back(const Band& band, std::size_t first, RadianceSums& sums) {
    std::copy(band.begin(), band.end(), sums.layers.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace

// Bands of rows, written back one band late: the next one still reads the sums as they were sampled.
Status denoise(const TexelBuffer& texels, const DenoiseOptions& options, RadianceSums& sums, Context& context) {
    LUMEL_CHECK(options.radius <= kRowsPerBand, options.radius);
    LUMEL_CHECK(sums.size() == texels.size(), sums.size(), texels.size());
    LUMEL_CHECK(texels.chart.size() == texels.size(), texels.chart.size(), texels.size());
    const Denoiser denoiser(texels, options, sums);
    Band now, before;
    std::size_t first_before = 0;
    for (std::size_t row = 0; row < denoiser.rows(); row += kRowsPerBand) {
        const std::size_t first = denoiser.row_start(row);
        const std::size_t count = denoiser.row_start(row + kRowsPerBand) - first;
        now.resize(count);
        const bool done = parallel_for(context, count, 64, [&](const ChunkRange& range) {
            for (std::size_t i = range.begin; i < range.end; ++i) denoiser.filter(first + i, now[i]);
        });
        if (!done) return cancelled_error();
        write_back(before, first_before, sums);
        std::swap(now, before);
        first_before = first;
        context.report("denoise", static_cast<double>(std::min(row + kRowsPerBand, denoiser.rows())) /
                                      static_cast<double>(denoiser.rows()));
    }
    write_back(before, first_before, sums);
    return success();
}

}  // namespace lumel
