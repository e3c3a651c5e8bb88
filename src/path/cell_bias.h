// What surface cells get wrong, measured in the bake itself: some of its texels are gathered twice, once with paths
// that end at cells and once with paths that go on to the end.
#pragma once

#include <cstddef>
#include <limits>

#include "path/path_integrator.h"
#include "path/texel_blocks.h"
#include "texel/texel_buffer.h"

namespace lumel {

// Over blocks of texels: light with cells less light without, over the latter (luminance of the included layers).
class CellBias {
public:
    // The mean light of one block, which stands for so many texels.
    void add(double with_cells, double without, double texels);

    // NaN: not measured, or there is no light.
    [[nodiscard]] double relative() const;
    // Of that, by how much blocks differ; NaN below two blocks. Both times a block is gathered its first rays are the
    // same, so that most of what is left is the noise of the paths beyond the cells.
    [[nodiscard]] double standard_error() const;

private:
    double blocks_ = 0.0;
    double difference_ = 0.0, light_ = 0.0;  // sums
    double difference_squares_ = 0.0, light_squares_ = 0.0, products_ = 0.0;
};

// What it costs, in the time of gathering the page.
inline constexpr double kCellBiasWork = 0.03;

// Adds a page, of which it looks at as many texels as that allows: one in 42 at 256 samples, but 256 at least.
// `transport` has cells. Error: cancelled.
Status measure_cell_bias(const TexelBuffer& texels, const ChartSet& charts, const Atlas& atlas,
                         const Transport& transport, const PathOptions& options, CellBias& bias, Context& context);

}  // namespace lumel
