// Judging Monte Carlo results: moments, z-tests with Sidak's correction, chi-squared tests of sampling densities.
// Based on: Subr and Arvo 2007, "Statistical Hypothesis Testing for Assessing Monte Carlo Estimators"; the tests of
// Mitsuba 3 (chi2.py, test_renders.py).
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "lumel/vec.h"

namespace lumel::test {

// Plain random numbers for tests, equal on every platform (PCG, O'Neill 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15ull + 0x853c49e6748fea9bull) { bits(); }
    std::uint32_t bits() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ull + 1442695040888963407ull;
        const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
        const auto turn = static_cast<std::uint32_t>(old >> 59);
        return (shifted >> turn) | (shifted << ((32 - turn) & 31));
    }
    float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }  // [0, 1)
    Vec2 pair() {
        const float x = unit();
        return {x, unit()};
    }

private:
    std::uint64_t state_;
};

// Welford's running mean and variance.
class Moments {
public:
    void add(double x) {
        count_ += 1;
        const double delta = x - mean_;
        mean_ += delta / count_;
        squares_ += delta * (x - mean_);
    }
    [[nodiscard]] double count() const { return count_; }
    [[nodiscard]] double mean() const { return mean_; }
    [[nodiscard]] double variance() const { return count_ > 1 ? squares_ / (count_ - 1) : 0.0; }
    [[nodiscard]] double standard_error() const { return std::sqrt(variance() / count_); }

private:
    double count_ = 0, mean_ = 0, squares_ = 0;
};

// Significance of one of `tests` independent tests such that all pass by chance with probability 1 - false_alarm.
inline double sidak(double false_alarm, std::size_t tests) {
    return -std::expm1(std::log1p(-false_alarm) / static_cast<double>(tests));
}

// z with two-sided tail probability `significance`, by bisection on erfc.
inline double z_limit(double significance) {
    double low = 0.0, high = 40.0;
    for (int i = 0; i < 100; ++i) {
        const double z = 0.5 * (low + high);
        (std::erfc(z * 0.70710678118654752) > significance ? low : high) = z;
    }
    return high;
}

// The mean of the samples agrees with `expected`. `floor` is relative and stands for the rounding of float arithmetic.
inline ::testing::AssertionResult mean_agrees(const Moments& samples, double expected, double false_alarm,
                                              std::size_t tests = 1, double floor = 1e-5) {
    const double limit = z_limit(sidak(false_alarm, tests)) * samples.standard_error() + floor * std::fabs(expected);
    const double error = samples.mean() - expected;
    if (std::isfinite(error) && std::fabs(error) <= limit) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "mean " << samples.mean() << " expected " << expected << " error " << error
                                         << " standard error " << samples.standard_error() << " limit " << limit;
}

// Upper tail of the chi-squared distribution: regularised incomplete gamma Q(dof/2, x/2), by series or continued
// fraction (Press et al., Numerical Recipes, 6.2).
inline double chi_squared_tail(double statistic, double dof) {
    const double a = 0.5 * dof, x = 0.5 * statistic;
    if (x <= 0.0) return 1.0;
    const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (double n = a + 1.0; std::fabs(term) > 1e-15 * std::fabs(sum); n += 1.0) sum += term *= x / n;
        return 1.0 - sum * front;
    }
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
    for (int i = 1; i < 10000; ++i) {
        const double an = -i * (i - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        const double step = d * c;
        h *= step;
        if (std::fabs(step - 1.0) < 1e-15) break;
    }
    return front * h;
}

// Observed counts against expected counts; cells that expect fewer than 5 are pooled (Cochran's rule).
inline ::testing::AssertionResult counts_agree(const std::vector<double>& observed, const std::vector<double>& expected,
                                               double significance) {
    double statistic = 0, cells = 0, pooled_observed = 0, pooled_expected = 0;
    const auto add = [&](double o, double e) {
        statistic += (o - e) * (o - e) / e;
        cells += 1;
    };
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (expected[i] == 0.0 && observed[i] > 0.0)
            return ::testing::AssertionFailure()
                   << observed[i] << " samples in cell " << i << " where the density is 0";
        if (expected[i] >= 5.0) {
            add(observed[i], expected[i]);
        } else {
            pooled_observed += observed[i];
            pooled_expected += expected[i];
            if (pooled_expected >= 5.0) {
                add(pooled_observed, pooled_expected);
                pooled_observed = pooled_expected = 0;
            }
        }
    }
    if (cells < 2) return ::testing::AssertionFailure() << "too few cells for a chi-squared test";
    const double tail = chi_squared_tail(statistic, cells - 1);
    if (tail >= significance) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "chi-squared " << statistic << " with " << cells - 1
                                         << " degrees of freedom: p = " << tail << " < " << significance;
}

