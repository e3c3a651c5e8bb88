// Bakery's way to keep leaks out, as published: one sample point a texel, pushed out of what four rays find.
// Based on: the article "Baking artifact-free lightmaps on the GPU" (2018), "Optimizing UV GBuffer: shadow leaks". A
// baseline for the leak suite; nothing of it is in the bake.
#pragma once

#include "bench_scene.h"
#include "path/path_integrator.h"
#include "path/radiance_sums.h"

namespace lumel::bench {

// Where a texel's one sample lies, lifted off its surface: the representative point, and from it the first of four
// tangential rays of half a texel's diagonal that meets a back face decides: position + direction * distance + normal
// of that face * bias. Tangents are made from the face normal alone, not from the UVs.
SurfaceStart seed_sample(const BenchScene& bench, std::size_t texel);

// The texels of the page gathered from those points by brute force: the irradiance of RadianceSums and the counts, all
// of it in the layer `direct`. Every covered texel counts as valid: the article rejects none.
RadianceSums gather_seed_samples(const BenchScene& bench, std::uint32_t samples, Context& context);

}  // namespace lumel::bench
