// Points along the seams at which both sides are to show the same light.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lumel/context.h"
#include "lumel/result.h"
#include "seam/find_seams.h"
#include "trace/tracer.h"

namespace lumel {

// Where one side of a seam is looked up.
struct SeamPoint {
    std::uint32_t page = kNone;
    Vec2 texels{};  // of the page
};

struct SeamSample {
    SeamPoint a, b;
    float weight = 0.0f;  // texels of the denser side that it stands for
};

struct SeamSamples {
    std::vector<SeamSample> samples;  // in order of the seams
    double metres = 0.0;              // of seams, hidden ones too
    std::uint64_t hidden = 0;         // samples left out since something stands on the seam, which parts the light
};

// `per_texel`: samples in a texel of the denser side. Samples whose normals are not within the rule's gate are left
// out, and those where a surface stands between the two sides: a ray half a texel (of the denser side) above the seam,
// from a half, one or one and a half texels beside it to as far on the other side, meets it. Stage "seams". Error:
// cancelled.
Result<SeamSamples> make_seam_samples(std::span<const BorderEdge> edges, std::span<const Seam> seams,
                                      const SeamRule& rule, float per_texel, const Tracer& tracer, Context& context);

}  // namespace lumel
