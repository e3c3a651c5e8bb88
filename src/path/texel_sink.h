// What the paths of one texel add up to: in single precision over one wavefront, and those sums in double, for millions
// of samples must add up.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "math/constants.h"
#include "path/adaptive_samples.h"
#include "path/path_integrator.h"
#include "path/radiance_sums.h"
#include "sh/basis.h"

namespace lumel {

// Told by the integrator of everything that happens to a texel's paths, wavefront by wavefront.
class TexelSink {
public:
    static constexpr bool kFromCell = false, kSunsKnown = true, kMayBeGuided = true;

    explicit TexelSink(const PathOptions& options)
        : ao_distance_(options.ao_distance), scale_(options.layer_scale), included_(options.included) {}

    void begin(std::span<const PathStart> starts, float sh_scale) {
        starts_ = starts;
        sh_scale_ = sh_scale;
        wavefront_ = {};
        for (std::size_t lane = 0; lane < starts.size(); ++lane) {
            sample_[lane] = {};
            void_[lane] = 0.0f;
        }
    }

    // `weight`: density of its first ray without a guide over the density it was drawn with.
    void void_path(std::uint32_t lane, float weight) { void_[lane] = weight; }

    void light(std::uint32_t lane, Layer of, Vec3 direction, Vec3 value) {
        const auto layer = static_cast<std::size_t>(of);
        LayerSums<float>& sums = wavefront_[layer];
        value *= scale_[layer];
        const ShBasis basis = sh_basis(direction);
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < kShCoefficients; ++i) sums.sh[c][i] += basis[i] * value[c];
        const float cosine = std::max(0.0f, dot(direction, starts_[lane].normal));
        const Vec3 irradiance = value * (cosine * kInvPi);
        for (std::size_t c = 0; c < 3; ++c) sums.irradiance[c] += irradiance[c];
        if (included_[layer]) sample_[lane] += irradiance;
    }

    void free_path(std::uint32_t lane, Vec3 direction, float pdf, float distance, bool sky) {
        const float cosine = std::max(0.0f, dot(direction, starts_[lane].normal));
        const double weight = static_cast<double>(cosine * kInvPi / pdf);
        if (sky) sky_visibility_ += weight;
        if (distance <= ao_distance_) return;
        open_ += weight;
        for (std::size_t c = 0; c < 3; ++c) bent_[c] += weight * static_cast<double>(direction[c]);
    }

    void end() {
        for (std::size_t layer = 0; layer < kLayerCount; ++layer)
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t i = 0; i < kShCoefficients; ++i)
                    layers_[layer].sh[c][i] += static_cast<double>(wavefront_[layer].sh[c][i] * sh_scale_);
                layers_[layer].irradiance[c] += static_cast<double>(wavefront_[layer].irradiance[c]);
            }
        for (std::size_t lane = 0; lane < starts_.size(); ++lane) {
            // Without a guide 1 or 0. With one the share of void paths is estimated by their weights.
            const double counts = 1.0 - static_cast<double>(void_[lane]);
            count_ += counts;
            squared_counts_ += counts * counts;
            Half& half = halves_[traced_ & 1u];
            half.count += counts;
            for (std::size_t c = 0; c < 3; ++c) {
                const auto value = static_cast<double>(sample_[lane][c]);
                half.sum[c] += value;
                channels_[c].add(value, counts);
            }
            luminance_.add(static_cast<double>(luminance(sample_[lane])), counts);
            ++traced_;
        }
    }

    [[nodiscard]] std::uint32_t traced() const { return traced_; }

    // What others of its block may know of it.
    [[nodiscard]] TexelProgress progress() const {
        TexelProgress out;
        out.samples = traced_;
        out.valid = halves_[0].count > 0.0 && halves_[1].count > 0.0 && 2.0 * count_ > traced_;
        if (!out.valid) return out;
        out.mean = luminance_.mean(count_);
        out.half_difference = luminance_of(halves_[0]) - luminance_of(halves_[1]);
        return out;
    }

    // Frostbite's rule on the texel's own luminance.
    [[nodiscard]] bool converged(double relative_error) const {
        if (count_ < 2.0) return false;
        return std::sqrt(luminance_.variance(counts())) <= relative_error * luminance_.mean(count_);
    }

    void store(RadianceSums& out, std::size_t index) const {
        out.traced[index] = traced_;
        out.count[index] = count_ > 0.0 ? static_cast<std::uint32_t>(count_ + 0.5) : 0;
        if (out.count[index] == 0) return;
        const double inverse = 1.0 / count_;
        for (std::size_t layer = 0; layer < kLayerCount; ++layer) {
            LayerMoments& moments = out.layers[index][layer];
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t i = 0; i < kShCoefficients; ++i)
                    moments.sh[i][c] = static_cast<float>(layers_[layer].sh[c][i] * inverse);
                moments.irradiance[c] = static_cast<float>(layers_[layer].irradiance[c] * inverse);
            }
        }
        for (std::size_t c = 0; c < 3; ++c) {
            out.variance[index][c] = static_cast<float>(channels_[c].variance(counts()));
            out.half_difference[index][c] = half_difference(c, out.variance[index][c]);
            out.bent_normal[index][c] = static_cast<float>(bent_[c] * inverse);
        }
        out.sky_visibility[index] = static_cast<float>(std::min(1.0, sky_visibility_ * inverse));
        out.ambient_occlusion[index] = static_cast<float>(std::min(1.0, open_ * inverse));
    }

