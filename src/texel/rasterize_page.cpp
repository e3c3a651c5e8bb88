// Texels of a page from its triangles, in bands of rows: which triangles cover which texels, then texel by texel the
// owner, the valid sample points and the representative point.
#include <algorithm>
#include <bit>
#include <string>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "texel/texel_buffer.h"
#include "texel/texel_samples.h"
#include "texel/texel_triangle.h"

namespace lumel {
namespace {

constexpr std::uint32_t kBandRows = 16;

// Metres across a texel of this triangle: the longer edge of the parallelogram that its square is on the surface.
float metres_per_texel(const std::array<Vec3, 3>& world, const std::array<Vec2, 3>& texels) {
    const Vec3 p = world[1] - world[0], q = world[2] - world[0];
    const float longest = std::max({length(p), length(q), length(q - p)});
    const double ux = double{texels[1].x} - texels[0].x, uy = double{texels[1].y} - texels[0].y;
    const double vx = double{texels[2].x} - texels[0].x, vy = double{texels[2].y} - texels[0].y;
    const double twice_area = ux * vy - uy * vx;
    // Below one part in 10^5 a triangle has no width to measure by; all of it lies within a texel's breadth.
    const double squared_length = std::max({ux * ux + uy * uy, vx * vx + vy * vy});
    if (!(std::fabs(twice_area) > 1e-5 * squared_length)) return longest;
    const auto s = [&](double x) { return static_cast<float>(x / twice_area); };
    const Vec3 along_x = p * s(vy) - q * s(uy), along_y = q * s(ux) - p * s(vx);
    return std::max(length(along_x), length(along_y));
}

// The texels of one band, as the arrays of a TexelBuffer.
struct Band {
    TexelBuffer texels;
    std::uint64_t overlaps = 0;
    std::vector<std::string> overlap_examples;
};

class PageRasterizer {
public:
    PageRasterizer(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts, const Atlas& atlas,
                   std::uint32_t page, std::span<const std::uint32_t> triangles, Context& context)
        : scene_(scene),
          geometry_(geometry),
          charts_(charts),
          atlas_(atlas),
          page_(page),
          width_(atlas.pages[page].width),
          height_(atlas.pages[page].height),
          triangles_(triangles),
          context_(context) {
        LUMEL_CHECK(width_ <= 65536 && height_ <= 65536, width_, height_);
    }

    Result<TexelBuffer> run() {
        const std::uint32_t band_count = (height_ + kBandRows - 1) / kBandRows;
        std::vector<Band> bands(band_count);
        const bool done = sort_into_bands(band_count) && parallel_for(
                                                             context_, band_count, 1,
                                                             [&](const ChunkRange& range) {
                                                                 bands[range.index] =
                                                                     rasterize(static_cast<std::uint32_t>(range.index));
                                                             },
                                                             "texels");
        if (!done) return cancelled_error();
        report_overlaps(bands);
        return join(bands);
    }

private:
    // A triangle that covers a texel of a band; `texel` counts along the rows from the band's first texel.
    struct Claim {
        std::uint32_t texel, triangle;
    };

    [[nodiscard]] std::array<Vec2, 3> uv(std::uint32_t triangle) const {
        return atlas_.triangle_uv(charts_, geometry_, scene_, triangle).texels;
    }

    // Page order of charts: that of their placements.
    [[nodiscard]] std::uint32_t chart_of(std::uint32_t triangle) const {
        const WorldTriangle& t = geometry_.triangles[triangle];
        const MeshCharts& mesh = charts_.meshes[scene_.instances[t.instance].mesh];
        return atlas_.first_placement[t.instance] + mesh.chart_of_triangle[t.mesh_triangle];
    }

    // For each band its triangles, in ascending order.
    bool sort_into_bands(std::uint32_t band_count) {
        std::vector<CellRange> spans(triangles_.size());
        constexpr std::size_t kGrain = 16384;
        const bool done = parallel_for(context_, spans.size(), kGrain, [&](const ChunkRange& range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const CellRange rows = TexelTriangle(uv(triangles_[i])).rows(height_);
                constexpr auto n = static_cast<std::int32_t>(kBandRows);
                spans[i] = {rows.first / n, rows.end > rows.first ? (rows.end + n - 1) / n : rows.first / n};
            }
        });
        if (!done) return false;
        band_start_.assign(band_count + 1, 0);
        for (const CellRange& span : spans)
            for (std::int32_t b = span.first; b < span.end; ++b) ++band_start_[static_cast<std::size_t>(b) + 1];
        for (std::size_t b = 0; b < band_count; ++b) band_start_[b + 1] += band_start_[b];
        band_triangles_.resize(band_start_.back());
        std::vector<std::size_t> next(band_start_.begin(), band_start_.end() - 1);
        for (std::size_t i = 0; i < spans.size(); ++i)
            for (std::int32_t b = spans[i].first; b < spans[i].end; ++b)
                band_triangles_[next[static_cast<std::size_t>(b)]++] = triangles_[i];
        return true;
    }

