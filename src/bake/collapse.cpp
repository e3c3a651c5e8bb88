#include "bake/collapse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/try.h"
#include "chart/chart_picture.h"
#include "math/constants.h"
#include "post/texel_mean.h"

namespace lumel {
namespace {

constexpr std::uint32_t kSmallest = 2;  // texels along the edge of the smallest box

bool has_own_light(const Lightmap& page, std::size_t texel) { return page.coverage[texel] >= Coverage::filled; }

Vec3 irradiance(const Lightmap& page, std::size_t texel, const LayerWeights& layers) {
    return sum_layers(layers, [&](std::size_t l) { return page.texels.layers[texel][l].irradiance; });
}

std::array<Vec3, kShCoefficients> coefficients(const Lightmap& page, std::size_t texel, const LayerWeights& layers) {
    return sum_sh_layers(
               layers, [&](std::size_t l) -> const auto& { return page.texels.layers[texel][l].sh; })
        .c;
}

// Texels of each placement that have light of their own.
std::vector<std::vector<std::uint32_t>> own_texels(std::span<const Lightmap> pages, std::size_t placements) {
    std::vector<std::vector<std::uint32_t>> out(placements);
    for (const Lightmap& page : pages)
        for (std::uint32_t i = 0; i < page.chart.size(); ++i)
            if (has_own_light(page, i)) out[page.chart[i]].push_back(i);
    return out;
}

Vec3 mean_irradiance(std::span<const Lightmap> pages, const LayerWeights& layers) {
    std::array<double, 3> sum{};
    double texels = 0.0;
    for (const Lightmap& page : pages)
        for (std::size_t i = 0; i < page.chart.size(); ++i) {
            if (!has_own_light(page, i)) continue;
            const Vec3 value = irradiance(page, i, layers);
            for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(value[c]);
            texels += 1.0;
        }
    Vec3 out{};
    for (std::size_t c = 0; c < 3; ++c) out[c] = texels > 0.0 ? static_cast<float>(sum[c] / texels) : 0.0f;
    return out;
}

// Variance about the mean of values given one by one (Welford 1962).
struct Spread {
    double n = 0.0, mean = 0.0, squares = 0.0;
    void add(double value) {
        n += 1.0;
        const double before = value - mean;
        mean += before / n;
        squares += before * (value - mean);
    }
    [[nodiscard]] double variance() const { return n > 0.0 ? squares / n : 0.0; }
};

class EvenChart {
public:
    EvenChart(const Lightmap& page, std::span<const std::uint32_t> texels, const CollapseRule& rule, Vec3 scene)
        : page_(page), texels_(texels), rule_(rule), scene_(scene) {}

