// What a user can ask of a bake. Plain data: each member says its default, unit, range and the meaning of zero.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "lumel/vec.h"

namespace lumel {

// Texel budget and samples where neither density nor samples are asked: preview 0.25 M texels, 256 samples;
// medium 2 M, 512; production 8 M, 4096. Previews are denoised.
enum class Preset : std::uint8_t { preview, medium, production };

struct PresetValues {
    double texel_budget;
    std::uint32_t samples;
    bool denoise;
};
PresetValues preset_values(Preset preset);

struct BakeOptions;
// Samples per texel that are taken at most. Where neither --samples says so nor all texels take the same, eight times
// those of the preset.
std::uint32_t sample_budget(const BakeOptions& options);

struct AtlasRecord;  // chart/atlas_record.h

// How renderers look lightmaps up.
enum class LookupFilter : std::uint8_t {
    bilinear,  // 2 x 2 texels
    bicubic,   // 4 x 4: the uniform cubic B-spline, as shaders do it in four bilinear lookups
};

enum class Uv1Choice : std::uint8_t { automatic, scene, mesh, ignore };

// Which layers the lightmap files sum; the master always keeps all.
struct Include {
    bool direct = true, sky = true, indirect = true;
};

// How the number of samples of a texel is decided.
enum class StopRule : std::uint8_t {
    fixed,  // every texel takes `samples`
    error,  // each texel until `error` at `confidence`, by what its neighbours have measured; `samples` is the budget
    flux,   // Frostbite 2018: every 10 % of the budget, stop where the texel's own standard error is within `error` of
            // its mean at `confidence`. Biased dark on rare-event light; kept as the published baseline
};

// Where the paths of a texel end.
enum class Integrator : std::uint8_t {
    automatic,  // cells from 8 samples per texel and 8 bounces on, else paths
    cells,      // at surface cells, which know the bounces beyond (docs/stages/cells.md)
    paths,      // by chance or at the last bounce: brute force, for truth
};

struct SunOptions {
    std::optional<Vec3> direction;  // the way light travels, of any length; unset: no sun from the options
    double illuminance = 100000.0;  // lux on a plane facing it: a clear noon
    Vec3 color{1, 1, 1};            // linear, times illuminance
    double angle_degrees = 0.0;     // angular diameter, 0..90
};

struct SkyOptions {
    std::optional<Vec3> color;    // constant radiance
    std::string file;             // equirectangular .hdr or .exr; empty: none. Overrides the sidecar's sky
    double intensity = 1.0;       // times the sky, be it of these options or the scene's: nits per unit, >= 0
    double rotation_degrees = 0;  // about +Y; added to that of the scene's sky
    double blur_degrees = 0.0;    // energy-preserving prefilter: half width of the kernel; 0 = none, up to 90
    bool extract_sun = false;     // find the sun's disc in the map, remove it and add it as a directional light
};

struct BakeOptions {
    Preset preset = Preset::medium;
    // Texels
    std::uint32_t resolution_width = 0, resolution_height = 0;  // of the one page; 0 = free
    std::uint32_t max_page = 4096;                              // largest page edge; 64..16384
    double texels_per_metre = 0.0;                              // 0: from the preset's texel budget
    // The density is solved so that all texels of all pages and of their mips, at so many bytes each, take no more than
    // atlas_bytes (0: not asked). 1 is what BC6H and BC7 take, 8 four halves.
    std::uint64_t atlas_bytes = 0;
    double bytes_per_texel = 1.0;
    // Pages by where objects are, so that what is near each other is on one: as many as max_page asks for, or `pages`.
    bool page_clusters = false;
    std::uint32_t pages = 0;  // 1..1024; 0: as many as it takes
    // Charts whose light varies by less than this share of its mean, noise aside, become as small as can be, and all is
    // packed anew (bake/collapse.h); 0: none.
    double collapse = 0.0;
    Uv1Choice uv1 = Uv1Choice::automatic;
    // The layout of an earlier bake (read_atlas_record()): charts that are still the same keep their places. None: new.
    std::shared_ptr<const AtlasRecord> atlas;
    // What lookups touch, so that no two charts share it (docs/stages/charts.md, "Masks"). Without a value: as in the
    // layout to keep, else bilinear, no mips, no blocks.
    std::optional<LookupFilter> filter;
    std::optional<std::uint32_t> mips;   // lookups in mips 0..this one, 0..6; mips from 1 on are written, too
    std::optional<std::uint32_t> block;  // 4: no block of 4 x 4 texels holds two charts, for BC formats; 1: it may
    std::optional<bool> denoise;         // post/denoise.h; without a value: the preset's
    std::uint32_t dilate = 2;            // rings of texels filled around charts, 0..64
    bool seams = false;                  // both sides of a seam show the same light (docs/stages/seams.md)
    // Light
    SkyOptions sky;
    SunOptions sun;
    Include include;
    double direct_scale = 1.0, indirect_scale = 1.0;  // of the layers (direct and sky; indirect), >= 0
    bool two_sided = false;                           // bake both sides of double-sided surfaces
    // Transport
    std::uint32_t samples = 0;   // paths per texel, 1..2^24; 0: sample_budget()
    std::uint32_t bounces = 64;  // 0 = direct light only, up to 1024
    std::uint64_t seed = 1;
    double ao_distance = 0.0;  // metres; 0: a tenth of the scene's diagonal
    Integrator integrator = Integrator::automatic;
    bool guide = true;  // with cells: first rays follow the light that texels nearby have seen
    StopRule stop = StopRule::fixed;
    double error = 0.05;        // of StopRule::error and flux: half of the interval, relative to a texel's irradiance
    double time_seconds = 0.0;  // the samples are as many as end within it, at most `samples`; 0: no such limit
    double confidence = 0.95;   // that the interval contains the truth: 0.5..0.9999
    // Machine
    unsigned threads = 0;                // 0: one per hardware thread
    std::uint64_t max_memory_bytes = 0;  // 0: no ceiling
};

}  // namespace lumel
