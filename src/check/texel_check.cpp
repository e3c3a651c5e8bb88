#include "check/texel_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cancelled.h"
#include "chart/overlap.h"
#include "check/lookup.h"

namespace lumel {
namespace {

double light_of(const CheckedPage& page, std::size_t texel) {
    const float* rgb = &page.light.data[texel * page.light.channels];
    return static_cast<double>(luminance({rgb[0], rgb[1], rgb[2]}));
}

class PageCheck {
public:
    PageCheck(const CheckedPage& page, std::uint32_t index, double mean, const TexelCheckOptions& options,
              TexelCheck& out)
        : page_(page), index_(index), mean_(mean), options_(options), out_(out) {}

    void row(std::uint32_t y) {
        for (std::uint32_t x = 0; x < page_.width; ++x) texel(x, y);
    }

private:
    void texel(std::uint32_t x, std::uint32_t y) {
        const std::size_t i = std::size_t{y} * page_.width + x;
        if (page_.state[i] == TexelState::empty || page_.state[i] == TexelState::hidden) return;
        const TexelDefect here{index_, x, y};
        const float* rgb = &page_.light.data[i * page_.light.channels];
        if (!is_finite(Vec3{rgb[0], rgb[1], rgb[2]})) {
            out_.not_finite.add(here);
            return;
        }
        if (page_.state[i] == TexelState::filled) ++out_.filled;
        if (page_.state[i] != TexelState::baked) return;
        ++out_.baked;
        if (is_black(x, y, light_of(page_, i))) out_.black.add(here);
        if (is_noisy(i)) out_.unconverged.add(here);
    }

    // Light goes on at least a little from texel to texel: where each of five or more neighbours has much, none is
    // wrong.
    [[nodiscard]] bool is_black(std::uint32_t x, std::uint32_t y, double light) const {
        constexpr std::uint32_t kLeastNeighbours = 5;
        std::uint32_t count = 0;
        double least = 1e30;
        for (std::int64_t j = std::int64_t{y} - 1; j <= std::int64_t{y} + 1; ++j)
            for (std::int64_t i = std::int64_t{x} - 1; i <= std::int64_t{x} + 1; ++i) {
                if (i < 0 || j < 0 || i >= page_.width || j >= page_.height || (i == x && j == y)) continue;
                const auto at = static_cast<std::size_t>(j * page_.width + i);
                if (page_.state[at] != TexelState::baked) continue;
                ++count;
                least = std::min(least, light_of(page_, at));
            }
        return count >= kLeastNeighbours && least > 0.01 * mean_ && light < 0.01 * least;
    }

    // Against its own light, or a hundredth of the scene's where it has less.
    [[nodiscard]] bool is_noisy(std::size_t i) const {
        if (page_.variance.data.empty()) return false;
        const float* variance = &page_.variance.data[3 * i];
        const double error =
            static_cast<double>(luminance({std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2])}));
        // A variance that is no number, or below zero, is no proof.
        return !(error <= options_.noisy * std::max(light_of(page_, i), 0.01 * mean_));
    }

    const CheckedPage& page_;
    std::uint32_t index_;
    double mean_;
    const TexelCheckOptions& options_;
    TexelCheck& out_;
};

TexelDefect place_of(const CheckedBake& bake, const CheckedTriangle& t, Vec2 uv) {
    const CheckedPage& page = bake.pages[t.page];
    const auto pixel = [](float v, std::uint32_t size) {
        return static_cast<std::uint32_t>(std::clamp(v * static_cast<float>(size), 0.0f, static_cast<float>(size - 1)));
    };
    return {t.page, pixel(uv.x, page.width), pixel(uv.y, page.height)};
}

// Does a bilinear lookup there take some of an empty texel?
bool reads_empty(const CheckedPage& page, Vec2 uv) {
    constexpr double kShown = 0.01;  // share of a texel below which rounding, or no eye, decides
    const double x = std::clamp(double{uv.x} * page.width - 0.5, 0.0, page.width - 1.0);
    const double y = std::clamp(double{uv.y} * page.height - 0.5, 0.0, page.height - 1.0);
    const auto x0 = static_cast<std::uint32_t>(x), y0 = static_cast<std::uint32_t>(y);
    for (std::uint32_t j = 0; j < 2; ++j)
        for (std::uint32_t i = 0; i < 2; ++i) {
            const double share = (i == 0 ? 1.0 - (x - x0) : x - x0) * (j == 0 ? 1.0 - (y - y0) : y - y0);
            const std::size_t at =
                std::size_t{std::min(y0 + j, page.height - 1)} * page.width + std::min(x0 + i, page.width - 1);
            if (share > kShown && page.state[at] == TexelState::empty) return true;
        }
    return false;
}

