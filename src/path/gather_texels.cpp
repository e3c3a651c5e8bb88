// Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite" (sample points per texel, validity by back
// faces, the stop rule). Differs from it: Owen-scrambled Sobol points instead of rotated Halton; vertex normals; area
// lights and sky are combined by MIS; first rays may be guided.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "base/check.h"
#include "math/sampler.h"
#include "path/adaptive_samples.h"
#include "path/enclosed_points.h"
#include "path/path_integrator.h"
#include "path/path_workspace.h"
#include "path/trace_paths.h"
#include "path/visible_starts.h"

namespace lumel {
namespace {

constexpr std::uint32_t kFirstRound = 8;       // each is followed by as many samples as there are
constexpr std::uint32_t kMostRefinements = 2;  // of where a texel is seen: 64 points in a sixteenth of its breadth

// Of the 64 points of a texel: where no more are seen, they lie so close to what hides the others that their light says
// little of where lookups read the texel.
constexpr int kSliver = 8;
// Where a texel looks for what is seen of it. The strips are the outer halves of where it is looked up, of which too
// few points tell.
struct FootprintToTry {
    Footprint footprint;
    FootprintPart part;
};
constexpr float kStrip = 0.125f;
constexpr FootprintToTry kFootprints[] = {{Footprint::whole, {}},
                                          {Footprint::lookup, {}},
                                          {Footprint::lookup, {{0, 0}, {kStrip, 1}}},
                                          {Footprint::lookup, {{1 - kStrip, 0}, {1, 1}}},
                                          {Footprint::lookup, {{0, 0}, {1, kStrip}}},
                                          {Footprint::lookup, {{0, 1 - kStrip}, {1, 1}}}};
constexpr std::size_t kFirstStrip = 2;
// Of a texel: a finer look would take most of the time of fewer, whose noise hides what it finds.
constexpr std::uint32_t kFewestSamplesForStrips = 16;
constexpr std::size_t kSomePoints = 16;  // of a texel, spread evenly
constexpr std::uint32_t kFewestSamplesForGuide = 64;
// Of a texel; its block has seen enough of its lights by then. Each new table begins a new sequence of choices, and a
// choice is the more even the longer its sequence.
constexpr std::uint32_t kLightsKnownFrom = 4 * kFirstRound;

// Around where all paths of a texel start.
ReceiverRegion region_of(std::span<const SurfaceStart> starts) {
    constexpr float kRounding = 1e-5f;  // of what is compared with it
    Vec3 low = starts[0].origin, high = low, normals{};
    for (const SurfaceStart& start : starts) {
        for (std::size_t c = 0; c < 3; ++c) {
            low[c] = std::min(low[c], start.origin[c]);
            high[c] = std::max(high[c], start.origin[c]);
        }
        normals += start.normal;
    }
    ReceiverRegion region{low + (high - low) * 0.5f, normalize_or(normals, starts[0].normal)};
    for (const SurfaceStart& start : starts) {
        region.radius = std::max(region.radius, length(start.origin - region.centre));
        region.cos_normals = std::min(region.cos_normals, dot(start.normal, region.axis));
    }
    region.radius *= 1.0f + kRounding;
    region.cos_normals = std::max(-1.0f, region.cos_normals - kRounding);
    return region;
}

}  // namespace

void PathIntegrator::begin_texel(const GatherSite& site, Workspace& w, TexelState& texel) const {
    LUMEL_CHECK(!site.points.empty() && site.points.size() <= kSamplesPerTexel, site.points.size());
    // Even and odd samples are each a point set of its own: what they differ by tells the noise (pool_variance()).
    const std::uint32_t key = sampler_key(options_.seed, site.id);
    texel.half_keys = {key, mix32(key)};
    texel.both_sides =
        options_.two_sided && (transport_.geometry.triangles[site.points[0].triangle].flags & kDoubleSided) != 0;
    const std::size_t n = texel.points =
        texel.both_sides ? site.points.size() : choose_starts(site, key, w, texel.surfaces).count;
    if (texel.both_sides) {
        std::fill(w.sides.begin(), w.sides.end(), std::uint8_t{0});
        surface_starts(site.points, std::span(w.sides).first(n), w, texel.surfaces);
        std::fill(w.sides.begin(), w.sides.end(), std::uint8_t{1});
        surface_starts(site.points, std::span(w.sides).first(n), w, texel.back_surfaces);
        // The lid of a solid has one side: its mean with what is inside would be half as bright.
        const VisibleStarts finder(transport_.tracer, transport_.geometry, w.rays, w.hits);
        const bool front_shut = finder.is_shut(std::span(texel.surfaces).first(n), mix32(key + 1));
        const bool back_shut = finder.is_shut(std::span(texel.back_surfaces).first(n), mix32(key + 2));
        texel.both_sides = front_shut == back_shut;
        if (front_shut && !back_shut) texel.surfaces = texel.back_surfaces;
    }
    find_sunlit(std::span(texel.surfaces).first(n), false, w);
    if (texel.both_sides) find_sunlit(std::span(texel.back_surfaces).first(n), false, w);
}

// A texel cut by a wall gathers from all of its square that is seen from each other. One that nothing is seen of can
// be read nevertheless, by lookups beside what hides it: it gathers from the points of those, as they weigh it.
ChosenStarts PathIntegrator::choose_starts(const GatherSite& site, std::uint32_t key, Workspace& w,
                                           std::span<SurfaceStart> starts) const {
    const VisibleStarts finder(transport_.tracer, transport_.geometry, w.rays, w.hits);
    const auto find = [&](std::size_t n, std::uint64_t valid, std::span<const std::uint32_t> triangles) {
        const auto enclosed_of_first = [&](std::size_t count) {
            return enclosed_points(starts.first(count), kEnclosureReach * site.texel_size, mix32(key),
                                   transport_.tracer, transport_.geometry, w.rays, w.hits);
        };
        std::uint64_t enclosed = 0;
        if (any_double_sided_) {
            // Where all of some are shut in, so little is seen that other footprints say more of it.
            const std::size_t some = std::min(n, kSomePoints);
            enclosed = enclosed_of_first(some);
            if (static_cast<std::size_t>(std::popcount(enclosed)) == some) return VisibleStarts::Found{};
            if (n > some) enclosed = enclosed_of_first(n);
        }
        return finder.find({valid, triangles, site.texel_size, enclosed}, starts.first(n), mix32(key + 1));
    };
    const std::size_t n = site.points.size();
    std::fill(w.sides.begin(), w.sides.end(), std::uint8_t{0});
    surface_starts(site.points, std::span(w.sides).first(n), w, starts);
    const VisibleStarts::Points usual{site.valid, site.triangles, site.texel_size};
    if (!site.footprints || finder.all_open(usual, starts.first(n), mix32(key + 1))) return {n, StartsPlace::usual};

    if (static_cast<std::size_t>(std::popcount(find(n, site.valid, site.triangles).best)) == n)
        return {n, StartsPlace::usual};

    const bool few_samples = options_.samples < kFewestSamplesForStrips;
    const std::size_t places = few_samples ? kFirstStrip : std::size(kFootprints);
    const std::uint32_t refinements = few_samples ? 0 : kMostRefinements;
    for (const FootprintToTry& place : std::span(kFootprints).first(places)) {
        const StartsPlace of_footprint = place.footprint == Footprint::whole ? StartsPlace::part : StartsPlace::lookups;
        const auto read_part = [&](const FootprintPart& part) {
            site.footprints->read(site.texel, place.footprint, part, w.points);
            const auto points = std::span<const SamplePoint>(w.points.at).first(w.points.count);
            surface_starts(points, std::span(w.sides).first(points.size()), w, starts);
        };
        VisibleStarts::Found found;
        FootprintPart found_in;
        std::optional<FootprintPart> part = place.part;
        for (std::uint32_t attempt = 0; attempt <= refinements && part; ++attempt) {
            read_part(*part);
            const VisibleStarts::Found now =
                w.points.count == 0 ? VisibleStarts::Found{} : find(w.points.count, w.points.valid, w.points.triangles);
            const bool is_sliver =
                attempt == 0 && place.footprint == Footprint::whole && std::popcount(now.best) <= kSliver;
            if (now.best == 0 || is_sliver) break;
            found = now;
            found_in = *part;
            part = part_to_refine(*part, w.points.valid, found);
            if (!part || attempt == refinements)
                return {keep_starts(starts.first(w.points.count), found.best), of_footprint};
        }
        if (found.best == 0) continue;
        read_part(found_in);  // a finer look at it found nothing
        return {keep_starts(starts.first(w.points.count), found.best), of_footprint};
    }
    surface_starts(site.points, std::span(w.sides).first(n), w, starts);
    return {n, StartsPlace::hidden};
}

bool PathIntegrator::gather_samples(std::uint32_t first, std::uint32_t last, bool learning, Workspace& w,
                                    std::size_t which, const Context& context) const {
    TexelState& texel = w.texels[which];
    const Guides guides{w.guide ? &*w.guide : nullptr, w.learns_lights ? w.light_statistics.table(which) : nullptr,
                        w.light_rate};
    for (std::uint32_t base = first, lanes = 0; base < last; base += lanes) {
        if (context.cancelled()) return false;
        lanes = std::min(static_cast<std::uint32_t>(kWavefrontLanes), last - base);
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            const std::uint32_t sample = base + lane;
            const std::uint32_t half = sample & 1u, index = sample / 2;
            // Both sides take turns in pairs, so that each side meets every sample point.
            const bool back = texel.both_sides && ((index ^ (index / kSamplesPerTexel)) & 1u) != 0;
            // Where there are fewer samples than points, the halves start from different ones.
            const std::size_t point =
                point_of(index + half * static_cast<std::uint32_t>(texel.points / 2), texel.half_keys[0], texel.points);
            const SurfaceStart& start = (back ? texel.back_surfaces : texel.surfaces)[point];
            w.starts[lane] = {start.origin, start.normal, texel.half_keys[half], index, start.skip, start.sunlit};
        }
        const auto starts = std::span<const PathStart>(w.starts).first(lanes);
        texel.sink.begin(starts, texel.both_sides ? 2.0f : 1.0f);
        trace_paths(starts, w, texel.sink, guides);
        texel.sink.end();
        if (w.learns_lights) w.learn_of_lights(which, lanes);
        if (!learning) continue;
        for (std::uint32_t lane = 0; lane < lanes; ++lane)
            w.guide_statistics.add((base + lane) & 1u, w.first_draw[lane].point, w.first_draw[lane].density,
                                   w.first_radiance[lane]);
    }
    return true;
}

