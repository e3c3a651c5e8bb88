#include "methods.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "base/parallel.h"
#include "flux_integrator.h"
#include "load.h"
#include "path/gather_page.h"
#include "path/light_cells.h"
#include "path/page_footprints.h"
#include "path/pooled_variance.h"

namespace lumel::bench {
namespace {

using Choice = LightSet::Choice;

Transport transport_through(const BenchScene& bench, const LightSet& lights) {
    return {bench.scene, bench.geometry, bench.surfaces, lights, *bench.tracer};
}

// What texels learn from their first samples.
enum class Learned : std::uint8_t { nothing, directions, lights, both };

RadianceSums gather(const GatherJob& job, const Transport& transport, Learned learned) {
    const BenchScene& b = job.bench;
    PathOptions path = job.path;
    path.guided = learned == Learned::directions || learned == Learned::both;
    path.lights_learned = learned == Learned::lights || learned == Learned::both;
    RadianceSums sums =
        need(gather_page(b.texels, b.charts, b.atlas, transport, path, job.range.first, job.range.count, job.context));
    need(pool_variance(b.texels, sums, job.context));
    return sums;
}

template <Choice choice>
RadianceSums brute_force(const GatherJob& job) {
    const BenchScene& b = job.bench;
    const LightSet lights(b.scene, b.geometry, b.surfaces, choice);
    return gather(job, transport_through(b, lights), Learned::nothing);
}

template <Learned learned>
RadianceSums with_cells(const GatherJob& job) {
    const BenchScene& b = job.bench;
    const LightSet lights(b.scene, b.geometry, b.surfaces, Choice::tree);
    Transport transport = transport_through(b, lights);
    const SurfaceCells cells = need(make_lit_cells(b.charts, b.atlas, transport, job.path, job.context));
    transport.cells = &cells;
    return gather(job, transport, learned);
}

RadianceSums flux_with(const GatherJob& job, const FluxChoices& choices, Choice choice) {
    const BenchScene& b = job.bench;
    const LightSet lights(b.scene, b.geometry, b.surfaces, choice);
    const FluxIntegrator integrator(transport_through(b, lights), job.path, choices);
    std::vector<FluxIntegrator::WorkspacePtr> workspaces(job.context.threads());
    for (auto& workspace : workspaces) workspace = integrator.make_workspace();
    RadianceSums sums;
    sums.resize(b.texels.size());
    const PageFootprints footprints(b.texels, transport_through(b, lights), b.charts, b.atlas);
    const bool done = parallel_for(job.context, job.range.count, 16, [&](const ChunkRange& chunk) {
        std::array<SamplePoint, kSamplesPerTexel> points;
        for (std::size_t i = job.range.first + chunk.begin; i < job.range.first + chunk.end; ++i)
            integrator.gather_texel(footprints.site(static_cast<std::uint32_t>(i), points), *workspaces[chunk.worker],
                                    sums, i);
    });
    if (!done) throw std::runtime_error("cancelled");
    return sums;
}

RadianceSums flux_uniform(const GatherJob& job) { return flux_with(job, {}, Choice::power); }

RadianceSums flux_all(const GatherJob& job) {
    FluxChoices choices;
    choices.next_event = FluxChoices::NextEvent::all_lights;
    return flux_with(job, choices, Choice::power);
}

template <Choice choice>
RadianceSums flux_as_lumel(const GatherJob& job) {
    return flux_with(job, kLumelsChoices, choice);
}

constexpr Method kMethods[] = {
    {"flux-uniform", "Frostbite's path tracer, one uniformly chosen light at each hit", true, flux_uniform},
    {"flux-all", "the same, all lights at each hit", true, flux_all},
    {"power", "Lumel's brute force, local lights chosen by power", true, brute_force<Choice::power>},
    {"tree", "Lumel's brute force, local lights chosen by the light tree", true, brute_force<Choice::tree>},
    {"cells", "the same, paths end at surface cells", true, with_cells<Learned::nothing>},
    {"guided", "cells, and first rays are guided", true, with_cells<Learned::directions>},
    {"lights", "cells, and local lights are chosen by what texels nearby have seen", true, with_cells<Learned::lights>},
    {"default", "Lumel's default: cells, guided first rays and learned lights", true, with_cells<Learned::both>},
    {"flux-as-power", "flux with all choices set to those of power: is it a fair one?", false,
     flux_as_lumel<Choice::power>},
    {"flux-as-tree", "flux with all choices set to those of tree", false, flux_as_lumel<Choice::tree>},
};

}  // namespace

std::span<const Method> methods() { return kMethods; }

const Method* find_method(std::string_view name) {
    const auto* found = std::ranges::find(kMethods, name, &Method::name);
    return found == std::end(kMethods) ? nullptr : found;
}

}  // namespace lumel::bench
