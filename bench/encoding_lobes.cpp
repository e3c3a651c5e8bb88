#include "encoding_lobes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "encode/hhd.h"
#include "encode/l1.h"

namespace lumel::bench {
namespace {

// AHD and HHD with one weight.
struct Lobes {
    Vec3 iz, direction;
    float weight;
    AmbientLobe ambient;
    Vec3 operator()(Vec3 n) const {
        const float a = ambient == AmbientLobe::uniform ? 1.0f : 0.5f * (1 + n.z);
        return iz * (weight * a + (1 - weight) * std::max(dot(n, direction), 0.0f) / direction.z);
    }
};

std::array<float, 9> luminance_target(const TexelLight& light) {
    std::array<float, 9> out = convolve_cosine(luminance(light.radiance)).c;
    for (float& v : out) v /= luminance(light.irradiance);
    return out;
}

Vec3 linear_direction_of(const TexelLight& light) {
    return optimal_linear_direction(luminance(light.radiance), Vec3{0, 0, 1});
}

Decoded lobes_of(const TexelLight& light, AmbientLobe ambient, const ZonalMatrix& gram, LobeDirection direction) {
    const std::array<float, 9> target = luminance_target(light);
    const Vec3 start = linear_direction_of(light);
    // As the expected figures have it: not as low as can be where it comes from below.
    const Vec3 raised = normalize(Vec3{start.x, start.y, std::max(start.z, kLowestLobe)});
    LobeFit fit = fit_ambient_weight(target, raised, ambient, gram);
    if (direction == LobeDirection::searched)
        search_lobes(std::span(&target, 1), std::span(&start, 1), ambient, gram, std::span(&fit, 1));
    return Lobes{light.irradiance, fit.direction, fit.ambient_weight, ambient};
}

template <class F>
double golden(double low, double high, int steps, F&& f) {
    constexpr double kGolden = 0.6180339887498949;
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low), fa = f(a), fb = f(b);
    for (int i = 0; i < steps; ++i) {
        if (fa < fb) {
            high = b;
            b = a;
            fb = fa;
            a = high - kGolden * (high - low);
            fa = f(a);
        } else {
            low = a;
            a = b;
            fa = fb;
            b = low + kGolden * (high - low);
            fb = f(b);
        }
    }
    return fa < fb ? a : b;
}

// The search that was published, and that the expected figures come from: golden section over the polar angle within
// golden section over the azimuth, 60 degrees to either side of the optimal linear direction.
template <class Error>
Vec3 nested_search(Vec3 start, Error&& error) {
    constexpr double kThird = 1.0471975511965976;
    const double widest = std::acos(static_cast<double>(kLowestLobe));
    const double azimuth = std::atan2(static_cast<double>(start.y), static_cast<double>(start.x));
    const auto direction = [](double theta, double phi) {
        return Vec3{static_cast<float>(std::sin(theta) * std::cos(phi)),
                    static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
    };
    const auto best_at = [&](double phi) {
        return golden(0, widest, 24, [&](double t) { return error(direction(t, phi)); });
    };
    const double phi =
        golden(azimuth - kThird, azimuth + kThird, 14, [&](double p) { return error(direction(best_at(p), p)); });
    return direction(best_at(phi), phi);
}

// The same with true clamped cosines instead of three bands.
class ExactLobes {
public:
    // Of luminance, or of one channel.
    ExactLobes(const EncodingCase& c, AmbientLobe ambient, std::size_t channel = 3) : ambient_(ambient) {
        const auto value = [&](const Vec3& v) { return channel < 3 ? v[channel] : luminance(v); };
        const float iz = value(c.light.irradiance);
        for (const Vec3d& t : c.truth)
            target_.push_back(static_cast<double>(
                value(Vec3{static_cast<float>(t[0]), static_cast<float>(t[1]), static_cast<float>(t[2])}) / iz));
    }
    // Best weight and its error.
    [[nodiscard]] std::array<double, 2> fit(Vec3 d) const {
        double uu = 0, ur = 0;
        for (std::size_t k = 0; k < target_.size(); ++k) {
            const auto [ambient, lobe] = values(k, d);
            uu += hemisphere_normals().weight[k] * (ambient - lobe) * (ambient - lobe);
            ur += hemisphere_normals().weight[k] * (ambient - lobe) * (target_[k] - lobe);
        }
        const double w = uu > 1e-12 ? std::clamp(ur / uu, 0.0, 1.0) : 1.0;
        double error = 0;  // with weight 1 the same number for every direction
        for (std::size_t k = 0; k < target_.size(); ++k) {
            const auto [ambient, lobe] = values(k, d);
            const double e = w * ambient + (1 - w) * lobe - target_[k];
            error += hemisphere_normals().weight[k] * e * e;
        }
        return {w, error};
    }

private:
    [[nodiscard]] std::array<double, 2> values(std::size_t k, Vec3 d) const {
        const Vec3 n = hemisphere_normals().normal[k];
        const float ambient = ambient_ == AmbientLobe::uniform ? 1.0f : 0.5f * (1 + n.z);
        return {static_cast<double>(ambient), static_cast<double>(std::max(dot(n, d), 0.0f) / d.z)};
    }

    AmbientLobe ambient_;
    std::vector<double> target_;
};

}  // namespace

EncodingModel lobes(AmbientLobe ambient, const ZonalMatrix& gram, LobeDirection direction) {
    return [=](const EncodingCase& c) { return lobes_of(c.light, ambient, gram, direction); };
}

EncodingModel nested_lobes(AmbientLobe ambient, const ZonalMatrix& gram) {
    return [=](const EncodingCase& c) -> Decoded {
        const std::array<float, 9> target = luminance_target(c.light);
        const Vec3 d = nested_search(linear_direction_of(c.light), [&](Vec3 at) {
            return static_cast<double>(fit_ambient_weight(target, at, ambient, gram).error);
        });
        return Lobes{c.light.irradiance, d, fit_ambient_weight(target, d, ambient, gram).ambient_weight, ambient};
    };
}

EncodingModel exact_lobes(AmbientLobe ambient, LobeWeights weights) {
    return [=](const EncodingCase& c) -> Decoded {
        const ExactLobes exact(c, ambient);
        const Vec3 d = nested_search(linear_direction_of(c.light), [&](Vec3 at) { return exact.fit(at)[1]; });
        Vec3 w = Vec3{1, 1, 1} * static_cast<float>(exact.fit(d)[0]);
        if (weights == LobeWeights::rgb)
            for (std::size_t i = 0; i < 3; ++i) w[i] = static_cast<float>(ExactLobes(c, ambient, i).fit(d)[0]);
        return [=, iz = c.light.irradiance](Vec3 n) {
            const float a = ambient == AmbientLobe::uniform ? 1.0f : 0.5f * (1 + n.z);
            const float lobe = std::max(dot(n, d), 0.0f) / d.z;
            return iz * (w * (a - lobe) + Vec3{1, 1, 1} * lobe);
        };
    };
}

Decoded hhd_closed(const EncodingCase& c) {
    const RadianceSh<float, 9> l = luminance(c.light.radiance);
    const Hhd hhd = solve_hhd(light_moments({l.c[0], l.c[1], l.c[2], l.c[3]}));
    return
        [hhd, color = c.light.irradiance / luminance(c.light.irradiance)](Vec3 n) { return color * evaluate(hhd, n); };
}

}  // namespace lumel::bench
