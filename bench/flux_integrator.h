// The peer: Frostbite's path tracer as it was published, on Lumel's tracer, origins and sums, so that what is compared
// is the way light is sampled.
// Based on: O'Donnell 2018, "Precomputed Global Illumination in Frostbite": up to 64 points per texel, one of them
// chosen at random for each path; first rays uniform over the hemisphere, Halton points with a random rotation per
// texel; next-event estimation; the sky by rays that miss; a texel stops where its own standard error is small. What
// the slides leave open is chosen in its favour: cosine-weighted bounces, roulette from the third one, Halton
// dimensions for the light samples of the first two vertices. No multiple importance sampling: lights are sampled, and
// rays that hit one by chance do not count it. No cache. Skies with a sun in them need it taken out beforehand, as it
// was there.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "flux_lights.h"
#include "flux_numbers.h"
#include "path/path_integrator.h"
#include "path/texel_sink.h"

namespace lumel::bench {

// What differs from Lumel's brute force; each can be set to Lumel's choice, to see that nothing else does.
struct FluxChoices {
    enum class NextEvent : std::uint8_t {
        one_light,   // chosen uniformly among all
        all_lights,  // each of them
        light_set    // Lumel's: each sun, one local light of the LightSet, sky maps; combined with the rays by MIS
    };
    enum class Hemisphere : std::uint8_t {
        uniform,
        gather  // Lumel's: density (1/2 + cos)/(2 pi)
    };
    enum class Origins : std::uint8_t {
        random,
        in_turn  // Lumel's
    };
    NextEvent next_event = NextEvent::one_light;
    Hemisphere hemisphere = Hemisphere::uniform;
    FluxPoints points = FluxPoints::halton;
    Origins origins = Origins::random;
};

inline constexpr FluxChoices kLumelsChoices{FluxChoices::NextEvent::light_set, FluxChoices::Hemisphere::gather,
                                            FluxPoints::sobol, FluxChoices::Origins::in_turn};

class FluxIntegrator {
public:
    FluxIntegrator(const Transport& transport, const PathOptions& options, const FluxChoices& choices);

    // Scratch memory of one thread.
    struct Workspace;
    struct WorkspaceDeleter {
        void operator()(Workspace* workspace) const;
    };
    using WorkspacePtr = std::unique_ptr<Workspace, WorkspaceDeleter>;
    [[nodiscard]] WorkspacePtr make_workspace() const;

    // As PathIntegrator::gather_texel. One side only.
    void gather_texel(const GatherSite& site, Workspace& workspace, RadianceSums& out, std::size_t index) const;

private:
    void trace_paths(std::size_t count, Workspace& w, TexelSink& sink) const;
    void start_paths(std::size_t count, Workspace& w) const;
    void tell_first_hits(std::size_t count, Workspace& w, TexelSink& sink) const;
    void sample_lights(std::uint32_t lane, std::uint32_t vertex, Workspace& w) const;
    void push(std::uint32_t lane, std::uint32_t vertex, Layer layer, const LightSample& sample, float weight,
              Workspace& w) const;
    void resolve_lights(std::uint32_t vertex, Workspace& w, TexelSink& sink) const;
    void meet_lights(std::uint32_t lane, std::uint32_t vertex, const Hit& hit, Workspace& w, TexelSink& sink) const;
    bool stand_on(std::uint32_t lane, const Hit& hit, Workspace& w) const;
    bool go_on(std::uint32_t lane, std::uint32_t vertex, Workspace& w) const;
    [[nodiscard]] float direction_pdf(std::uint32_t vertex, float cosine) const;
    [[nodiscard]] FluxNumbers numbers(std::uint32_t lane, const Workspace& w) const;
    [[nodiscard]] bool uses_light_set() const { return choices_.next_event == FluxChoices::NextEvent::light_set; }

    Transport transport_;
    PathOptions options_;
    FluxChoices choices_;
    FluxLights lights_;
    HaltonTable halton_;
    PathIntegrator lumel_;  // for the origins
};

}  // namespace lumel::bench
