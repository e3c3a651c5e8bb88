// The encoder of BC4: least squares along the one axis, then the neighbouring end points.
// Based on: Khronos Data Format Specification 1.3, section "BC4 unsigned".
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bc/bc4.h"
#include "bc/block_image.h"
#include "bc/subset_fit.h"

namespace lumel {
namespace {

using namespace bc;

// a > b: seven steps from a to b. a <= b: five, and the codes 0 and 255.
struct Encoded {
    float error = 3e38f;
    int a = 0, b = 0;
};

// The index that comes nearest to a code, and its squared error.
struct Choice {
    unsigned index;
    float error;
};

Choice nearest(float code, int a, int b) {
    const int steps = a > b ? 7 : 5;
    const float from = static_cast<float>(a), length = static_cast<float>(b - a), n = static_cast<float>(steps);
    const float k = length != 0.0f ? std::clamp(std::floor((code - from) / length * n + 0.5f), 0.0f, n) : 0.0f;
    const float distance = code - (from + length * k / n);
    const auto step = static_cast<unsigned>(k);
    Choice out{step == 0 ? 0 : step == static_cast<unsigned>(steps) ? 1 : step + 1, distance * distance};
    if (steps == 7) return out;
    if (code * code < out.error) out = {6, code * code};
    if ((255.0f - code) * (255.0f - code) < out.error) out = {7, (255.0f - code) * (255.0f - code)};
    return out;
}

void keep_if_better(const std::array<float, 16>& codes, const std::array<float, 16>& weights, int a, int b,
                    Encoded& best) {
    float error = 0.0f;
    for (unsigned i = 0; i < kTexels && error < best.error; ++i) error += weights[i] * nearest(codes[i], a, b).error;
    if (error < best.error) best = {error, a, b};
}

// Least squares over the texels between `low` and `high`, and end points up to `reach` away from it.
void search(const std::array<float, 16>& codes, const std::array<float, 16>& weights, float steps, float low,
            float high, int reach, Encoded& best) {
    Lanes x = {}, weight = {};
    for (unsigned i = 0; i < kTexels; ++i) {
        const bool inside = codes[i] >= low && codes[i] <= high;
        weight.set(i, inside ? weights[i] : 0.0f);
        x.set(i, codes[i]);
    }
    Subset<1> subset;
    make_subset(&x, weight, subset);
    EndPair<1> ends;
    fit_ends<Palette::exact>(subset, steps, 3, ends);
    const auto rounded_code = [](float v) { return static_cast<int>(std::clamp(std::floor(v + 0.5f), 0.0f, 255.0f)); };
    const int first = rounded_code(std::min(ends.a[0], ends.b[0])), last = rounded_code(std::max(ends.a[0], ends.b[0]));
    for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j) {
            const int p = std::clamp(first + i, 0, 255), q = std::clamp(last + j, 0, 255);
            if (p > q) continue;
            if (steps == 7.0f && p < q)
                keep_if_better(codes, weights, q, p, best);
            else
                keep_if_better(codes, weights, p, q, best);
        }
}

}  // namespace

BcBlock8 encode_bc4_block(const std::array<float, 16>& codes, const std::array<float, 16>& given, BcQuality quality) {
    const float total = std::accumulate(given.begin(), given.end(), 0.0f);
    if (!(total > 0.0f)) return {};
    std::array<float, 16> weights;
    for (unsigned i = 0; i < kTexels; ++i) weights[i] = given[i] / total;
    const int reach = quality == BcQuality::fast ? 0 : quality == BcQuality::normal ? 1 : 3;
    Encoded best;
    search(codes, weights, 7.0f, 0.0f, 255.0f, reach, best);
    // The codes 0 and 255 come free with five steps: worth a try where texels are near them.
    bool extremes = false;
    for (unsigned i = 0; i < kTexels; ++i) extremes |= weights[i] > 0.0f && (codes[i] < 4.0f || codes[i] > 251.0f);
    if (extremes && quality != BcQuality::fast) search(codes, weights, 5.0f, 4.0f, 251.0f, reach, best);

    BlockWriter writer;
    writer.write(static_cast<std::uint32_t>(best.a), 8);
    writer.write(static_cast<std::uint32_t>(best.b), 8);
    for (unsigned i = 0; i < kTexels; ++i)
        writer.write(weights[i] > 0.0f ? nearest(codes[i], best.a, best.b).index : 0, 3);
    return writer.block8();
}

Result<std::vector<std::uint8_t>> encode_bc4(const Image& image, std::span<const float> weights,
                                             const Bc4Options& options, Context& context) {
    return encode_blocks<8>(image, weights, context, [&](std::uint32_t x, std::uint32_t y) {
        BlockTexels<1> texels;
        load_block(image, weights, x, y, texels);
        return encode_bc4_block(to_codes(texels.value[0]), texels.weight, options.quality);
    });
}

}  // namespace lumel
