#include "path/cell_noise.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "path/light_cells.h"
#include "support/charted_scene.h"

namespace lumel {
namespace {

double of_all(const Vec3& v) { return double{v.x} + double{v.y} + double{v.z}; }

// The truth: the same paths of the texels into cells by other random numbers; what differs is their noise.
TEST(CellNoise, IsWhatOtherCellsWouldChange) {
    Context context(2);
    test::ChartedScene room(test::room(), 4, context);
    PathOptions path;
    path.samples = 256;
    constexpr int kRuns = 16;
    std::vector<double> sum, square;
    double stated = 0.0;
    for (std::uint32_t run = 0; run < kRuns; ++run) {
        PathOptions of_cells = path;
        of_cells.seed = 100 + run;
        const SurfaceCells cells =
            make_lit_cells(room.charts, room.atlas, room.traced.transport, of_cells, context).value();
        RadianceSums sums = room.gather(path, &cells);
        sum.resize(3 * sums.size());
        square.resize(3 * sums.size());
        for (std::size_t i = 0; i < sums.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const double light = double{test::total_irradiance(sums, i)[c]};
                sum[3 * i + c] += light;
                square[3 * i + c] += light * light;
            }
        double before = 0.0, after = 0.0;
        for (const Vec3& v : sums.variance) before += of_all(v);
        Transport transport = room.traced.transport;
        transport.cells = &cells;
        ASSERT_TRUE(add_cell_noise(room.texels, room.charts, room.atlas, transport, path, sums, context).ok());
        for (const Vec3& v : sums.variance) after += of_all(v);
        stated += (after - before) / kRuns;
    }
    double truth = 0.0;
    for (std::size_t i = 0; i < sum.size(); ++i) truth += (square[i] - sum[i] * sum[i] / kRuns) / (kRuns - 1);
    ASSERT_GT(truth, 0.0);
    // 1.6 times the truth was measured: the groups of a cell's paths are spread less evenly than all of them, and no
    // place is said to have less than the average. What is common to all texels has 15 degrees of freedom in 16 runs,
    // whose variance is between 0.48 and 1.67 of the true one in 90 of 100 cases.
    EXPECT_GT(stated, 1.6 / 1.67 * truth);
    EXPECT_LT(stated, 1.6 / 0.48 * truth);
    RecordProperty("stated_over_truth", std::to_string(stated / truth));
}

TEST(CellNoise, IsNoneWhereTheIndirectLayerIsLeftOut) {
    Context context(2);
    test::ChartedScene room(test::room(), 4, context);
    PathOptions path;
    path.samples = 32;
    const SurfaceCells cells = make_lit_cells(room.charts, room.atlas, room.traced.transport, path, context).value();
    RadianceSums sums = room.gather(path, &cells);
    const std::vector<Vec3> before = sums.variance;
    Transport transport = room.traced.transport;
    transport.cells = &cells;
    path.included[static_cast<std::size_t>(Layer::indirect)] = false;
    ASSERT_TRUE(add_cell_noise(room.texels, room.charts, room.atlas, transport, path, sums, context).ok());
    EXPECT_EQ(sums.variance, before);
}

}  // namespace
}  // namespace lumel
