// How many paths of a few neighbouring texels share one sample of the lights. Where bounced light makes most of the
// noise, a shadow ray for every path is wasted; where the lights themselves do, it is not.
//
// Based on: Veach 1997, ch. 9.2.2 (multiple importance sampling with different numbers of samples) and the usual
// allocation by variance and cost.
#pragma once

#include <algorithm>
#include <cstdint>

namespace lumel {

struct LightRate {
    std::uint32_t paths = 1;  // to one light sample
    std::uint32_t from = 0;   // PathStart::index since which it is so; before it was one to one

    // One of each `paths` successive paths takes a sample, another one in the next round of a texel's points.
    [[nodiscard]] bool takes(std::uint32_t index) const { return paths == 1 || (index + index / 64) % paths == 0; }
    // Its number: successive ones, so that the points of the samples are as evenly spread as if all were taken.
    [[nodiscard]] std::uint32_t number(std::uint32_t index) const { return (index + from * (paths - 1)) / paths; }
    // By how much fewer there are.
    [[nodiscard]] float share() const { return 1.0f / static_cast<float>(paths); }
};

// What single paths of one round brought. Noise is what paths of one texel differ by.
class LightRateStatistics {
public:
    // `sampled`: by light samples; `met`: by the rays themselves.
    void add(float sampled, float met) {
        sampled_.add(static_cast<double>(sampled));
        met_.add(static_cast<double>(met));
    }
    // What was added since the last call was of one texel.
    void end_texel() {
        sampled_.end_texel();
        met_.end_texel();
    }
    // The rate of less variance for the same cost, since path `from`.
    [[nodiscard]] LightRate rate(std::uint32_t from) const {
        constexpr double kSampleCost = 0.4;  // of a path with its sample, measured in the benchmark's rooms
        const double each = sampled_.noise() + met_.noise();
        const double every_other = (2.0 * sampled_.noise() + met_.noise()) * (1.0 - 0.5 * kSampleCost);
        return {every_other < each ? 2u : 1u, from};
    }

private:
    class Noise {
    public:
        void add(double x) {
            count_ += 1.0;
            sum_ += x;
            squares_ += x * x;
        }
        void end_texel() {
            if (count_ > 0.0) noise_ += std::max(0.0, squares_ - sum_ * sum_ / count_);
            count_ = sum_ = squares_ = 0.0;
        }
        [[nodiscard]] double noise() const { return noise_; }

    private:
        double noise_ = 0.0, count_ = 0.0, sum_ = 0.0, squares_ = 0.0;
    };
    Noise sampled_, met_;
};

}  // namespace lumel
