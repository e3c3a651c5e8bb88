#include "encode/lobe_search.h"

#include <algorithm>
#include <cmath>

namespace lumel {
namespace {

constexpr float kBand1 = kCosineBands[1], kBand2 = kCosineBands[2];

std::array<float, 9> ambient_coefficients(AmbientLobe ambient) {
    constexpr float kSqrtPi = 1.7724538509055160f, kSqrt3Pi = 3.0699801238394655f;
    if (ambient == AmbientLobe::uniform) return {2.0f * kSqrtPi};
    return {kSqrtPi, 0.0f, kSqrt3Pi / 3.0f};
}

std::array<float, 9> lobe_coefficients(Vec3 d) {
    const ShBasis y = sh_basis(d);
    std::array<float, 9> out;
    for (std::size_t i = 0; i < 9; ++i) out[i] = kPi / d.z * kCosineBands[band_of(i)] * y[i];
    return out;
}

// By value: references keep the compiler from turning it into a minimum and a maximum.
float limited(float v, float low, float high) {
    const float up = v > low ? v : low;
    return up < high ? up : high;
}

// Texels that are searched side by side: the compiler turns the loops over them into vector instructions.
constexpr std::size_t kLanes = 16;
using Lane = std::array<float, kLanes>;

// With D the lobe and <,> the inner product: <a, D> and <D, D> depend on z = d_z alone, and <i, D> on the azimuth as
// pi/z (p0 + p1 z + p2 (3 z^2 - 1) + s (cos (c0 + c1 z) + sin (s0 + s1 z)) + s^2 (cos2 c2 + sin2 s2)), s^2 = 1 - z^2.
struct Targets {
    Lane ii, ai, p0, p1, p2, c0, c1, s0, s1, c2, s2;
};
struct Model {
    float aa, a0, a1, a2;                          // <a, a>; <a, D> = pi/z (a0 + a1 z + a2 (3 z^2 - 1))
    float d00, d11, d22, d02, d12, t0, t1, t2, q;  // <D, D>, by orders m = 0, 1, 2
};

Model model_of(AmbientLobe ambient, const ZonalMatrix& gram) {
    const std::array<float, 9> a = ambient_coefficients(ambient), ga = multiply(gram, a);
    Model m{};
    m.aa = dot_coefficients(a, ga);
    m.a0 = ga[0] * kSh0;
    m.a1 = ga[2] * kBand1 * kSh1;
    m.a2 = ga[6] * kBand2 * kSh20;
    m.d00 = gram.m00 * kSh0 * kSh0;
    m.d11 = gram.m22 * kBand1 * kBand1 * kSh1 * kSh1;
    m.d22 = gram.m66 * kBand2 * kBand2 * kSh20 * kSh20;
    m.d02 = 2.0f * gram.m02 * kBand1 * kSh0 * kSh1;
    m.d12 = 2.0f * gram.m26 * kBand1 * kBand2 * kSh1 * kSh20;
    m.t0 = gram.m11 * kBand1 * kBand1 * kSh1 * kSh1;
    m.t1 = 2.0f * gram.m15 * kBand1 * kBand2 * kSh1 * kSh2;
    m.t2 = gram.m55 * kBand2 * kBand2 * kSh2 * kSh2;
    m.q = gram.m44 * kBand2 * kBand2 * kSh22 * kSh22;
    return m;
}

void load(const std::array<float, 9>& target, const std::array<float, 9>& a, const ZonalMatrix& gram, std::size_t lane,
          Targets& out) {
    const std::array<float, 9> g = multiply(gram, target);
    out.ii[lane] = dot_coefficients(target, g);
    out.ai[lane] = dot_coefficients(a, g);
    out.p0[lane] = g[0] * kSh0;
    out.p1[lane] = g[2] * kBand1 * kSh1;
    out.p2[lane] = g[6] * kBand2 * kSh20;
    out.c0[lane] = -g[3] * kBand1 * kSh1;
    out.c1[lane] = -g[7] * kBand2 * kSh2;
    out.s0[lane] = -g[1] * kBand1 * kSh1;
    out.s1[lane] = -g[5] * kBand2 * kSh2;
    out.c2[lane] = g[8] * kBand2 * kSh22;
    out.s2[lane] = g[4] * kBand2 * kSh22;
}

// A step of Newton's method for the azimuth (cosine, sine) at the polar angle 2 arctan(h), then the error there with
// the best weight.
void evaluate_lobes(const Targets& targets, const Model m, const Lane& at, Lane& cosines, Lane& sines, Lane& errors) {
    constexpr float kLongestStep = 0.7f;
    // None of them overlaps, which the compiler would have to check.
    const Targets& __restrict t = targets;
    const float* const __restrict h = at.data();
    float *const __restrict cosine = cosines.data(), *const __restrict sine = sines.data(),
                 *const __restrict error = errors.data();
    for (std::size_t l = 0; l < kLanes; ++l) {
        const float per = 1.0f / (1.0f + h[l] * h[l]), z = (1.0f - h[l] * h[l]) * per, s = 2.0f * h[l] * per;
        const float z2 = z * z, s2 = s * s, q = 3.0f * z2 - 1.0f;
        const float a = s * (t.c0[l] + t.c1[l] * z), b = s * (t.s0[l] + t.s1[l] * z);
        const float c = s2 * t.c2[l], d = s2 * t.s2[l];
        float x = cosine[l], y = sine[l];
        const float cos2 = x * x - y * y, sin2 = 2.0f * x * y;
        const float slope = b * x - a * y + 2.0f * (d * cos2 - c * sin2);
        const float bend = a * x + b * y + 4.0f * (c * cos2 + d * sin2);  // minus the second derivative
        // Uphill by Newton where the curve bends down, else as far as it may.
        const float size = std::fabs(bend);
        const float step = slope / (size > 1e-20f ? size : 1e-20f);
        const float far = slope > 0.0f ? kLongestStep : -kLongestStep;
        const float turn = bend > 0.0f ? limited(step, -kLongestStep, kLongestStep) : far;
        // A rotation by 2 arctan(turn/2), which is nearly that.
        const float half = 0.5f * turn, scale = 1.0f / (1.0f + half * half);
        const float rc = (1.0f - half * half) * scale, rs = turn * scale;
        const float x1 = x * rc - y * rs, y1 = y * rc + x * rs;
        x = x1;
        y = y1;
        cosine[l] = x;
        sine[l] = y;

        const float k = kPi / z;
        const float id =
            k * (t.p0[l] + t.p1[l] * z + t.p2[l] * q + a * x + b * y + c * (x * x - y * y) + d * 2.0f * x * y);
        const float ad = k * (m.a0 + m.a1 * z + m.a2 * q);
        const float dd = k * k *
                         (m.d00 + m.d11 * z2 + m.d22 * q * q + m.d02 * z + m.d12 * z * q +
                          s2 * (m.t0 + m.t1 * z + m.t2 * z2) + s2 * s2 * m.q);
        const float uu = m.aa - 2.0f * ad + dd, ur = t.ai[l] - ad - id + dd, rr = t.ii[l] - 2.0f * id + dd;
        const float w = limited(ur / (uu > 1e-12f ? uu : 1e-12f), 0.0f, 1.0f);
        error[l] = rr + w * (w * uu - 2.0f * ur);
    }
}

struct Best {
    Lane h, cosine, sine, error;
};

// The best of a few polar angles, then golden-section search between its neighbours, over h, the tangent of half the
// polar angle; the azimuth follows.
Best search(const Targets& t, const Model& m, const Lane& start_x, const Lane& start_y) {
    constexpr float kGolden = 0.61803399f;
    constexpr float kWidest = 0.951189731f;  // sqrt((1 - kLowestLobe)/(1 + kLowestLobe))
    constexpr int kScan = 4, kSteps = 9;     // leaves a bracket of 6e-3, 0.7 degrees
    constexpr float kSpacing = kWidest / kScan;
    Lane h, x = start_x, y = start_y, e;
    h.fill(0.5f * kSpacing);
    evaluate_lobes(t, m, h, x, y, e);  // turns towards the best azimuth
    h.fill(0.0f);
    evaluate_lobes(t, m, h, x, y, e);
    Best best{h, x, y, e};
    const auto keep_better = [&best](const Lane& new_h, const Lane& new_x, const Lane& new_y, const Lane& new_e) {
        for (std::size_t l = 0; l < kLanes; ++l) {
            const bool better = new_e[l] < best.error[l];
            best.h[l] = better ? new_h[l] : best.h[l];
            best.cosine[l] = better ? new_x[l] : best.cosine[l];
            best.sine[l] = better ? new_y[l] : best.sine[l];
            best.error[l] = better ? new_e[l] : best.error[l];
        }
    };
    for (int k = 1; k <= kScan; ++k) {
        h.fill(kSpacing * static_cast<float>(k));
        evaluate_lobes(t, m, h, x, y, e);
        keep_better(h, x, y, e);
    }
    Lane low, high, h1, h2, x1 = best.cosine, y1 = best.sine, e1, e2;
    for (std::size_t l = 0; l < kLanes; ++l) {
        const float below = best.h[l] - kSpacing, above = best.h[l] + kSpacing;
        low[l] = below > 0.0f ? below : 0.0f;
        high[l] = above < kWidest ? above : kWidest;
        h1[l] = high[l] - kGolden * (high[l] - low[l]);
        h2[l] = low[l] + kGolden * (high[l] - low[l]);
    }
    Lane x2 = x1, y2 = y1;
    evaluate_lobes(t, m, h1, x1, y1, e1);
    evaluate_lobes(t, m, h2, x2, y2, e2);
    for (int step = 0; step < kSteps; ++step) {
        for (std::size_t l = 0; l < kLanes; ++l) {
            const bool left = e1[l] < e2[l];
            high[l] = left ? h2[l] : high[l];
            low[l] = left ? low[l] : h1[l];
            h[l] = left ? high[l] - kGolden * (high[l] - low[l]) : low[l] + kGolden * (high[l] - low[l]);
            x[l] = left ? x1[l] : x2[l];
            y[l] = left ? y1[l] : y2[l];
        }
        evaluate_lobes(t, m, h, x, y, e);
        for (std::size_t l = 0; l < kLanes; ++l) {
            const bool left = e1[l] < e2[l];
            const float keep_h = left ? h1[l] : h2[l], keep_x = left ? x1[l] : x2[l], keep_y = left ? y1[l] : y2[l];
            const float keep_e = left ? e1[l] : e2[l];
            h1[l] = left ? h[l] : keep_h;
            x1[l] = left ? x[l] : keep_x;
            y1[l] = left ? y[l] : keep_y;
            e1[l] = left ? e[l] : keep_e;
            h2[l] = left ? keep_h : h[l];
            x2[l] = left ? keep_x : x[l];
            y2[l] = left ? keep_y : y[l];
            e2[l] = left ? keep_e : e[l];
        }
    }
    keep_better(h1, x1, y1, e1);
    keep_better(h2, x2, y2, e2);
    return best;
}

}  // namespace

Vec3 lifted(Vec3 direction) {
    if (direction.z >= kLowestLobe) return normalize(direction);
    const float level = std::sqrt(direction.x * direction.x + direction.y * direction.y);
    if (!(level > 0.0f)) return {0, 0, 1};
    const float scale = std::sqrt(1.0f - kLowestLobe * kLowestLobe) / level;
    return {direction.x * scale, direction.y * scale, kLowestLobe};
}

LobePair::LobePair(Vec3 direction, AmbientLobe ambient, const ZonalMatrix& gram)
    : ambient_(ambient_coefficients(ambient)), lobe_(lobe_coefficients(direction)) {
    std::array<float, 9> difference;
    for (std::size_t i = 0; i < 9; ++i) difference[i] = ambient_[i] - lobe_[i];
    product_ = multiply(gram, difference);
    const float squared = dot_coefficients(difference, product_);
    constexpr float kSame = 1e-6f;  // a lobe that is the ambient light
    if (squared > kSame) inverse_ = 1.0f / squared;
    lobe_product_ = dot_coefficients(lobe_, product_);
}

float LobePair::ambient_weight(const std::array<float, 9>& target) const {
    if (inverse_ == 0.0f) return 1.0f;
    return limited((dot_coefficients(target, product_) - lobe_product_) * inverse_, 0.0f, 1.0f);
}

LobeFit fit_ambient_weight(const std::array<float, 9>& target, Vec3 direction, AmbientLobe ambient,
                           const ZonalMatrix& gram) {
    const LobePair pair(direction, ambient, gram);
    LobeFit out{direction, pair.ambient_weight(target), 0.0f};
    // With weight 1 the error is the same number for every direction.
    const float w = out.ambient_weight;
    std::array<float, 9> r;
    for (std::size_t i = 0; i < 9; ++i) r[i] = w * pair.ambient()[i] + (1.0f - w) * pair.lobe()[i] - target[i];
    out.error = dot_coefficients(r, multiply(gram, r));
    return out;
}

void search_lobes(std::span<const std::array<float, 9>> targets, std::span<const Vec3> start, AmbientLobe ambient,
                  const ZonalMatrix& gram, std::span<LobeFit> out) {
    const Model model = model_of(ambient, gram);
    const std::array<float, 9> a = ambient_coefficients(ambient);
    for (std::size_t first = 0; first < targets.size(); first += kLanes) {
        const std::size_t count = std::min(kLanes, targets.size() - first);
        Targets lanes;
        Lane x, y;
        for (std::size_t l = 0; l < kLanes; ++l) {
            const std::size_t i = first + std::min(l, count - 1);  // those that are too many repeat the last
            load(targets[i], a, gram, l, lanes);
            const float r = std::sqrt(start[i].x * start[i].x + start[i].y * start[i].y);
            x[l] = r > 1e-6f ? start[i].x / r : 1.0f;
            y[l] = r > 1e-6f ? start[i].y / r : 0.0f;
        }
        const Best best = search(lanes, model, x, y);
        for (std::size_t l = 0; l < count; ++l) {
            const float h = best.h[l], per = 1.0f / (1.0f + h * h), s = 2.0f * h * per;
            const Vec3 d{s * best.cosine[l], s * best.sine[l], (1.0f - h * h) * per};
            out[first + l] = fit_ambient_weight(targets[first + l], d, ambient, gram);
        }
    }
}

Vec2 to_hemi_octahedral(Vec3 d) {
    const float sum = std::fabs(d.x) + std::fabs(d.y) + d.z, x = d.x / sum, y = d.y / sum;
    return {0.5f + 0.5f * (x + y), 0.5f + 0.5f * (x - y)};
}

Vec3 from_hemi_octahedral(Vec2 uv) {
    const float a = 2.0f * uv.x - 1.0f, b = 2.0f * uv.y - 1.0f, x = 0.5f * (a + b), y = 0.5f * (a - b);
    return normalize_or(Vec3{x, y, 1.0f - std::fabs(x) - std::fabs(y)}, Vec3{0, 0, 1});
}

}  // namespace lumel
