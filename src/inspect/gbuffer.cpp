#include "inspect/gbuffer.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/check.h"
#include "base/progress_parts.h"
#include "base/try.h"
#include "texel/ray_offset.h"

namespace lumel {
namespace {

enum CoverageCategory : std::uint8_t { kWhole, kRim, kThin, kCoverageDilated };
constexpr std::array<Category, 4> kCoverageCategories{{
    {"covered whole", {0.62f, 0.70f, 0.62f}},
    {"in part", {0.98f, 0.80f, 0.25f}},
    {"thinner than its 64 points lie apart", {0.88f, 0.16f, 0.16f}},
    {"dilated", {0.18f, 0.27f, 0.45f}},
}};

enum StateCategory : std::uint8_t { kUsual, kFlat, kPart, kLookups, kHidden, kFilled, kStateDilated };
constexpr std::array<Category, 7> kStateCategories{{
    {"usual", {0.70f, 0.72f, 0.70f}},
    {"flat: no way to the smooth position", {0.34f, 0.71f, 0.91f}},
    {"moved to what is seen of it", {0.98f, 0.85f, 0.25f}},
    {"moved to where lookups read it", {0.95f, 0.50f, 0.05f}},
    {"hidden, as are its lookups", {0.50f, 0.28f, 0.70f}},
    {"invalid: saw backs, filled", {0.85f, 0.08f, 0.08f}},
    {"dilated", {0.18f, 0.27f, 0.45f}},
}};

// One texel of a page, for the layers to read.
struct TexelView {
    const BakedLayout& layout;
    const GBufferPage& page;
    std::size_t i;
    Coverage coverage;