bool PathIntegrator::gather_until_converged(Workspace& w, std::size_t which, const Context& context) const {
    const std::uint32_t step = (options_.samples + 9) / 10;
    for (std::uint32_t first = 0; first < options_.samples; first += step) {
        if (!gather_samples(first, std::min(first + step, options_.samples), false, w, which, context)) return false;
        if (w.texels[which].sink.converged(options_.relative_error_of_mean)) break;
    }
    return true;
}

void PathIntegrator::gather_texels(std::span<const GatherSite> sites, std::span<const std::uint32_t> indices,
                                   Workspace& w, RadianceSums& out, const Context& context) const {
    LUMEL_CHECK(sites.size() == indices.size() && sites.size() <= kMostTexelsTogether, sites.size(), indices.size());
    w.texels.clear();
    for (const GatherSite& site : sites) begin_texel(site, w, w.texels.emplace_back(options_));
    w.forget();
    if (options_.stop == StopRule::flux) {
        for (std::size_t k = 0; k < w.texels.size(); ++k)
            if (!gather_until_converged(w, k, context)) return;
    } else if (!gather_rounds(w, context)) {
        return;
    }
    for (std::size_t k = 0; k < sites.size(); ++k) w.texels[k].sink.store(out, indices[k]);
}

bool PathIntegrator::gather_rounds(Workspace& w, const Context& context) const {
    const std::uint32_t budget = options_.samples;
    const bool adaptive = options_.stop == StopRule::error;
    // A guide is of one side.
    const bool may_learn = budget >= kFewestSamplesForGuide && std::ranges::none_of(w.texels, &TexelState::both_sides);
    const bool guided = may_learn && options_.guided;
    w.learns_lights = may_learn && options_.lights_learned;
    if (w.learns_lights) {
        std::array<ReceiverRegion, kMostTexelsTogether> regions;
        for (std::size_t k = 0; k < w.texels.size(); ++k)
            regions[k] = region_of(std::span(w.texels[k].surfaces).first(w.texels[k].points));
        w.light_statistics.begin(transport_.lights, std::span(regions).first(w.texels.size()));
    }
    std::array<std::uint32_t, kMostTexelsTogether> wanted;
    std::array<TexelProgress, kMostTexelsTogether> progress;
    wanted.fill(budget);
    std::uint32_t last = guided || w.learns_lights || adaptive ? kFirstRound : budget;
    for (std::uint32_t first = 0; first < budget; first = last, last *= 2) {
        last = std::min(last, budget);
        if (guided && first > 0) w.guide = w.guide_statistics.learn();
        if (w.learns_lights && first > 0 && first <= kLightsKnownFrom) w.light_statistics.learn();
        if (w.learns_lights && first == kFirstRound) w.light_rate = w.light_rate_statistics.rate(kFirstRound / 2);
        if (adaptive && first >= kFewestAdaptiveSamples) {
            for (std::size_t k = 0; k < w.texels.size(); ++k) progress[k] = w.texels[k].sink.progress();
            adaptive_samples(std::span(progress).first(w.texels.size()), options_.relative_error_of_mean, budget,
                             std::span(wanted).first(w.texels.size()));
        }
        bool any = false;
        for (std::size_t k = 0; k < w.texels.size(); ++k) {
            const std::uint32_t from = w.texels[k].sink.traced(), to = std::min(last, wanted[k]);
            if (from < to && !gather_samples(from, to, guided, w, k, context)) return false;
            any = any || wanted[k] > last;
        }
        if (!any) break;
    }
    return true;
}

}  // namespace lumel
