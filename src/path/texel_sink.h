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
        for (std::size_t lane = 0; lane < starts.size(); ++lane) sample_[lane] = {};
    }

    void back(std::uint32_t, float weight) { backs_ += static_cast<double>(weight); }

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
            Half& half = halves_[traced_ & 1u];
            ++half.traced;
            for (std::size_t c = 0; c < 3; ++c) {
                const auto value = static_cast<double>(sample_[lane][c]);
                half.sum[c] += value;
                channels_[c].add(value);
            }
            luminance_.add(static_cast<double>(luminance(sample_[lane])));
            ++traced_;
        }
    }

    [[nodiscard]] std::uint32_t traced() const { return traced_; }

    // What others of its block may know of it.
    [[nodiscard]] TexelProgress progress() const {
        TexelProgress out;
        out.samples = traced_;
        out.valid = halves_[1].traced > 0 && 2 * open() >= traced_;
        if (!out.valid) return out;
        out.mean = luminance_.mean(traced_);
        out.half_difference = luminance_of(halves_[0]) - luminance_of(halves_[1]);
        return out;
    }

    // Frostbite's rule on the texel's own luminance.
    [[nodiscard]] bool converged(double relative_error) const {
        if (traced_ < 2) return false;
        return std::sqrt(luminance_.variance(traced_)) <= relative_error * luminance_.mean(traced_);
    }

    void store(RadianceSums& out, std::size_t index) const {
        out.count[index] = traced_;
        out.open[index] = open();
        if (traced_ == 0) return;
        const double inverse = 1.0 / traced_;
        for (std::size_t layer = 0; layer < kLayerCount; ++layer) {
            LayerMoments& moments = out.layers[index][layer];
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t i = 0; i < kShCoefficients; ++i)
                    moments.sh[i][c] = static_cast<float>(layers_[layer].sh[c][i] * inverse);
                moments.irradiance[c] = static_cast<float>(layers_[layer].irradiance[c] * inverse);
            }
        }
        for (std::size_t c = 0; c < 3; ++c) {
            out.variance[index][c] = static_cast<float>(channels_[c].variance(traced_));
            out.half_difference[index][c] = half_difference(c);
            out.bent_normal[index][c] = static_cast<float>(bent_[c] * inverse);
        }
        out.sky_visibility[index] = static_cast<float>(std::min(1.0, sky_visibility_ * inverse));
        out.ambient_occlusion[index] = static_cast<float>(std::min(1.0, open_ * inverse));
    }

private:
    [[nodiscard]] std::uint32_t open() const {
        return static_cast<std::uint32_t>(std::max(0.0, traced_ - backs_) + 0.5);
    }

    template <class Number>
    struct LayerSums {
        std::array<std::array<Number, kShCoefficients>, 3> sh{};  // by channel: the nine add up as vectors
        std::array<Number, 3> irradiance{};
    };

    class Moments {
    public:
        void add(double x) {
            sum_ += x;
            squares_ += x * x;
        }
        [[nodiscard]] double mean(double n) const { return sum_ / n; }
        // Of that mean.
        [[nodiscard]] double variance(double n) const {
            if (n < 2.0) return 0.0;
            return std::max(0.0, squares_ - sum_ * sum_ / n) / (n * (n - 1.0));
        }

    private:
        double sum_ = 0.0, squares_ = 0.0;
    };

    // Of one sample it is unknown, as its variance is.
    [[nodiscard]] float half_difference(std::size_t c) const {
        if (halves_[1].traced == 0) return 0.0f;
        return static_cast<float>(halves_[0].mean(c) - halves_[1].mean(c));
    }

    // Every other sample, from the first or the second on.
    struct Half {
        std::array<double, 3> sum{};
        std::uint32_t traced = 0;
        [[nodiscard]] double mean(std::size_t c) const { return sum[c] / traced; }
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
    std::array<LayerSums<float>, kLayerCount> wavefront_{};
    std::array<LayerSums<double>, kLayerCount> layers_{};
    std::array<Moments, 3> channels_{};
    Moments luminance_;
    std::array<Half, 2> halves_{};
    std::array<double, 3> bent_{};
    double sky_visibility_ = 0.0, open_ = 0.0;
    double backs_ = 0.0;  // samples that met the back of a single-sided surface first, as their share is estimated
    std::uint32_t traced_ = 0;
};

}  // namespace lumel