    [[nodiscard]] const TexelBuffer& texels() const { return page.texels; }
    [[nodiscard]] const WorldGeometry& geometry() const { return layout.transport.geometry; }
    [[nodiscard]] SamplePoint point() const {
        return representative_point(page.texels, i, layout.transport.scene, geometry(), layout.charts, layout.atlas);
    }
    [[nodiscard]] Vec3 smooth() const {
        const auto [triangle, b1, b2] = point();
        return smooth_position(geometry(), triangle, b1, b2, false);
    }
};

float coverage_category(const TexelView& t) {
    const std::uint64_t valid = t.texels().valid[t.i];
    return ~valid == 0 ? kWhole : valid != 0 ? kRim : kThin;
}

float state_category(const TexelView& t) {
    if (t.coverage == Coverage::filled) return kFilled;
    switch (t.page.starts.place[t.i]) {
        case StartsPlace::part: return kPart;
        case StartsPlace::lookups: return kLookups;
        case StartsPlace::hidden: return kHidden;
        case StartsPlace::usual: break;
    }
    return t.page.starts.flat_share[t.i] > 0.0f ? kFlat : kUsual;
}

void store(Vec3 v, std::span<float> out) {
    for (std::size_t c = 0; c < 3; ++c) out[c] = v[c];
}

using Read = void (*)(const TexelView&, std::span<float> out);
struct Entry {
    TexelLayer layer;
    GBufferNeeds needs;
    Read read;
};

const std::vector<std::string> kNumber{"Y"}, kVector{"X", "Y", "Z"}, kColor{"R", "G", "B"};

const std::vector<Entry>& entries() {
    static const std::vector<Entry> kEntries{
        {{"state", "how each texel was baked: invalid, moved, flat", "", ColorRule::category, kNumber,
          kStateCategories},
         {false, true},
         [](const TexelView& t, std::span<float> out) { out[0] = state_category(t); }},
        {{"coverage", "texels that a triangle overlaps, be it a sliver", "", ColorRule::category, kNumber,
          kCoverageCategories},
         {},
         [](const TexelView& t, std::span<float> out) { out[0] = coverage_category(t); }},
        {{"covered-share", "share of the 64 points of a texel that lie on its chart", "1", ColorRule::share, kNumber},
         {},
         [](const TexelView& t, std::span<float> out) {
             out[0] = static_cast<float>(std::popcount(t.texels().valid[t.i])) / static_cast<float>(kSamplesPerTexel);
         }},
        {{"flat-share", "share of its points that start from the flat facet of a smooth surface", "1", ColorRule::share,
          kNumber},
         {false, true},
         [](const TexelView& t, std::span<float> out) { out[0] = t.page.starts.flat_share[t.i]; }},
        {{"position", "place of the texel on its triangle", "m", ColorRule::place, kVector},
         {},
         [](const TexelView& t, std::span<float> out) { store(t.texels().position[t.i], out); }},
        {{"smooth-position", "place on the curved surface that the vertex normals describe", "m", ColorRule::place,
          kVector},
         {},
         [](const TexelView& t, std::span<float> out) { store(t.smooth(), out); }},
        {{"smooth-lift", "from the flat to the smooth position", "m", ColorRule::heat, kNumber},
         {},
         [](const TexelView& t, std::span<float> out) { out[0] = length(t.smooth() - t.texels().position[t.i]); }},
        {{"face-normal", "normal of the triangle", "1", ColorRule::direction, kVector},
         {},
         [](const TexelView& t, std::span<float> out) {
             store(t.geometry().geometric_normal(t.point().triangle), out);
         }},
        {{"normal", "interpolated vertex normal, about which light is gathered", "1", ColorRule::direction, kVector},
         {},
         [](const TexelView& t, std::span<float> out) { store(t.texels().normal[t.i], out); }},
        {{"texel-size", "metres across a texel: the longer edge of its parallelogram", "m", ColorRule::log_heat,
          kNumber},
         {},
         [](const TexelView& t, std::span<float> out) { out[0] = t.texels().world_size[t.i]; }},
        {{"triangle", "the triangle at the texel, numbered over the scene", "", ColorRule::identity, kNumber},
         {},
         [](const TexelView& t, std::span<float> out) { out[0] = static_cast<float>(t.point().triangle); }},
        {{"chart", "the chart that owns the texel, as in manifest.json", "", ColorRule::identity, kNumber},
         {},
         [](const TexelView& t, std::span<float> out) { out[0] = static_cast<float>(t.texels().chart[t.i]); }},
        {{"albedo", "diffuse reflectance, mean over the texel", "1", ColorRule::reflectance, kColor},
         {true, false},
         [](const TexelView& t, std::span<float> out) { store(t.page.surface.albedo[t.i], out); }},
        {{"emission", "what the front sends out by itself, mean over the texel", "nits", ColorRule::light, kColor},
         {true, false},
         [](const TexelView& t, std::span<float> out) { store(t.page.surface.emission[t.i], out); }},
    };
    return kEntries;
}

const Entry& entry_of(const TexelLayer& layer) {
    const auto found =
        std::ranges::find_if(entries(), [&](const Entry& entry) { return entry.layer.name == layer.name; });
    LUMEL_CHECK(found != entries().end(), layer.name);
    return *found;
}

// The category of dilated texels, which two layers show although they are not rasterised.
constexpr float kNoCategory = -1.0f;
float dilated_category(const TexelLayer& layer) {
    if (layer.categories.data() == kStateCategories.data()) return kStateDilated;
    if (layer.categories.data() == kCoverageCategories.data()) return kCoverageDilated;
    return kNoCategory;
}

}  // namespace

std::span<const TexelLayer> gbuffer_layers() {
    static const std::vector<TexelLayer> kLayers = [] {
        std::vector<TexelLayer> out;
        for (const Entry& entry : entries()) out.push_back(entry.layer);
        return out;
    }();
    return kLayers;
}

GBufferNeeds needs_of(const TexelLayer& layer) { return entry_of(layer).needs; }

Result<std::vector<GBufferPage>> make_gbuffer(const BakedLayout& layout, const PathOptions& options,
                                              const GBufferNeeds& needs, Context& context) {
    const Scene& scene = layout.transport.scene;
    const WorldGeometry& geometry = layout.transport.geometry;
    const auto by_page = triangles_by_page(scene, geometry, layout.charts, layout.atlas);
    std::vector<GBufferPage> out;
    ProgressParts progress(context, static_cast<double>(by_page.size()));
    for (std::uint32_t p = 0; p < by_page.size(); ++p) {
        progress.begin(1.0);
        GBufferPage page;
        LUMEL_TRY(page.texels, rasterize_page(scene, geometry, layout.charts, layout.atlas, p, by_page[p], context));
        if (needs.surface) {
            LUMEL_TRY(page.surface,
                      read_texel_surface(page.texels, scene, geometry, layout.charts, layout.atlas, context));
        }
        if (needs.starts) {
            LUMEL_TRY(page.starts,
                      find_texel_starts(page.texels, layout.charts, layout.atlas, layout.transport, options, context));
        }
        out.push_back(std::move(page));
    }
    return out;
}

LayerPage gbuffer_layer(const TexelLayer& layer, const BakedLayout& layout, const GBufferPage& page,
                        std::span<const Coverage> coverage) {
    const Entry& entry = entry_of(layer);
    const TexelBuffer& texels = page.texels;
    LUMEL_CHECK(coverage.size() == texels.texel_at.size(), coverage.size(), texels.texel_at.size());
    LayerPage out(texels.width, texels.height, layer);
    const std::size_t channels = layer.channels.size();
    const float dilated = dilated_category(layer);
    for (std::size_t pixel = 0; pixel < coverage.size(); ++pixel) {
        const std::uint32_t i = texels.texel_at[pixel];
        if (i == kNone) {
            if (coverage[pixel] != Coverage::dilated || dilated == kNoCategory) continue;
            out.values.data[pixel] = dilated;
            out.presence[pixel] = Presence::dilated;
            continue;
        }
        entry.read({layout, page, i, coverage[pixel]}, std::span(&out.values.data[pixel * channels], channels));
        out.presence[pixel] = Presence::covered;
    }
    return out;
}

}  // namespace lumel
