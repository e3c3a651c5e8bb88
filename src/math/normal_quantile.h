// Quantile of the standard normal distribution. Not on the bake path's inner loops.
#pragma once

#include <cmath>

namespace lumel {

inline double normal_cdf(double x) { return 0.5 * std::erfc(-x * 0.70710678118654752440); }

// z with normal_cdf(z) = p, for 0 < p < 1; by bisection to 1e-12.
inline double normal_quantile(double p) {
    double low = -40.0, high = 40.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (normal_cdf(middle) < p ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace lumel
