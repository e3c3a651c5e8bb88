#include "check/verdict.h"

#include <algorithm>
#include <utility>

namespace lumel {
namespace {

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

Finding number(const char* name, const char* text, const char* option, const Defects& defects, double limit) {
    return {name, text, option, static_cast<double>(defects.count), limit, false, defects.places};
}

Finding share_of(const char* name, const char* text, const char* option, double value, double limit,
                 std::vector<TexelDefect> places) {
    return {name, text, option, value, limit, true, std::move(places)};
}

}  // namespace

std::vector<Finding> judge(const SeamCheck& seams, const TexelCheck& texels, const CheckLimits& limits) {
    const auto baked = static_cast<double>(texels.baked), filled = static_cast<double>(texels.filled);
    std::vector<TexelDefect> seam_places;
    for (const SeamDefect& d : seams.worst)
        seam_places.push_back({d.page, static_cast<std::uint32_t>(std::max(0.0f, d.texels.x)),
                               static_cast<std::uint32_t>(std::max(0.0f, d.texels.y))});
    std::vector<Finding> out{
        share_of("seam_p99", "contrast across seams, 99th percentile of their length", "--max-seam-p99", seams.open.p99,
                 limits.seam_p99, seam_places),
        share_of("seam_visible", "length of seams above 1 % contrast", "--max-seam-visible",
                 share(seams.open.visible_metres, seams.open.metres), limits.seam_visible, seam_places),
        share_of("invalid", "texels without a valid sample", "--max-invalid", share(filled, baked + filled),
                 limits.invalid, {}),
        share_of("unconverged", "texels with more noise than --noisy allows", "--max-unconverged",
                 share(static_cast<double>(texels.unconverged.count), baked), limits.unconverged,
                 texels.unconverged.places),
        share_of("density_outliers", "surface that --outlier times or more parts from the median density",
                 "--max-outliers", texels.outlier_share, limits.outliers, texels.outliers.places),
        number("not_finite", "texels that hold no number", "--max-not-finite", texels.not_finite, limits.not_finite),
        number("black", "black texels amid lit ones", "--max-black", texels.black, limits.black),
        number("uncovered", "triangles that look up empty texels", "--max-uncovered", texels.uncovered,
               limits.uncovered),
        number("overlaps", "pairs of triangles on one place of a page", "--max-overlaps", texels.overlaps,
               limits.overlaps),
    };
    out[0].is_measured = out[1].is_measured = seams.open.samples > 0;
    return out;
}

std::string verdict(std::span<const Finding> findings) {
    std::string failed;
    for (const Finding& f : findings)
        if (!f.passed()) failed += (failed.empty() ? "" : ", ") + f.name;
    const std::string limits = std::to_string(std::ranges::count_if(findings, &Finding::has_limit));
    return failed.empty() ? "passed: all " + limits + " limits are kept"
                          : "FAILED: of " + limits + " limits these are not kept: " + failed;
}

}  // namespace lumel