void check_coverage(const CheckedBake& bake, TexelCheck& out) {
    // The corners, a little inside, and the middle.
    constexpr std::array<std::array<float, 3>, 4> kPlaces{
        {{0.98f, 0.01f, 0.01f}, {0.01f, 0.98f, 0.01f}, {0.01f, 0.01f, 0.98f}, {1.0f / 3, 1.0f / 3, 1.0f / 3}}};
    for (const CheckedTriangle& t : bake.triangles)
        for (const auto& b : kPlaces) {
            const Vec2 uv = t.uv[0] * b[0] + t.uv[1] * b[1] + t.uv[2] * b[2];
            if (!reads_empty(bake.pages[t.page], uv)) continue;
            out.uncovered.add(place_of(bake, t, uv));
            break;
        }
}

void check_overlaps(const CheckedBake& bake, std::uint32_t page, TexelCheck& out) {
    constexpr std::size_t kMostPairs = 10000;
    std::vector<UvTriangle> triangles;
    std::vector<const CheckedTriangle*> source;
    for (const CheckedTriangle& t : bake.triangles) {
        if (t.page != page) continue;
        triangles.push_back({bake.texels(t, 0), bake.texels(t, 1), bake.texels(t, 2)});
        source.push_back(&t);
    }
    // Texels: a tenth of one shows on none; rounding of coordinates in 0..1 is a thousandth of one at most.
    const OverlapSearch found = find_overlaps(triangles, {0.004, 0.1, 0.1}, kMostPairs);
    for (const auto& [a, b] : found.pairs) {
        const Vec2 texels = overlap_centre(triangles[a], triangles[b]);
        out.overlaps.add(place_of(bake, *source[a],
                                  {texels.x / static_cast<float>(bake.pages[page].width),
                                   texels.y / static_cast<float>(bake.pages[page].height)}));
    }
}

void check_density(const CheckedBake& bake, const TexelCheckOptions& options, TexelCheck& out) {
    struct Piece {
        double density, area;
        const CheckedTriangle* triangle;
    };
    std::vector<Piece> pieces;
    double area = 0.0;
    for (const CheckedTriangle& t : bake.triangles) {
        const UvTriangle texels{bake.texels(t, 0), bake.texels(t, 1), bake.texels(t, 2)};
        const double metres =
            0.5 * static_cast<double>(length(cross(t.position[1] - t.position[0], t.position[2] - t.position[0])));
        if (!(metres > 0.0)) continue;
        pieces.push_back({std::sqrt(0.5 * std::fabs(uv_cross(texels)) / metres), metres, &t});
        area += metres;
    }
    std::ranges::stable_sort(pieces, {}, &Piece::density);
    double below = 0.0;
    for (const Piece& piece : pieces) {
        if (below < 0.5 * area) out.median_density = piece.density;
        below += piece.area;
    }
    constexpr double kLeastTexels = 16.0;
    double outliers = 0.0;
    for (const Piece& piece : pieces) {
        const double ratio = piece.density / out.median_density;
        if (ratio < options.outlier && ratio * options.outlier > 1.0) continue;
        const double denser = std::max(piece.density, out.median_density);
        if (piece.area * denser * denser < kLeastTexels) continue;
        outliers += piece.area;
        out.outliers.add(place_of(bake, *piece.triangle, piece.triangle->uv[0]));
    }
    out.outlier_share = area > 0.0 ? outliers / area : 0.0;
}

}  // namespace

Result<TexelCheck> check_texels(const CheckedBake& bake, const TexelCheckOptions& options, Context& context) {
    TexelCheck out;
    const double mean = mean_light(bake);
    const auto pages = static_cast<std::uint32_t>(bake.pages.size());
    for (std::uint32_t p = 0; p < pages; ++p) {
        PageCheck page(bake.pages[p], p, mean, options, out);
        for (std::uint32_t y = 0; y < bake.pages[p].height; ++y) {
            if (context.cancelled()) return cancelled_error();
            page.row(y);
        }
        if (context.cancelled()) return cancelled_error();
        check_overlaps(bake, p, out);
        context.report("texels", static_cast<double>(p + 1) / static_cast<double>(pages));
    }
    if (context.cancelled()) return cancelled_error();
    check_coverage(bake, out);
    if (context.cancelled()) return cancelled_error();
    check_density(bake, options, out);
    return out;
}

}  // namespace lumel
