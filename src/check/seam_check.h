// How far the two sides of seams are apart to the eye, by a search of its own: knows nothing of charts, of how seams
// were found, or of whether they were blended.
#pragma once

#include <cstdint>
#include <vector>

#include "check/checked_bake.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "trace/tracer.h"

namespace lumel {

struct SeamCheckOptions {
    double distance = 1e-3;            // metres between two points of borders that are taken for one
    double distance_in_texels = 0.1;   // and of the texels of either: in scenes of millimetres all is within one
    double normal_cosine = 0.9396926;  // 20 degrees
    double points_per_texel = 2.0;     // along borders
    double visible = 0.01;             // contrast from which the eye sees a seam
};

// A place where two lookups disagree.
struct SeamDefect {
    double contrast = 0.0;
    Vec3 position{};
    std::uint32_t instance_a = 0, instance_b = 0, page = 0;
    Vec2 texels{};  // of side a on `page`
};

// Contrast over some of the samples. Metres are half of what the samples stand for: each is found from both sides.
struct SeamContrast {
    std::uint64_t samples = 0;
    double metres = 0.0, visible_metres = 0.0;      // of seams; of these, above SeamCheckOptions::visible
    double median = 0.0, p99 = 0.0, largest = 0.0;  // over the metres
};

struct SeamCheck {
    // Parted: a surface stands on the seam, so that its sides are in different light for a reason: a ray from half a
    // texel beside and above the seam to the same place on the other side meets something.
    SeamContrast open, parted;
    std::vector<SeamDefect> worst;  // of the open: at most 100 above `visible`, far apart from each other
};

// Contrast: |a - b| / ((a + b)/2 + 0.01 mean light), of luminances by bilinear lookup. Sampled are edges that one
// triangle alone has at its place of the layout; partners are all such edges within the distance whose normals agree
// and which look up another place. `tracer`: of the same surfaces. Stage "seams". Error: cancelled.
Result<SeamCheck> check_seams(const CheckedBake& bake, const SeamCheckOptions& options, const Tracer& tracer,
                              Context& context);

}  // namespace lumel
