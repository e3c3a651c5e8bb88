#include "path/cell_bias.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/progress_parts.h"
#include "base/try.h"
#include "lumel/vec.h"
#include "path/gather_page.h"

namespace lumel {
namespace {

constexpr std::uint32_t kSamples = 64;
constexpr std::size_t kFewestTexels = 256;  // a tenth of a second
constexpr double kPathWork = 4.0;           // time of a path to its end, in that of one to the next cell

// Of the valid texels [begin, end), luminance.
struct BlockLight {
    double sum = 0.0, texels = 0.0;
};
BlockLight light_of(const RadianceSums& sums, std::size_t begin, std::size_t end, const PathOptions& options) {
    BlockLight out;
    for (std::size_t i = begin; i < end; ++i) {
        if (!sums.valid(i)) continue;
        out.texels += 1.0;
        for (std::size_t l = 0; l < kLayerCount; ++l)
            if (options.included[l]) out.sum += static_cast<double>(luminance(sums.layers[i][l].irradiance));
    }
    return out;
}

}  // namespace

void CellBias::add(double with_cells, double without, double texels) {
    const double difference = (with_cells - without) * texels, light = without * texels;
    blocks_ += 1.0;
    difference_ += difference;
    light_ += light;
    difference_squares_ += difference * difference;
    light_squares_ += light * light;
    products_ += difference * light;
}

double CellBias::relative() const {
    return light_ > 0.0 ? difference_ / light_ : std::numeric_limits<double>::quiet_NaN();
}

// Of a ratio of sums (Cochran 1977, ch. 6): by the residuals d - R l.
double CellBias::standard_error() const {
    const double ratio = relative();
    if (blocks_ < 2.0 || std::isnan(ratio)) return std::numeric_limits<double>::quiet_NaN();
    const double residuals =
        std::max(0.0, difference_squares_ - 2.0 * ratio * products_ + ratio * ratio * light_squares_);
    return std::sqrt(residuals * blocks_ / (blocks_ - 1.0)) / light_;
}

Status measure_cell_bias(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
                         const Transport& transport, const PathOptions& options, CellBias& bias, Context& context) {
    LUMEL_CHECK(transport.cells);
    PathOptions same = options;
    same.samples = std::min(kSamples, options.samples);
    const double paths = kCellBiasWork * static_cast<double>(texels.size()) * options.samples;
    const auto wanted = static_cast<std::size_t>(paths / ((1.0 + kPathWork) * same.samples));
    const TexelBlocks blocks =
        spread_blocks(make_texel_blocks(texels, 0, texels.size()), std::max(wanted, kFewestTexels));
    // Small pages give more of their texels than large ones.
    const double texels_per_measured =
        static_cast<double>(texels.size()) / static_cast<double>(std::max<std::size_t>(1, blocks.texels.size()));
    same.stop = StopRule::fixed;
    same.guided = same.lights_learned = false;
    Transport to_the_end = transport;
    to_the_end.cells = nullptr;
    ProgressParts progress(context, "trace", 1.0 + kPathWork);
    progress.begin(1.0);
    LUMEL_TRY(const RadianceSums with_cells, gather_blocks(blocks, texels, charts, atlas, transport, same, context));
    progress.begin(kPathWork);
    LUMEL_TRY(const RadianceSums without, gather_blocks(blocks, texels, charts, atlas, to_the_end, same, context));
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const BlockLight a = light_of(with_cells, blocks.first[b], blocks.first[b + 1], options);
        const BlockLight e = light_of(without, blocks.first[b], blocks.first[b + 1], options);
        if (e.texels > 0.0 && a.texels > 0.0)
            bias.add(a.sum / a.texels, e.sum / e.texels, e.texels * texels_per_measured);
    }
    return success();
}

}  // namespace lumel
