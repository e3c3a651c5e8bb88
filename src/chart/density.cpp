#include "chart/density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/cancelled.h"
#include "base/parallel.h"
#include "base/try.h"

namespace lumel {
namespace {

// ---- World scale ----------------------------------------------------------------------------------------------------

using Vec3d = std::array<double, 3>;

// Squared length of the image of a mesh-space direction.
double stretched(const Affine& m, const Vec3d& v) {
    double sum = 0.0;
    for (std::size_t row = 0; row < 3; ++row) {
        double x = 0.0;
        for (std::size_t c = 0; c < 3; ++c) x += double{m.columns[c][row]} * v[c];
        sum += x * x;
    }
    return sum;
}

double column_product(const Affine& m, std::size_t a, std::size_t b) {
    double sum = 0.0;
    for (std::size_t row = 0; row < 3; ++row) sum += double{m.columns[a][row]} * m.columns[b][row];
    return sum;
}

// Root mean square of the three axes' factors.
double mean_scale(const Affine& m) {
    return std::sqrt((column_product(m, 0, 0) + column_product(m, 1, 1) + column_product(m, 2, 2)) / 3.0);
}

// Rotation, mirror and one common factor, up to the rounding of a composed float matrix.
bool scales_evenly(const Affine& m) {
    const double squared = mean_scale(m) * mean_scale(m), tolerance = 1e-4 * squared;
    for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = a; b < 3; ++b)
            if (std::abs(column_product(m, a, b) - (a == b ? squared : 0.0)) > tolerance) return false;
    return true;
}

struct Rate {
    double x, y;
};

// Mean factors of the transform along a chart's u and v.
Rate uneven_rate(const Mesh& mesh, const MeshCharts& charts, const Chart& chart, const Affine& transform) {
    double before_x = 0.0, before_y = 0.0, after_x = 0.0, after_y = 0.0;
    for (std::uint32_t k = chart.first; k < chart.first + chart.count; ++k) {
        const std::uint32_t t = charts.order[k];
        const UvTriangle& uv = charts.uv[t];
        const double determinant = uv_cross(uv);
        if (determinant == 0.0) continue;
        const Vec3 p0 = mesh.positions[mesh.triangles[t][0]], p1 = mesh.positions[mesh.triangles[t][1]],
                   p2 = mesh.positions[mesh.triangles[t][2]];
        const double u1 = double{uv[1].x} - uv[0].x, v1 = double{uv[1].y} - uv[0].y;
        const double u2 = double{uv[2].x} - uv[0].x, v2 = double{uv[2].y} - uv[0].y;
        Vec3d du, dv;
        for (std::size_t c = 0; c < 3; ++c) {
            const double e1 = double{p1[c]} - p0[c], e2 = double{p2[c]} - p0[c];
            du[c] = (e1 * v2 - e2 * v1) / determinant;
            dv[c] = (e2 * u1 - e1 * u2) / determinant;
        }
        const double weight = std::abs(determinant);
        before_x += weight * (du[0] * du[0] + du[1] * du[1] + du[2] * du[2]);
        before_y += weight * (dv[0] * dv[0] + dv[1] * dv[1] + dv[2] * dv[2]);
        after_x += weight * stretched(transform, du);
        after_y += weight * stretched(transform, dv);
    }
    const double fallback = mean_scale(transform);
    return {before_x > 0.0 ? std::sqrt(after_x / before_x) : fallback,
            before_y > 0.0 ? std::sqrt(after_y / before_y) : fallback};
}

// ---- Sizes ----------------------------------------------------------------------------------------------------------

// A chart drawn in a box of so many texels.
struct Drawing {
    std::uint32_t mesh, chart, width, height;
    bool operator==(const Drawing&) const = default;
    bool operator<(const Drawing& o) const {
        return std::tie(mesh, chart, width, height) < std::tie(o.mesh, o.chart, o.width, o.height);
    }
};

// `share`: of the steps asked for, below 1 where they were clamped.
std::uint32_t texel_steps(double length, double density, std::uint32_t limit, double& share) {
    const double steps = std::max(1.0, std::floor(length * density + 0.5));
    share = 1.0;
    if (steps <= limit - 1) return static_cast<std::uint32_t>(steps);
    share = static_cast<double>(limit - 1) / (length * density);
    return limit - 1;
}

struct Sized {
    Drawing drawing;
    double area;   // of the box, world units
    double share;  // of the texels asked for, before their number was rounded
};

Sized size_chart(const ChartSet& charts, const ChartInstance& c, double density, SizeLimit limit) {
    const Chart& chart = charts.meshes[c.mesh].charts[c.chart];
    const double size_x = (double{chart.max.x} - chart.min.x) * c.rate_x;
    const double size_y = (double{chart.max.y} - chart.min.y) * c.rate_y;
    double share_x = 1.0, share_y = 1.0;
    const std::uint32_t width = texel_steps(size_x, density, limit.width, share_x) + 1;
    const std::uint32_t height = texel_steps(size_y, density, limit.height, share_y) + 1;
    return {{c.mesh, c.chart, width, height}, size_x * size_y, share_x * share_y};
}

// Where the size of a chart is given, that.
Drawing drawing_of(const Sized& chart, std::size_t k, std::span<const std::array<std::uint32_t, 2>> fixed) {
    Drawing out = chart.drawing;
    if (fixed.empty() || fixed[k][0] == 0) return out;
    out.width = fixed[k][0];
    out.height = fixed[k][1];
    return out;
}

// Each once, in order.
std::vector<Drawing> distinct(std::vector<Drawing> drawings) {
    std::sort(drawings.begin(), drawings.end());
    drawings.erase(std::unique(drawings.begin(), drawings.end()), drawings.end());
    return drawings;
}

ChartMask draw(const ChartSet& charts, const Drawing& d, const MaskRule& rule) {
    const MeshCharts& mesh = charts.meshes[d.mesh];
    const Chart& chart = mesh.charts[d.chart];
    return make_mask(std::span(mesh.order).subspan(chart.first, chart.count), mesh.uv, chart.min, chart.max, d.width,
                     d.height, rule);
}

}  // namespace

