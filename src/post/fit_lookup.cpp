// Based on: Kavan, Bargteil, Sloan 2011, "Least Squares Vertex Baking" (values chosen for what their interpolation
// shows, not as samples). Here the unknowns are corrections of texels, damped, and the equations are texels' means.
#include "post/fit_lookup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/cancelled.h"
#include "base/check.h"

namespace lumel {
namespace {

// What a lookup at a texel's points takes from the 3 x 3 texels around it, row by row.
using Row = std::array<float, 9>;
constexpr std::size_t kSelf = 4;

Row lookup_at(Vec2 point) {
    const float x = point.x - 0.5f, y = point.y - 0.5f;
    const std::array<float, 3> across{std::max(0.0f, -x), 1.0f - std::fabs(x), std::max(0.0f, x)};
    const std::array<float, 3> down{std::max(0.0f, -y), 1.0f - std::fabs(y), std::max(0.0f, y)};
    Row row;
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = across[k % 3] * down[k / 3];
    return row;
}

Row mean_lookup(std::uint64_t valid) {
    Row sum{};
    float count = 0.0f;
    for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
        if (((valid >> s) & 1u) == 0) continue;
        const Row row = lookup_at(gather_point(valid, s));
        for (std::size_t k = 0; k < row.size(); ++k) sum[k] += row[k];
        count += 1.0f;
    }
    if (count == 0.0f) return lookup_at({0.5f, 0.5f});
    for (float& share : sum) share /= count;
    return sum;
}

using Values = std::vector<float>;

double squared_norm(const Values& values) {
    double sum = 0.0;
    for (const float v : values) sum += static_cast<double>(v) * static_cast<double>(v);
    return sum;
}

// The equations of a page: one for each texel that was baked, in as many unknowns as there are texels.
class LookupFit {
public:
    LookupFit(const TexelBuffer& buffer, const Lightmap& map) : buffer_(buffer), map_(map), rows_(buffer.size()) {
        const Row whole = mean_lookup(~std::uint64_t{0});
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            if (map.coverage[i] != Coverage::baked) continue;
            const std::uint64_t valid = buffer.valid[i];
            rows_[i] = ~valid == 0 ? whole : mean_lookup(valid);
            for (std::size_t k = 0; k < rows_[i].size(); ++k) {
                if (k == kSelf || neighbour(i, k) != i) continue;
                rows_[i][kSelf] += rows_[i][k];
                rows_[i][k] = 0.0f;
            }
        }
    }

    // Corrections of `values` by conjugate gradients on the damped normal equations. Empty: cancelled.
    [[nodiscard]] Values corrections(const Values& values, const FitOptions& options, const Context& context) const {
        Values residual(rows_.size()), image(rows_.size());
        Values x(values.size()), gradient(values.size()), direction;
        look_up(values, residual);
        for (std::size_t i = 0; i < rows_.size(); ++i)
            residual[i] = map_.coverage[i] == Coverage::baked ? values[i] - residual[i] : 0.0f;
        spread(residual, gradient);
        direction = gradient;
        double size = squared_norm(gradient);
        const double small = 1e-10 * size;
        for (std::uint32_t k = 0; k < options.iterations && size > small; ++k) {
            if (context.cancelled()) return {};
            look_up(direction, image);
            const double curvature =
                squared_norm(image) + static_cast<double>(options.damping) * squared_norm(direction);
            const auto step = static_cast<float>(size / curvature);
            for (std::size_t i = 0; i < x.size(); ++i) x[i] += step * direction[i];
            for (std::size_t i = 0; i < residual.size(); ++i) residual[i] -= step * image[i];
            spread(residual, gradient);
            for (std::size_t i = 0; i < x.size(); ++i) gradient[i] -= options.damping * x[i];
            const double next = squared_norm(gradient);
            const auto turn = static_cast<float>(next / size);
            for (std::size_t i = 0; i < x.size(); ++i) direction[i] = gradient[i] + turn * direction[i];
            size = next;
        }
        return x;
    }

private:
    // The texel of the same chart there, else the texel itself: what lies beyond the chart is taken to be as it is.
    [[nodiscard]] std::size_t neighbour(std::size_t i, std::size_t k) const {
        const std::int64_t x = std::int64_t{buffer_.x[i]} + static_cast<std::int64_t>(k % 3) - 1;
        const std::int64_t y = std::int64_t{buffer_.y[i]} + static_cast<std::int64_t>(k / 3) - 1;
        if (x < 0 || y < 0 || x >= map_.width || y >= map_.height) return i;
        const std::uint32_t j = map_.texel_at[static_cast<std::size_t>(y) * map_.width + static_cast<std::size_t>(x)];
        return j != kNone && map_.chart[j] == map_.chart[i] && map_.coverage[j] != Coverage::none ? j : i;
    }

    // What the points of each texel look up.
    void look_up(const Values& values, Values& out) const {
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            float sum = 0.0f;
            for (std::size_t k = 0; k < 9; ++k)
                if (rows_[i][k] != 0.0f) sum += rows_[i][k] * values[neighbour(i, k)];
            out[i] = sum;
        }
    }

    // The transpose.
    void spread(const Values& values, Values& out) const {
        std::fill(out.begin(), out.end(), 0.0f);
        for (std::size_t i = 0; i < rows_.size(); ++i)
            for (std::size_t k = 0; k < 9; ++k)
                if (rows_[i][k] != 0.0f) out[neighbour(i, k)] += rows_[i][k] * values[i];
    }

    const TexelBuffer& buffer_;
    const Lightmap& map_;
    std::vector<Row> rows_;  // zero where there is no equation
};

// One layer and channel after the other, for the sake of memory. False: cancelled.
bool fit_layer(const LookupFit& fit, const FitOptions& options, std::size_t layer, RadianceSums& sums,
               const Context& context) {
    Values values(sums.size());
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = sums.layers[i][layer].irradiance[c];
        const Values x = fit.corrections(values, options, context);
        if (x.empty() && !values.empty()) return false;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!(values[i] > 0.0f)) continue;
            const float gain = std::clamp((values[i] + x[i]) / values[i], options.least, options.most);
            LayerMoments& light = sums.layers[i][layer];
            light.irradiance[c] *= gain;
            for (Vec3& coefficient : light.sh) coefficient[c] *= gain;
        }
    }
    return true;
}

}  // namespace

Status fit_to_lookup(const TexelBuffer& buffer, const FitOptions& options, Lightmap& map, Context& context) {
    LUMEL_CHECK(buffer.valid.size() == buffer.size() && map.texels.size() >= buffer.size(), buffer.size(),
                map.texels.size());
    const LookupFit fit(buffer, map);
    for (std::size_t layer = 0; layer < kLayerCount; ++layer) {
        if (!fit_layer(fit, options, layer, map.texels, context)) return cancelled_error();
        context.report("fit", static_cast<double>(layer + 1) / static_cast<double>(kLayerCount));
    }
    return success();
}

}  // namespace lumel