    [[nodiscard]] Band rasterize(std::uint32_t index) const {
        const std::uint32_t first_row = index * kBandRows, rows = std::min(kBandRows, height_ - first_row);
        const std::vector<Claim> claims = collect_claims(index, first_row, rows);

        // Sorted by texel; within one the triangles stay in ascending order.
        std::vector<std::uint32_t> start(std::size_t{rows} * width_ + 1);
        for (const Claim& claim : claims) ++start[claim.texel + 1];
        for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
        std::vector<std::uint32_t> next(start.begin(), start.end() - 1), sorted(claims.size());
        for (const Claim& claim : claims) sorted[next[claim.texel]++] = claim.triangle;

        Band band;
        band.texels.first_triangle = {0};
        for (std::uint32_t texel = 0; texel + 1 < start.size(); ++texel) {
            if (start[texel] == start[texel + 1]) continue;
            const std::span claimants(&sorted[start[texel]], start[texel + 1] - start[texel]);
            add_texel(band, texel % width_, first_row + texel / width_, claimants);
        }
        return band;
    }

    [[nodiscard]] std::vector<Claim> collect_claims(std::uint32_t band, std::uint32_t first_row,
                                                    std::uint32_t rows) const {
        std::vector<Claim> claims;
        const auto band_first = static_cast<std::int32_t>(first_row),
                   band_end = static_cast<std::int32_t>(first_row + rows);
        for (std::size_t i = band_start_[band]; i < band_start_[band + 1]; ++i) {
            const TexelTriangle triangle(uv(band_triangles_[i]));
            const CellRange covered = triangle.rows(height_);
            for (std::int32_t y = std::max(covered.first, band_first); y < std::min(covered.end, band_end); ++y) {
                const CellRange columns = triangle.columns(y, width_);
                const std::uint32_t row = static_cast<std::uint32_t>(y - band_first) * width_;
                for (std::int32_t x = columns.first; x < columns.end; ++x)
                    claims.push_back({row + static_cast<std::uint32_t>(x), band_triangles_[i]});
            }
        }
        return claims;
    }

    // The chart with the most sample points in the texel, and which those are.
    struct Owner {
        std::uint32_t chart = kNone;
        std::uint64_t valid = 0;
        bool contested = false;
    };

    [[nodiscard]] Owner find_owner(const TexelSamples& samples, std::span<const std::uint32_t> claimants) const {
        struct Share {
            std::uint32_t chart;
            std::uint64_t valid;
        };
        std::vector<Share> shares;  // nearly always one
        for (const std::uint32_t triangle : claimants) {
            const std::uint32_t chart = chart_of(triangle);
            auto share = std::ranges::find(shares, chart, &Share::chart);
            if (share == shares.end()) share = shares.insert(share, {chart, 0});
            if (share->valid != ~std::uint64_t{0}) share->valid |= samples.inside(TexelTriangle(uv(triangle)));
        }
        const auto less = [](const Share& a, const Share& b) {
            const int na = std::popcount(a.valid), nb = std::popcount(b.valid);
            return na != nb ? na < nb : a.chart > b.chart;
        };
        const Share& most = *std::ranges::max_element(shares, less);
        return {most.chart, most.valid, shares.size() > 1};
    }

    void add_texel(Band& band, std::uint32_t x, std::uint32_t y, std::span<const std::uint32_t> claimants) const {
        TexelBuffer& out = band.texels;
        const TexelSamples samples(x, y);
        const Owner owner = find_owner(samples, claimants);
        if (owner.contested) note_overlap(band, x, y, claimants);

        out.x.push_back(static_cast<std::uint16_t>(x));
        out.y.push_back(static_cast<std::uint16_t>(y));
        out.valid.push_back(owner.valid);
        out.chart.push_back(owner.chart);
        for (const std::uint32_t triangle : claimants)
            if (!owner.contested || chart_of(triangle) == owner.chart) out.triangles.push_back(triangle);
        const std::span triangles = std::span(std::as_const(out.triangles)).subspan(out.first_triangle.back());
        out.first_triangle.push_back(static_cast<std::uint32_t>(out.triangles.size()));

        const SamplePoint point = samples.representative(
            triangles, owner.valid, [&](std::uint32_t triangle) { return TexelTriangle(uv(triangle)); });
        out.position.push_back(geometry_.position(point.triangle, point.b1, point.b2));
        out.normal.push_back(geometry_.shading_normal(point.triangle, point.b1, point.b2));
        out.world_size.push_back(metres_per_texel(geometry_.corners(point.triangle), uv(point.triangle)));
    }

