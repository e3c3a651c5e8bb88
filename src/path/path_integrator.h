// The integrator: unidirectional path tracing with next-event estimation and multiple importance sampling, in
// wavefronts of paths. Without surface cells it is brute force, the truth that all else is measured against.
//
// Which rays a texel sends (docs/conventions.md, "The hemisphere of a texel"): the upper hemisphere of the vertex
// normal, with density (1/2 + cos)/(2 pi) unless they are guided, from the sample points of the texel that lookups
// show. Backs of single-sided surfaces are black. Texels that see little else lie inside or below something, and are
// invalid.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cells/surface_cells.h"
#include "light/light_set.h"
#include "lumel/options.h"
#include "path/light_rate.h"
#include "path/radiance_sums.h"
#include "scene/surface.h"
#include "texel/texel_buffer.h"
#include "trace/tracer.h"

namespace lumel {

class HemisphereGuide;
struct LightTable;

inline constexpr std::size_t kWavefrontLanes = 256;
inline constexpr std::size_t kMaxPointSuns = 32;
inline constexpr std::size_t kMostTexelsTogether = 64;

struct PathOptions {
    std::uint32_t samples = 512;
    std::uint32_t bounces = 64;
    std::uint64_t seed = 1;
    float ao_distance = 1.0f;  // metres
    bool two_sided = false;
    // What texels nearby have seen: first rays follow it (path/hemisphere_guide.h), and lights are chosen by it
    // (path/light_statistics.h).
    bool guided = false, lights_learned = false;
    StopRule stop = StopRule::fixed;
    double relative_error_of_mean = 0.0;  // StopRule::error and flux: error / z(confidence)
    // Artist's factors of the layers, and which of them the total (its variance, pictures) sums.
    std::array<float, kLayerCount> layer_scale{1, 1, 1};
    std::array<bool, kLayerCount> included{true, true, true};
};

// What texels and pictures of a bake have in common: length and seed of the paths, the layers and their scales.
PathOptions transport_options(const BakeOptions& options);

// What a path is traced through. Borrowed; all of it is const while paths run.
struct Transport {
    const Scene& scene;
    const WorldGeometry& geometry;
    SurfaceReader surfaces;
    const LightSet& lights;
    const Tracer& tracer;
    const SurfaceCells* cells = nullptr;  // where paths may end after a bounce; null: brute force
};

// Where a path starts: a point that looks out over the hemisphere of `normal`.
struct PathStart {
    Vec3 origin;                 // already lifted off its surface
    Vec3 normal;                 // of the hemisphere: the vertex normal that the runtime shades with
    std::uint32_t key = 0;       // point set (math/sampler.h)
    std::uint32_t index = 0;     // sample in it
    std::uint32_t skip = kNone;  // the triangle that it lies on, where no direction of the hemisphere is below it
    std::uint32_t sunlit = 0;    // SurfaceStart::sunlit
};

// Origin and normal of a sample point: smooth position where it is reachable, else the offset flat point.
struct SurfaceStart {
    Vec3 origin, normal;
    std::uint32_t skip = kNone;  // PathStart::skip
    std::uint32_t sunlit = 0;    // bit k: reached by sun k, which has no size; known where many samples share the point
};

// Which points of a texel it gathers from.
enum class StartsPlace : std::uint8_t {
    usual,    // all of them are seen
    part,     // those of its square that are seen: something stands on the rest
    lookups,  // its square is hidden; those beside it, where lookups read the texel
    hidden,   // nothing is seen there either: the usual ones, whose light no lookup shows
};
struct ChosenStarts {
    std::size_t count = 0;
    StartsPlace place = StartsPlace::usual;
};

// Points of a texel in other footprints than the one it gathers from if nothing is in its way.
class FootprintSource {
public:
    virtual ~FootprintSource() = default;
    virtual void read(std::size_t texel, Footprint footprint, const FootprintPart& part, TexelPoints& out) const = 0;
};

// Where a texel gathers.
struct GatherSite {
    std::span<const SamplePoint> points;
    std::uint64_t id;  // names the texel for good (page and position), whatever range, thread or shard it is baked in
    float texel_size;  // metres
    // Of texels, not of cells: which Hammersley points these are, the triangles that they lie in (ascending), and where
    // there are others, should some of them be hidden (path/visible_starts.h); null: nowhere.
    std::uint64_t valid = 0;
    std::span<const std::uint32_t> triangles = {};
    const FootprintSource* footprints = nullptr;
    std::size_t texel = 0;  // as footprints->read() knows it
};

class PathIntegrator {
public:
    PathIntegrator(const Transport& transport, const PathOptions& options);
    ~PathIntegrator();

