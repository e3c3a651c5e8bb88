// Sample points that are shut in: below a wall that stands on the texel, inside a column. Behind single-sided surfaces
// their rays meet backs, which tell; behind double-sided ones, which is how many tools export everything, they would
// darken what is seen of the texel.
//
// Based on: O'Donnell 2018 (validity of sample points by back faces). Different here: what decides is that a point
// sees nothing but the back faces of double-sided surfaces, most of them near.
#pragma once

#include <cstdint>
#include <span>

#include "path/path_integrator.h"
#include "trace/tracer.h"

namespace lumel {

// Rays over the hemisphere of each point that must all meet backs of double-sided surfaces, three quarters of them
// within `reach` metres.
inline constexpr std::uint32_t kEnclosureRays = 16;

// Bit s: point s of `starts` (at most 64) is enclosed. `key`: of the rays' directions (math/sampler.h). `rays` and
// `hits` are scratch memory for as many as there are points.
std::uint64_t enclosed_points(std::span<const SurfaceStart> starts, float reach, std::uint32_t key,
                              const Tracer& tracer, const WorldGeometry& geometry, std::span<Ray> rays,
                              std::span<Hit> hits);

// In texels, what counts as near. Cavities under what stands on a texel are not much wider than what hides them; rooms
// whose walls face outwards are, and the things in such rooms are not enclosed.
inline constexpr float kEnclosureReach = 8.0f;

// Moves the starts whose bit is set to the front, in order, and returns how many there are.
std::size_t keep_starts(std::span<SurfaceStart> starts, std::uint64_t kept);

// The same for the starts that are not of the set `enclosed`; all, in place, where all are.
std::size_t keep_open_points(std::span<SurfaceStart> starts, std::uint64_t enclosed);

}  // namespace lumel