    void note_overlap(Band& band, std::uint32_t x, std::uint32_t y, std::span<const std::uint32_t> claimants) const {
        ++band.overlaps;
        if (band.overlap_examples.size() >= Diagnostics::kMaxExamples) return;
        const auto other = std::ranges::find_if(
            claimants, [&](std::uint32_t triangle) { return chart_of(triangle) != chart_of(claimants[0]); });
        const auto name = [&](std::uint32_t triangle) {
            return "'" + scene_.instances[geometry_.triangles[triangle].instance].name + "'";
        };
        band.overlap_examples.push_back("page " + std::to_string(page_) + ", texel " + std::to_string(x) + ", " +
                                        std::to_string(y) + ": charts of " + name(claimants[0]) + " and " +
                                        name(*other));
    }

    void report_overlaps(const std::vector<Band>& bands) {
        for (const Band& band : bands) {
            std::uint64_t counted = 0;
            for (const std::string& example : band.overlap_examples) {
                // The last example stands for the rest of its band.
                const bool last = &example == &band.overlap_examples.back();
                const std::uint64_t count = last ? band.overlaps - counted : 1;
                context_.diagnostics.add("chart-overlap",
                                         "texels are shared by charts; each went to the chart with most of it", example,
                                         count);
                counted += count;
            }
        }
    }

    // Appends the bands in order, giving each one's memory back on the way.
    [[nodiscard]] TexelBuffer join(std::vector<Band>& bands) const {
        std::size_t texels = 0, triangles = 0;
        for (const Band& band : bands) {
            texels += band.texels.size();
            triangles += band.texels.triangles.size();
        }
        LUMEL_CHECK(triangles < kNone, triangles);
        TexelBuffer out;
        out.page = page_;
        out.width = width_;
        out.height = height_;
        out.texel_at.assign(std::size_t{width_} * height_, kNone);
        out.first_triangle.reserve(texels + 1);
        out.first_triangle.push_back(0);
        out.triangles.reserve(triangles);
        out.x.reserve(texels);
        out.y.reserve(texels);
        out.valid.reserve(texels);
        out.chart.reserve(texels);
        out.position.reserve(texels);
        out.normal.reserve(texels);
        out.world_size.reserve(texels);
        for (Band& band : bands) {
            append(out, band.texels);
            band = {};
        }
        for (std::size_t i = 0; i < texels; ++i)
            out.texel_at[std::size_t{out.y[i]} * width_ + out.x[i]] = static_cast<std::uint32_t>(i);
        return out;
    }

    static void append(TexelBuffer& out, const TexelBuffer& band) {
        const auto offset = static_cast<std::uint32_t>(out.triangles.size());
        for (std::size_t i = 1; i < band.first_triangle.size(); ++i)
            out.first_triangle.push_back(offset + band.first_triangle[i]);
        const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        add(out.triangles, band.triangles);
        add(out.x, band.x);
        add(out.y, band.y);
        add(out.valid, band.valid);
        add(out.chart, band.chart);
        add(out.position, band.position);
        add(out.normal, band.normal);
        add(out.world_size, band.world_size);
    }

    const Scene& scene_;
    const WorldGeometry& geometry_;
    const ChartSet& charts_;
    const Atlas& atlas_;
    std::uint32_t page_, width_, height_;
    std::span<const std::uint32_t> triangles_;
    Context& context_;
    std::vector<std::size_t> band_start_;  // per band into band_triangles_, plus one past the end
    std::vector<std::uint32_t> band_triangles_;
};

}  // namespace

Result<TexelBuffer> rasterize_page(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                   const Atlas& atlas, std::uint32_t page,
                                   std::span<const std::uint32_t> page_triangles, Context& context) {
    return PageRasterizer(scene, geometry, charts, atlas, page, page_triangles, context).run();
}

}  // namespace lumel
