// How many texels each chart of each instance gets, and the density that meets a texel budget.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "chart/chart_mask.h"
#include "chart/chart_set.h"

namespace lumel {

// One chart of one lightmap instance.
struct ChartInstance {
    std::uint32_t instance = 0, mesh = 0, chart = 0;
    // Metres of world per chart unit along u and v, times Instance::density_scale, less where the chart is sealed.
    double rate_x = 1.0, rate_y = 1.0;
};

// All of them, by instance, then chart. A transform that scales evenly gives its factor to all charts; an uneven one
// gives each chart the root mean square of the factors along its own u and v.
std::vector<ChartInstance> chart_instances(const Scene& scene, const ChartSet& charts);

// Charts drawn at one density. Charts that look alike share a mask.
struct SizedCharts {
    std::vector<ChartMask> masks;                     // in cells of the rule
    std::vector<std::array<std::uint32_t, 2>> sizes;  // beside them: width and height of the box in texels
    std::vector<std::uint32_t> mask_of;               // beside the chart instances
    std::uint64_t used = 0, covered = 0;              // texels of all instances: on pages, and those that are baked
    std::vector<std::uint32_t> clamped;               // chart instances that the largest size cut down
    double reached = 0.0, least = 0.0;  // texels per metre, with the clamped ones: mean over the area, and lowest
};

struct SizeLimit {
    std::uint32_t width = 0, height = 0;  // of a chart's box, texels, at least 2
    MaskRule rule{};

    // What fits a page of this size.
    static SizeLimit of_page(std::uint32_t width, std::uint32_t height, const MaskRule& rule) {
        return {rule.texels_within(width), rule.texels_within(height), rule};
    }
};

// The box of a chart becomes a whole number of texel steps, the nearest to its size at this density but at least one: a
// chart has 2 x 2 texels or more. Returns nothing where the context was cancelled.
// `fixed`: beside the instances, sizes that are not to be asked about; 0 x 0, or none at all: as said.
std::optional<SizedCharts> size_charts(const ChartSet& charts, const std::vector<ChartInstance>& instances,
                                       double texels_per_metre, SizeLimit limit, Context& context,
                                       std::span<const std::array<std::uint32_t, 2>> fixed = {});

// What the masks of size_charts() take, bytes, without drawing them.
std::uint64_t mask_bytes(const ChartSet& charts, const std::vector<ChartInstance>& instances, double texels_per_metre,
                         SizeLimit limit, std::span<const std::array<std::uint32_t, 2>> fixed = {});

// Is this the size of a box that size_charts() gives such a chart, be it sealed or not? Within a hundredth of a texel,
// for what a turned or moved instance differs in.
bool has_size(const ChartSet& charts, const ChartInstance& instance, double texels_per_metre, SizeLimit limit,
              std::uint32_t width, std::uint32_t height);

// What a budget counts: all texels that masks take on a page, or only those that will be baked.
enum class BudgetOf : std::uint8_t { page, baked };

// The density whose masks hold `budget` texels less at most half a percent, or as near as whole texels come. Where 2 x
// 2 texels for every chart would eat more than half of the budget, twice that floor is taken as the budget.
Result<double> solve_density(const ChartSet& charts, const std::vector<ChartInstance>& instances, double budget,
                             BudgetOf what, SizeLimit limit, Context& context);

// Every chart as small as can be: 2 x 2 texels, or the whole cells of a page that those take.
inline double least_texels(const std::vector<ChartInstance>& instances, BudgetOf what, const MaskRule& rule) {
    const double edge = what == BudgetOf::page ? static_cast<double>(rule.cells(2)) * rule.cell() : 2.0;
    return edge * edge * static_cast<double>(instances.size());
}

// World area over all chart instances, with the rates applied: texels at one texel per metre.
double texels_at_unit_density(const ChartSet& charts, const std::vector<ChartInstance>& instances);

// What charts of one density take.
struct PackedSize {
    double bytes = 0.0;        // infinite: they do not fit at all
    bool all_largest = false;  // every chart is as large as a page allows
};

// The highest density found at which `pack_at` gives no more bytes than `budget`; `least` is known to. Bytes
// do not quite grow with the density, for pages are of whole rows and the packer has better and worse days: the search
// ends where 99 % of the budget is used, where nothing grows any more, where its bracket is narrow, or after 16
// packings. `even`: the density at which charts without border or gap would take the budget. Errors: of `pack_at`.
Result<double> densest_within(double budget, double least, double even,
                              const std::function<Result<PackedSize>(double density)>& pack_at);

}  // namespace lumel