std::vector<ChartInstance> chart_instances(const Scene& scene, const ChartSet& charts) {
    std::vector<ChartInstance> out;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (!charts.gets_texels(scene, i)) continue;
        const MeshCharts& mesh_charts = charts.meshes[instance.mesh];
        const bool even = scales_evenly(instance.transform);
        const double scale = mean_scale(instance.transform);
        for (std::uint32_t c = 0; c < mesh_charts.charts.size(); ++c) {
            const Rate rate = even ? Rate{scale, scale}
                                   : uneven_rate(*scene.meshes[instance.mesh], mesh_charts, mesh_charts.charts[c],
                                                 instance.transform);
            const double scaled = instance.density_scale * (charts.is_sealed(i, c) ? ChartSet::kSealedDensity : 1.0);
            out.push_back({i, instance.mesh, c, rate.x * scaled, rate.y * scaled});
        }
    }
    return out;
}

std::optional<SizedCharts> size_charts(const ChartSet& charts, const std::vector<ChartInstance>& instances,
                                       double texels_per_metre, SizeLimit limit, Context& context,
                                       std::span<const std::array<std::uint32_t, 2>> fixed) {
    SizedCharts sized;
    std::vector<Drawing> wanted;
    wanted.reserve(instances.size());
    double area = 0.0, area_reached = 0.0, least = 1.0;
    for (std::uint32_t k = 0; k < instances.size(); ++k) {
        const Sized chart = size_chart(charts, instances[k], texels_per_metre, limit);
        wanted.push_back(drawing_of(chart, k, fixed));
        area += chart.area;
        area_reached += chart.area * chart.share;
        least = std::min(least, chart.share);
        if (chart.share < 1.0) sized.clamped.push_back(k);
    }
    sized.reached = texels_per_metre * (area > 0.0 ? std::sqrt(area_reached / area) : 1.0);
    sized.least = texels_per_metre * std::sqrt(least);
    const std::vector<Drawing> drawings = distinct(wanted);
    sized.masks.resize(drawings.size());
    const bool done = parallel_for(context, drawings.size(), 64, [&](const ChunkRange& range) {
        for (std::size_t i = range.begin; i < range.end; ++i) sized.masks[i] = draw(charts, drawings[i], limit.rule);
    });
    if (!done) return std::nullopt;
    const std::uint64_t cell_texels = std::uint64_t{limit.rule.cell()} * limit.rule.cell();
    for (const Drawing& d : drawings) sized.sizes.push_back({d.width, d.height});
    sized.mask_of.reserve(instances.size());
    for (const Drawing& d : wanted) {
        const auto it = std::lower_bound(drawings.begin(), drawings.end(), d);
        sized.mask_of.push_back(static_cast<std::uint32_t>(it - drawings.begin()));
        sized.used += sized.masks[sized.mask_of.back()].used * cell_texels;
        sized.covered += sized.masks[sized.mask_of.back()].covered;
    }
    return sized;
}