private:
    template <class Number>
    struct LayerSums {
        std::array<std::array<Number, kShCoefficients>, 3> sh{};  // by channel: the nine add up as vectors
        std::array<Number, 3> irradiance{};
    };

    // Of the v_i by which paths count: their sum, that of their squares; their number.
    struct Counts {
        double sum, squares, traced;
    };
    [[nodiscard]] Counts counts() const { return {count_, squared_counts_, static_cast<double>(traced_)}; }

    // Moments of samples x_i over all paths, which count as v_i (a void one as nothing): the mean is sum x / sum v.
    class Moments {
    public:
        void add(double x, double counts) {
            sum_ += x;
            squares_ += x * x;
            counted_ += x * counts;
        }
        [[nodiscard]] double mean(double count) const { return sum_ / count; }
        // Of that mean, by the residuals x - mean v (Cochran 1977, ch. 6); without void paths the familiar one.
        [[nodiscard]] double variance(const Counts& v) const {
            if (v.sum < 2.0) return 0.0;
            const double m = mean(v.sum);
            const double residuals = std::max(0.0, squares_ - 2.0 * m * counted_ + m * m * v.squares);
            return residuals / (v.sum * v.sum) * (v.traced / (v.traced - 1.0));
        }

    private:
        double sum_ = 0.0, squares_ = 0.0, counted_ = 0.0;
    };

    // Where a half has no sample that counts it is unknown: what independent samples of that variance would give.
    [[nodiscard]] float half_difference(std::size_t c, float variance) const {
        if (halves_[0].count <= 0.0 || halves_[1].count <= 0.0) return 2.0f * std::sqrt(variance);
        return static_cast<float>(halves_[0].mean(c) - halves_[1].mean(c));
    }

    // Every other sample, from the first or the second on.
    struct Half {
        std::array<double, 3> sum{};
        double count = 0.0;
        [[nodiscard]] double mean(std::size_t c) const { return sum[c] / count; }
    };

    static double luminance_of(const Half& half) {
        return static_cast<double>(luminance(Vec3{static_cast<float>(half.mean(0)), static_cast<float>(half.mean(1)),
                                                  static_cast<float>(half.mean(2))}));
    }

    float ao_distance_;
    std::array<float, kLayerCount> scale_;
    std::array<bool, kLayerCount> included_;
    float sh_scale_ = 1.0f;
    std::span<const PathStart> starts_;
    std::array<Vec3, kWavefrontLanes> sample_{};
    std::array<float, kWavefrontLanes> void_{};
    std::array<LayerSums<float>, kLayerCount> wavefront_{};
    std::array<LayerSums<double>, kLayerCount> layers_{};
    std::array<Moments, 3> channels_{};
    Moments luminance_;
    std::array<Half, 2> halves_{};
    std::array<double, 3> bent_{};
    double sky_visibility_ = 0.0, open_ = 0.0;
    double count_ = 0.0, squared_counts_ = 0.0;
    std::uint32_t traced_ = 0;
};

}  // namespace lumel