    // Scratch memory of one thread; nothing is allocated per sample.
    class Workspace;
    struct WorkspaceDeleter {
        void operator()(Workspace* workspace) const;
    };
    using WorkspacePtr = std::unique_ptr<Workspace, WorkspaceDeleter>;
    [[nodiscard]] WorkspacePtr make_workspace() const;

    // Gathers all samples of texels that lie together (at most kMostTexelsTogether), and share what guides their paths,
    // into out[indices]. Stops early, leaving the texels untouched, if `context` is cancelled.
    void gather_texels(std::span<const GatherSite> sites, std::span<const std::uint32_t> indices, Workspace& workspace,
                       RadianceSums& out, const Context& context) const;

    // What paths from a cell bring to it by themselves, and one link for each that ends at another cell. As many paths
    // as there are links; their light is what a bounce sees of it.
    void gather_cell(const GatherSite& site, bool back, Workspace& workspace, CellGather& out,
                     std::span<CellLink> links) const;

    // Irradiance I about the start's normal of each path (at most kWavefrontLanes), all included layers. For pictures:
    // `lumel render`. `met_back`: empty, or 1 where the first ray met the back of a single-sided surface.
    void gather_irradiance(std::span<const PathStart> starts, Workspace& workspace, std::span<Vec3> irradiance,
                           std::span<std::uint8_t> met_back = {}) const;

    // Lifts points off their surfaces: batch form, for the visibility test of smooth positions.
    void surface_starts(std::span<const SamplePoint> points, std::span<const std::uint8_t> back_side,
                        Workspace& workspace, std::span<SurfaceStart> out) const;

    // Starts of a texel's points that lookups show, at the front of `starts`. `key`: of random directions.
    ChosenStarts choose_starts(const GatherSite& site, std::uint32_t key, Workspace& workspace,
                               std::span<SurfaceStart> starts) const;

private:
    struct TexelState;
    void begin_texel(const GatherSite& site, Workspace& workspace, TexelState& texel) const;
    // Samples first to last - 1 of a texel of the workspace. `learning`: for the guide, too. These return false where
    // cancelled.
    bool gather_samples(std::uint32_t first, std::uint32_t last, bool learning, Workspace& workspace, std::size_t texel,
                        const Context& context) const;
    // All samples of the workspace's texels, each round as many as there were before; between them the guide is learned
    // and the samples are allotted.
    bool gather_rounds(Workspace& workspace, const Context& context) const;
    // By Frostbite's rule.
    bool gather_until_converged(Workspace& workspace, std::size_t texel, const Context& context) const;
    // Fills in `sunlit`, where knows_point_suns_.
    void find_sunlit(std::span<SurfaceStart> starts, bool bounced, Workspace& workspace) const;
    // What is known of the light around the starts; null: nothing.
    struct Guides {
        const HemisphereGuide* directions = nullptr;
        const LightTable* lights = nullptr;
        LightRate rate;
    };
    template <class Sink>
    void trace_paths(std::span<const PathStart> starts, Workspace& workspace, Sink& sink, const Guides& guides) const;

    Transport transport_;
    PathOptions options_;
    std::uint32_t pairs_per_vertex_;
    bool any_double_sided_;  // else no point can be enclosed
    // One shadow ray a point says for all its samples whether a sun without size reaches it: where there are at least
    // as many samples as points, and no surface lets light through by chance.
    bool knows_point_suns_;
};

}  // namespace lumel