    [[nodiscard]] bool is_even() const {
        constexpr double kOfScene = 0.01, kDeviations = 2.0, kMost = 4.0;
        for (std::size_t c = 0; c < 3; ++c) {
            Spread light, noise, albedo, shown;
            std::array<Spread, kShCoefficients> sh;
            for (const std::uint32_t i : texels_) {
                const Vec3 value = irradiance(page_, i, rule_.layers);
                light.add(static_cast<double>(value[c]));
                albedo.add(static_cast<double>(page_.surface.albedo[i][c]));
                shown.add(static_cast<double>(page_.surface.albedo[i][c] * value[c] + page_.surface.emission[i][c]));
                noise.add(rule_.has_noise ? static_cast<double>(page_.texels.variance[i][c]) : 0.0);
                const auto values = coefficients(page_, i, rule_.layers);
                for (std::size_t k = 0; k < kShCoefficients; ++k) sh[k].add(static_cast<double>(values[k][c]));
            }
            // The mean of squares of n normal numbers deviates by sqrt(2 / n) of itself.
            const double explained = noise.mean * (1.0 - kDeviations * std::sqrt(2.0 / light.n));
            const double floor = kOfScene * static_cast<double>(scene_[c]);
            const double allowed = rule_.share * (light.mean + floor);
            if (light.variance() - explained > allowed * allowed) return false;
            // What scene.glb shows: the textures of the surface, too.
            const double allowed_shown = rule_.share * (shown.mean + floor);
            if (shown.variance() - explained * albedo.mean * albedo.mean > allowed_shown * allowed_shown) return false;
            for (const std::uint32_t i : texels_) {
                const double sigma =
                    rule_.has_noise ? std::sqrt(static_cast<double>(page_.texels.variance[i][c])) : 0.0;
                const double off = std::abs(static_cast<double>(irradiance(page_, i, rule_.layers)[c]) - light.mean);
                if (off > kMost * (allowed + sigma)) return false;
            }
            // In units of the constant one, which is sqrt(pi) I under a sky of one colour; so is its noise.
            double beyond = 0.0;
            for (std::size_t k = 1; k < kShCoefficients; ++k) beyond += sh[k].variance() / (kShCoefficients - 1);
            const double allowed_sh = rule_.share * (sh[0].mean + std::sqrt(kPi) * floor);
            if (beyond - kPi * explained > allowed_sh * allowed_sh) return false;
        }
        return true;
    }

private:
    const Lightmap& page_;
    std::span<const std::uint32_t> texels_;
    const CollapseRule& rule_;
    Vec3 scene_;
};

}  // namespace

std::vector<bool> even_charts(std::span<const Lightmap> pages, const Atlas& atlas, const CollapseRule& rule) {
    const std::vector<std::vector<std::uint32_t>> texels = own_texels(pages, atlas.placements.size());
    const Vec3 scene = mean_irradiance(pages, rule.layers);
    std::vector<bool> out(atlas.placements.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
        const ChartPlacement& place = atlas.placements[k];
        const bool larger = place.box.width > kSmallest || place.box.height > kSmallest;
        if (place.page == kNone || !larger || texels[k].empty()) continue;
        out[k] = EvenChart(pages[place.page], texels[k], rule, scene).is_even();
    }
    return out;
}

std::vector<std::array<std::uint32_t, 2>> collapsed_sizes(const Atlas& atlas, const std::vector<bool>& collapse) {
    std::vector<std::array<std::uint32_t, 2>> out;
    for (std::size_t k = 0; k < atlas.placements.size(); ++k) {
        const ChartBox& box = atlas.placements[k].box;
        if (collapse[k])
            out.push_back({kSmallest, kSmallest});
        else
            out.push_back({box.width, box.height});
    }
    return out;
}

LayoutChange::LayoutChange(const Scene& scene, const ChartSet& charts, const Atlas& then,
                           std::span<const Lightmap> from, const Atlas& now, const std::vector<bool>& collapsed)
    : scene_(scene), charts_(charts), then_(then), from_(from), now_(now), collapsed_(collapsed) {
    LUMEL_CHECK(then.placements.size() == now.placements.size(), then.placements.size(), now.placements.size());
    texels_of_.resize(then.placements.size());
    for (std::uint32_t p = 0; p < then.pages.size(); ++p) {
        const Lightmap& page = from[p];
        const std::vector<std::uint32_t> readers = chart_ids(scene, charts, then, p);
        for (std::size_t pixel = 0; pixel < page.texel_at.size(); ++pixel) {
            const std::uint32_t texel = page.texel_at[pixel];
            if (texel == kNone || page.coverage[texel] == Coverage::none) continue;
            // Beyond what lookups read another chart may lie now.
            if (has_own_light(page, texel) || readers[pixel] == page.chart[texel])
                texels_of_[page.chart[texel]].push_back(static_cast<std::uint32_t>(pixel));
        }
    }
}

Result<Lightmap> LayoutChange::page(std::uint32_t page, std::uint32_t rings, Context& context) const {
    struct Source {
        std::uint32_t placement = kNone, texel = kNone;  // of `then`; no texel: the mean of its chart
        bool own = false;
    };
    Lightmap out;
    out.page = page;
    out.width = now_.pages[page].width;
    out.height = now_.pages[page].height;
    const std::vector<std::uint32_t> readers = chart_ids(scene_, charts_, now_, page);
    std::vector<Source> sources(readers.size());
    for (std::uint32_t k = 0; k < now_.placements.size(); ++k) {
        const ChartPlacement &then = then_.placements[k], &now = now_.placements[k];
        if (now.page != page || collapsed_[k]) continue;
        const Lightmap& from = from_[then.page];
        for (const std::uint32_t pixel : texels_of_[k]) {
            // Wraps around below zero and back.
            const std::uint32_t x = pixel % from.width - then.box.x + now.box.x;
            const std::uint32_t y = pixel / from.width - then.box.y + now.box.y;
            if (x >= out.width || y >= out.height) continue;
            Source& source = sources[std::size_t{y} * out.width + x];
            const std::uint32_t texel = from.texel_at[pixel];
            const bool own = has_own_light(from, texel);
            if (own || source.placement == kNone) source = {k, texel, own};
        }
    }
    for (std::size_t pixel = 0; pixel < readers.size(); ++pixel) {
        const std::uint32_t k = readers[pixel];
        if (k == kNone || !collapsed_[k] || sources[pixel].placement != kNone) continue;
        // What its bounds reach is its own, as where it had been baked at this size.
        const ChartBox& box = now_.placements[k].box;
        const std::size_t row = pixel / out.width, column = pixel % out.width;
        const double inset = now_.masks.inset() - 0.5;
        const double x = static_cast<double>(column) - box.x - inset, y = static_cast<double>(row) - box.y - inset;
        sources[pixel] = {k, kNone, x > -1.0 && y > -1.0 && x < kSmallest && y < kSmallest};
    }

    // As of a page that was baked: own light first, then what was dilated.
    out.texel_at.assign(sources.size(), kNone);
    std::uint32_t count = 0;
    for (const bool own : {true, false})
        for (std::size_t pixel = 0; pixel < sources.size(); ++pixel)
            if (sources[pixel].placement != kNone && sources[pixel].own == own) out.texel_at[pixel] = count++;
    resize_texels(out, count);
    if (!from_.empty() && !from_.front().leaks.empty()) out.leaks.resize(count);
    for (std::size_t pixel = 0; pixel < sources.size(); ++pixel) {
        if (pixel % out.width == 0 && context.cancelled()) return cancelled_error();
        const Source& source = sources[pixel];
        if (source.placement == kNone) continue;
        const Lightmap& from = from_[then_.placements[source.placement].page];
        const std::uint32_t to = out.texel_at[pixel];
        if (source.texel == kNone) {
            TexelMean mean(from);
            for (const std::uint32_t p : texels_of_[source.placement])
                if (const std::uint32_t texel = from.texel_at[p]; has_own_light(from, texel)) mean.add(texel);
            mean.store(out, to, source.placement);
            if (!source.own) out.coverage[to] = Coverage::dilated;
        } else {
            copy_texel(from, source.texel, out, to);
        }
    }
    for (std::uint32_t ring = 0; ring < rings; ++ring) LUMEL_TRY_STATUS(dilate_once(out, readers, context));
    return out;
}

}  // namespace lumel
