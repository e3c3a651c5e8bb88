// A scene as the transport benchmarks see it: lit, flattened, laid out, its first page rasterised, ready to trace.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "chart/chart_set.h"
#include "lumel/context.h"
#include "scene/surface.h"
#include "scene/world_geometry.h"
#include "texel/texel_buffer.h"
#include "trace/tracer.h"

namespace lumel::bench {

// A run of texels of the page.
struct TexelRange {
    std::size_t first = 0, count = 0;
};

// Scenes without a light of their own get the sky map, if one is given, else the benchmarks' sky and sun; those whose
// sky glTF cannot say get theirs. Throws, with a message for the user.
Scene load_lit(const std::string& path, Context& context, const std::string& sky_map = {});

struct BenchScene {
    // Lit by load_lit().
    BenchScene(const std::string& path, const ChartOptions& options, Context& context, const std::string& sky_map = {});
    // Made in code, lit as it is.
    BenchScene(std::string scene_name, Scene made, const ChartOptions& options, Context& context);
    BenchScene(const BenchScene&) = delete;  // its members point at each other
    BenchScene& operator=(const BenchScene&) = delete;

    [[nodiscard]] TexelRange middle_texels(std::size_t at_most) const;
    [[nodiscard]] float ao_distance() const { return 0.1f * length(geometry.bounds_max - geometry.bounds_min); }

    std::string name;
    Scene scene;
    WorldGeometry geometry;
    SurfaceReader surfaces{scene, geometry};
    ChartSet charts;
    Atlas atlas;
    TexelBuffer texels;  // of page 0
    std::unique_ptr<Tracer> tracer;
};

}  // namespace lumel::bench