std::uint64_t mask_bytes(const ChartSet& charts, const std::vector<ChartInstance>& instances, double texels_per_metre,
                         SizeLimit limit, std::span<const std::array<std::uint32_t, 2>> fixed) {
    std::vector<Drawing> drawings;
    drawings.reserve(instances.size());
    for (std::size_t k = 0; k < instances.size(); ++k)
        drawings.push_back(drawing_of(size_chart(charts, instances[k], texels_per_metre, limit), k, fixed));
    std::uint64_t bytes = 0;
    for (const Drawing& d : distinct(std::move(drawings)))
        bytes += ChartMask::bytes_of(limit.rule.cells(d.width), limit.rule.cells(d.height));
    return bytes;
}

bool has_size(const ChartSet& charts, const ChartInstance& instance, double texels_per_metre, SizeLimit limit,
              std::uint32_t width, std::uint32_t height) {
    constexpr double kRounding = 0.51;
    const Chart& chart = charts.meshes[instance.mesh].charts[instance.chart];
    const double unsealed = charts.is_sealed(instance.instance, instance.chart) ? 1.0 / ChartSet::kSealedDensity : 1.0;
    const auto fits = [](double length, std::uint32_t texels, std::uint32_t most) {
        const double steps = std::clamp(length, 1.0, std::max(1.0, most - 1.0));
        return std::abs(steps - (texels - 1.0)) <= kRounding;
    };
    for (const double share : {1.0, ChartSet::kSealedDensity}) {
        const double density = texels_per_metre * unsealed * share;
        if (fits((double{chart.max.x} - chart.min.x) * instance.rate_x * density, width, limit.width) &&
            fits((double{chart.max.y} - chart.min.y) * instance.rate_y * density, height, limit.height))
            return true;
    }
    return false;
}

double texels_at_unit_density(const ChartSet& charts, const std::vector<ChartInstance>& instances) {
    double sum = 0.0;
    std::vector<std::vector<double>> areas(charts.meshes.size());  // per mesh and chart
    for (const ChartInstance& c : instances) {
        const MeshCharts& mesh = charts.meshes[c.mesh];
        if (areas[c.mesh].empty()) {
            areas[c.mesh].resize(mesh.charts.size());
            for (std::size_t k = 0; k < mesh.charts.size(); ++k)
                for (std::uint32_t i = 0; i < mesh.charts[k].count; ++i)
                    areas[c.mesh][k] += 0.5 * std::abs(uv_cross(mesh.uv[mesh.order[mesh.charts[k].first + i]]));
        }
        sum += areas[c.mesh][c.chart] * c.rate_x * c.rate_y;
    }
    return sum;
}

Result<double> solve_density(const ChartSet& charts, const std::vector<ChartInstance>& instances, double budget,
                             BudgetOf what, SizeLimit limit, Context& context) {
    const double unit = texels_at_unit_density(charts, instances);
    if (!(unit > 0.0)) return 1.0;
    const double target = std::max(budget, least_texels(instances, what, limit.rule));
    const double aim = 0.9975 * target;  // a budget is a ceiling
    // Borders only add to the area, up to the rounding of sizes: twice its density is above the answer.
    double low = 0.0, high = 2.0 * std::sqrt(target / unit), density = 0.25 * high;
    for (int step = 0; step < 24; ++step) {
        const std::optional<SizedCharts> sized = size_charts(charts, instances, density, limit, context);
        if (!sized) return cancelled_error();
        const double used = static_cast<double>(what == BudgetOf::page ? sized->used : sized->covered);
        if (std::abs(used - aim) <= 0.0025 * target) break;
        (used < aim ? low : high) = density;
        // Texels grow about as the square of the density; keep the guess well inside the bracket.
        const double guess = density * std::sqrt(aim / used);
        const double margin = 0.02 * (high - low);
        density = std::clamp(guess, low + margin, high - margin);
    }
    return density;
}

Result<double> densest_within(double budget, double least, double even,
                              const std::function<Result<PackedSize>(double density)>& pack_at) {
    constexpr int kSteps = 16;
    constexpr double kNear = 0.99, kNarrow = 1.002, kMargin = 0.02;
    double low = least, high = 2.0 * even, density = kNear * even;
    for (int step = 0; step < kSteps && high > kNarrow * low; ++step) {
        LUMEL_TRY(const PackedSize packed, pack_at(density));
        if (packed.bytes <= budget) {
            low = density;
            if (packed.all_largest || packed.bytes >= kNear * budget) break;
        } else {
            high = density;
        }
        const double margin = kMargin * (high - low), middle = 0.5 * (low + high);
        const double guess = density * std::sqrt(0.5 * (1.0 + kNear) * budget / packed.bytes);
        // Where the guess would only creep along one end of the bracket, its middle.
        density = guess > low + margin && guess < high - margin ? guess : middle;
    }
    return low;
}

}  // namespace lumel
