#include "path/cell_bias.h"

#include <gtest/gtest.h>

#include <cmath>

#include "path/light_cells.h"
#include "support/charted_scene.h"

namespace lumel {
namespace {

TEST(CellBias, IsARatioOfSumsWithItsError) {
    CellBias bias;
    EXPECT_TRUE(std::isnan(bias.relative()));
    EXPECT_TRUE(std::isnan(bias.standard_error()));
    bias.add(1.1, 1.0, 64);
    EXPECT_NEAR(bias.relative(), 0.1, 1e-12);
    EXPECT_TRUE(std::isnan(bias.standard_error())) << "one block tells nothing";
    bias.add(1.9, 2.0, 64);
    EXPECT_NEAR(bias.relative(), 0.0, 1e-12);
    // Residuals 0.1 and -0.1: sqrt(2 * 0.02) / 3.
    EXPECT_NEAR(bias.standard_error(), std::sqrt(0.04) / 3.0, 1e-12);
    CellBias black;
    black.add(0.0, 0.0, 64);
    EXPECT_TRUE(std::isnan(black.relative()));
}

CellBias bias_of(test::ChartedScene& room, const PathOptions& path, const SurfaceCells& cells, Context& context) {
    Transport transport = room.traced.transport;
    transport.cells = &cells;
    CellBias bias;
    EXPECT_TRUE(measure_cell_bias(room.texels, room.charts, room.atlas, transport, path, bias, context).ok());
    return bias;
}

TEST(CellBias, BlocksCountByTheTexelsTheyStandFor) {
    CellBias bias;
    bias.add(1.1, 1.0, 9000);
    bias.add(2.0, 1.0, 1000);
    EXPECT_NEAR(bias.relative(), 0.9 * 0.1 + 0.1 * 1.0, 1e-12);
}

TEST(CellBias, FindsCellsThatAreTooBright) {
    Context context(2);
    test::ChartedScene room(test::room(), 12, context);
    PathOptions path;
    path.samples = 256;
    SurfaceCells cells = make_lit_cells(room.charts, room.atlas, room.traced.transport, path, context).value();
    path.samples = 4096;  // of which the measurement may take its share
    const CellBias sound = bias_of(room, path, cells, context);
    // A percent is what steps between cells of this room may cost (LightCells.AgreeWithBruteForceInTheMean).
    EXPECT_LT(std::fabs(sound.relative()), 0.01 + 4.0 * sound.standard_error());
    EXPECT_LT(sound.standard_error(), 0.02);

    std::vector<CellGather> gathers(cells.size());
    for (std::uint32_t i = 0; i < cells.size(); ++i) gathers[i] = {cells.irradiance(i) * 1.5f, 1, 1};
    ASSERT_TRUE(cells.solve(gathers, {}, 1, context).ok());
    const CellBias bright = bias_of(room, path, cells, context);
    EXPECT_GT(bright.relative(), sound.relative() + 4.0 * bright.standard_error());
}

TEST(CellBias, CanBeCancelled) {
    Context context(2);
    test::ChartedScene room(test::room(), 6, context);
    PathOptions path;
    path.samples = 64;
    const SurfaceCells cells = make_lit_cells(room.charts, room.atlas, room.traced.transport, path, context).value();
    Transport transport = room.traced.transport;
    transport.cells = &cells;
    context.request_cancel();
    CellBias bias;
    const Status status = measure_cell_bias(room.texels, room.charts, room.atlas, transport, path, bias, context);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lumel
