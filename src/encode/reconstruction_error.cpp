#include "encode/reconstruction_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "encode/hemisphere_fit.h"

namespace lumel {
namespace {

constexpr std::size_t kRings = 6, kSteps = 12;

struct Normals {
    HemisphereGrid grid = hemisphere_grid(kRings, kSteps);
    std::vector<std::array<float, 9>> weights = irradiance_weights(grid.normal);
};
const Normals& normals() {
    static const Normals kNormals;
    return kNormals;
}

double squared(Vec3 v) {  // of floats whose squares may be none
    const auto x = static_cast<double>(v.x), y = static_cast<double>(v.y), z = static_cast<double>(v.z);
    return x * x + y * y + z * z;
}
double sum(Vec3 v) { return static_cast<double>(v.x) + static_cast<double>(v.y) + static_cast<double>(v.z); }

// What is no number is no small error either, and cannot be sorted.
double or_infinity(double error) { return std::isfinite(error) ? error : std::numeric_limits<double>::infinity(); }

// I about each normal of the grid.
std::vector<Vec3> reference(const TexelLight& light) {
    std::vector<Vec3> out;
    for (const std::array<float, 9>& w : normals().weights) out.push_back(dot_coefficients(w, light.radiance.c));
    return out;
}

// Sums of squared errors and of what is true, weighted over the normals.
struct Sums {
    double error = 0.0, truth = 0.0;
};
Sums compare(const Encoding& encoding, const Numbers& numbers, const std::vector<Vec3>& truth) {
    Sums out;
    const HemisphereGrid& grid = normals().grid;
    for (std::size_t k = 0; k < truth.size(); ++k) {
        out.error += grid.weight[k] * squared(encoding.decode(numbers, grid.normal[k]) - truth[k]);
        out.truth += grid.weight[k] * sum(truth[k]);
    }
    constexpr double kArea = 3 * 2 * std::numbers::pi;  // three channels
    out.error = or_infinity(out.error / kArea);
    out.truth /= kArea;
    return out;
}

bool is_between(Vec3 v, Vec3 a, Vec3 b) {
    for (std::size_t c = 0; c < 3; ++c) {
        const float low = std::min(a[c], b[c]), high = std::max(a[c], b[c]);
        const float slack = 0.01f * std::max(std::fabs(low), std::fabs(high));
        if (!(v[c] >= low - slack && v[c] <= high + slack) || !std::isfinite(slack)) return false;
    }
    return true;
}

}  // namespace

std::vector<Numbers> solve_for_files(const Encoding& encoding, std::span<const TexelLight> light,
                                     std::span<const Rotation> frames) {
    std::vector<Numbers> out(light.size());
    encoding.solve(light, out);
    for (std::size_t i = 0; i < out.size() && encoding.rotate; ++i) encoding.rotate(out[i], transposed(frames[i]));
    return out;
}

ReconstructionError measure(const Encoding& encoding, Storage storage, const MeasuredTexels& texels) {
    std::vector<Numbers> stored = solve_for_files(encoding, texels.light, texels.frame);
    for (Numbers& numbers : stored) quantise(encoding, storage, numbers);
    return measure(encoding, stored, texels);
}

ReconstructionError measure(const Encoding& encoding, std::span<const Numbers> stored, const MeasuredTexels& texels) {
    const std::size_t n = texels.light.size();
    ReconstructionError out;
    if (n == 0) return out;
    const auto local = [&](Numbers numbers, std::size_t i) {
        if (encoding.rotate) encoding.rotate(numbers, texels.frame[i]);
        return numbers;
    };
    std::vector<Sums> sums(n);
    double error = 0.0, truth = 0.0, at_normal = 0.0, irradiance = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const Numbers numbers = local(stored[i], i);
        sums[i] = compare(encoding, numbers, reference(texels.light[i]));
        error += sums[i].error;
        truth += sums[i].truth;
        at_normal += squared(encoding.decode(numbers, {0, 0, 1}) - texels.light[i].irradiance) / 3;
        irradiance += sum(texels.light[i].irradiance) / 3;
    }
    const auto count = static_cast<double>(n);
    const double mean = truth / count;
    if (mean == 0.0) return out;
    // Without light to measure by, or with less than none, every error is too large.
    const auto relative_to = [](double size, double light) { return or_infinity(light > 0.0 ? size / light : NAN); };
    std::vector<double> relative;
    relative.reserve(sums.size());
    for (const Sums& s : sums)
        relative.push_back(relative_to(std::sqrt(s.error), std::max(s.truth, 0.0) + 0.01 * mean));
    std::ranges::sort(relative);
    out.nrmse = relative_to(std::sqrt(error / count), mean);
    out.p99 = relative[static_cast<std::size_t>(0.99 * (count - 1))];
    out.worst = relative.back();
    if (irradiance != 0.0) out.at_normal = relative_to(std::sqrt(at_normal / count), irradiance / count);

    std::size_t outside = 0;
    double between = 0.0;
    for (const auto& [a, b] : texels.neighbours) {
        const Numbers middle = local(detail::blend_numbers(stored[a], 0.5f, stored[b], 0.5f), a);
        std::vector<Vec3> expected = reference(texels.light[a]);
        const std::vector<Vec3> other = reference(texels.light[b]);
        for (std::size_t k = 0; k < expected.size(); ++k) expected[k] = (expected[k] + other[k]) * 0.5f;
        between += compare(encoding, middle, expected).error;
        const auto at = [&](const Numbers& numbers) { return encoding.decode(numbers, {0, 0, 1}); };
        if (!is_between(at(middle), at(local(stored[a], a)), at(local(stored[b], b)))) ++outside;
    }
    if (!texels.neighbours.empty()) {
        const auto pairs = static_cast<double>(texels.neighbours.size());
        out.between = relative_to(std::sqrt(between / pairs), mean);
        out.outside = static_cast<double>(outside) / pairs;
    }
    return out;
}

}  // namespace lumel
