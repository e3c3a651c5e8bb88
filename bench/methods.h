// The integrators that are compared, as a table: a name and how to gather texels with it.
#pragma once

#include <span>
#include <string_view>

#include "bench_scene.h"
#include "path/path_integrator.h"

namespace lumel::bench {

struct GatherJob {
    const BenchScene& bench;
    PathOptions path;
    TexelRange range;
    Context& context;
};

struct Method {
    std::string_view name, about;
    bool by_default;  // runs where no methods are named
    // Everything that the method needs beyond the tracer is made in here: it is timed whole. Sums of all texels of the
    // page, of which those of the range are filled. Throws.
    RadianceSums (*gather)(const GatherJob& job);
};

std::span<const Method> methods();
const Method* find_method(std::string_view name);  // null: there is none

}  // namespace lumel::bench
