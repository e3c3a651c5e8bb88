#include "path/pooled_variance.h"

#include <algorithm>
#include <vector>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"

namespace lumel {
namespace {

constexpr int kRadius = 3;  // of the neighbourhood, in texels

Vec3 pooled(const TexelBuffer& texels, const RadianceSums& sums, std::size_t i) {
    Vec3 shown{}, stated{};
    float count = 0.0f;
    for (int dy = -kRadius; dy <= kRadius; ++dy)
        for (int dx = -kRadius; dx <= kRadius; ++dx) {
            const std::uint32_t j = texels.at(texels.x[i] + dx, texels.y[i] + dy);
            if (j == kNone || !texels.on_one_surface(i, j) || !sums.valid(j) || sums.count[j] < 2) continue;
            const Vec3 d = sums.half_difference[j];
            shown += d * d * 0.25f;
            stated += sums.variance[j];
            count += 1.0f;
        }
    // Student's t over the normal quantile at 97.5 %, within 3 % from two differences on: few say less.
    const float t = 1.0f + 1.21f / count + 2.2f / (count * count);
    // A texel that rare light has missed states too little: half of it is taken from the others.
    Vec3 out = sums.variance[i];
    for (std::size_t c = 0; c < 3; ++c)
        if (stated[c] > 0.0f) out[c] = 0.5f * (out[c] + stated[c] / count) * (shown[c] / stated[c]) * t * t;
    return out;
}

}  // namespace

Status pool_variance(const TexelBuffer& texels, RadianceSums& sums, Context& context) {
    LUMEL_CHECK(sums.size() == texels.size() && texels.chart.size() == texels.size(), sums.size(), texels.size());
    std::vector<Vec3> out(sums.size());
    const bool done = parallel_for(context, sums.size(), 256, [&](const ChunkRange& range) {
        for (std::size_t i = range.begin; i < range.end; ++i)
            out[i] = sums.valid(i) && sums.count[i] > 1 ? pooled(texels, sums, i) : sums.variance[i];
    });
    if (!done) return cancelled_error();
    std::copy(out.begin(), out.end(), sums.variance.begin());
    return success();
}

}  // namespace lumel