// A distribution over directions: `sample` draws one (the zero vector: none), `pdf` is its density per solid angle.
// The sphere is cut into cells of equal solid angle about `axis`, restricted to cosines in [min_cosine, 1] so that
// narrow distributions are resolved; samples outside it fail. The integral of the pdf over a cell is taken at
// `quadrature`^2 midpoints: densities with edges need many. Total mass may be below 1 where `sample` draws none.
struct DirectionTest {
    Vec3 axis{0, 0, 1};
    double min_cosine = -1.0;
    int rings = 16, sectors = 32, quadrature = 16;
    int samples = 200000;
    std::uint64_t seed = 1;
    double significance = 1e-4;
};

inline ::testing::AssertionResult directions_agree(const DirectionTest& test,
                                                   const std::function<Vec3(Random&)>& sample,
                                                   const std::function<double(Vec3)>& pdf) {
    // A frame about the axis in double, so that cells are the same for narrow cones.
    const double ax = test.axis.x, ay = test.axis.y, az = test.axis.z;
    const double sign = az < 0 ? -1.0 : 1.0, a = -1.0 / (sign + az), b = ax * ay * a;
    const double t[3] = {1 + sign * ax * ax * a, sign * b, -sign * ax}, s[3] = {b, sign + ay * ay * a, -ay};
    const double one_minus = 1.0 - test.min_cosine;
    const auto cells = static_cast<std::size_t>(test.rings * test.sectors);
    std::vector<double> observed(cells + 1), expected(cells + 1);

    Random random(test.seed);
    for (int i = 0; i < test.samples; ++i) {
        const Vec3 d = sample(random);
        if (d == Vec3{}) {
            observed[cells] += 1;
            continue;
        }
        const double x = d.x * t[0] + d.y * t[1] + d.z * t[2], y = d.x * s[0] + d.y * s[1] + d.z * s[2];
        const double z = d.x * ax + d.y * ay + d.z * az;
        const double h = z > 0 ? (x * x + y * y) / (1 + z) : 1.0 - z;  // 1 - cos without cancellation
        const int ring = static_cast<int>(h / one_minus * test.rings);
        if (ring > test.rings || (ring == test.rings && h > one_minus * 1.0001))
            return ::testing::AssertionFailure() << "sample outside the tested cone: cosine " << z;
        const int sector = static_cast<int>((std::atan2(y, x) / 6.283185307179586 + 1.0) * test.sectors) % test.sectors;
        observed[static_cast<std::size_t>(std::min(ring, test.rings - 1) * test.sectors + sector)] += 1;
    }

    double total = 0;
    const double cell_angle = 6.283185307179586 * one_minus / static_cast<double>(cells);
    for (int ring = 0; ring < test.rings; ++ring)
        for (int sector = 0; sector < test.sectors; ++sector) {
            double sum = 0;
            for (int i = 0; i < test.quadrature; ++i)
                for (int j = 0; j < test.quadrature; ++j) {
                    const double h = one_minus * (ring + (i + 0.5) / test.quadrature) / test.rings;
                    const double phi = 6.283185307179586 * (sector + (j + 0.5) / test.quadrature) / test.sectors;
                    const double r = std::sqrt(h * (2 - h)), x = r * std::cos(phi), y = r * std::sin(phi), z = 1 - h;
                    sum += pdf({static_cast<float>(x * t[0] + y * s[0] + z * ax),
                                static_cast<float>(x * t[1] + y * s[1] + z * ay),
                                static_cast<float>(x * t[2] + y * s[2] + z * az)});
                }
            const double mass = sum / (test.quadrature * test.quadrature) * cell_angle;
            expected[static_cast<std::size_t>(ring * test.sectors + sector)] = mass * test.samples;
            total += mass;
        }
    // 1 % is far above the quadrature's error and far below any real fault of normalisation.
    if (total > 1.01) return ::testing::AssertionFailure() << "the density integrates to " << total;
    expected[cells] = std::max(0.0, 1.0 - total) * test.samples;
    if (observed[cells] == 0.0) {
        if (total < 0.99) return ::testing::AssertionFailure() << "the density integrates to " << total;
        for (double& e : expected) e /= total;  // the quadrature's error is not the sampler's
        expected[cells] = 0.0;
    }
    return counts_agree(observed, expected, test.significance);
}

}  // namespace lumel::test
