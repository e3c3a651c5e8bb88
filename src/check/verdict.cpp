#include "check/verdict.h"

#include <algorithm>

namespace lumel {
namespace {

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

Finding number(const char* name, const char* text, const Defects& defects, double limit) {
    return {name, text, static_cast<double>(defects.count), limit, false, defects.places};
}

}  // namespace

std::vector<Finding> judge(const SeamCheck& seams, const TexelCheck& texels, const CheckLimits& limits) {
    const auto baked = static_cast<double>(texels.baked), filled = static_cast<double>(texels.filled);
    std::vector<TexelDefect> seam_places;
    for (const SeamDefect& d : seams.worst)
        seam_places.push_back({d.page, static_cast<std::uint32_t>(std::max(0.0f, d.texels.x)),
                               static_cast<std::uint32_t>(std::max(0.0f, d.texels.y))});
    return {
        {"seam_p99", "contrast across seams, 99th percentile of their length", seams.open.p99, limits.seam_p99, true,
         seam_places},
        {"seam_visible", "length of seams above 1 % contrast", share(seams.open.visible_metres, seams.open.metres),
         limits.seam_visible, true, seam_places},
        {"invalid", "texels without a valid sample", share(filled, baked + filled), limits.invalid, true, {}},
        {"unconverged", "texels with more noise than asked",
         share(static_cast<double>(texels.unconverged.count), baked), limits.unconverged, true,
         texels.unconverged.places},
        {"density_outliers", "surface far off the median density", texels.outlier_share, limits.outliers, true,
         texels.outliers.places},
        number("not_finite", "texels that hold no number", texels.not_finite, limits.not_finite),
        number("black", "black texels amid lit ones", texels.black, limits.black),
        number("uncovered", "triangles that look up empty texels", texels.uncovered, limits.uncovered),
        number("overlaps", "pairs of triangles on one place of a page", texels.overlaps, limits.overlaps),
    };
}

}  // namespace lumel
