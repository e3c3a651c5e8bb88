#include "base/progress_parts.h"

#include <algorithm>
#include <utility>

namespace lumel {

ProgressParts::ProgressParts(Context& context, std::string stage, double work)
    : context_(context), outer_(std::move(context.on_progress)), stage_(std::move(stage)), work_(work) {
    context_.on_progress = [this](const Progress& of_part) { report(of_part); };
}

ProgressParts::~ProgressParts() { context_.on_progress = std::move(outer_); }

void ProgressParts::begin(double work) {
    done_ += std::exchange(part_, work);
    for (auto& [stage, rays] : rays_) rays.before += std::exchange(rays.now, 0);
}

void ProgressParts::report(const Progress& of_part) {
    const std::string_view stage = stage_.empty() ? of_part.stage : std::string_view(stage_);
    auto at = rays_.find(stage);
    if (at == rays_.end()) at = rays_.emplace(stage, Rays{}).first;
    Rays& rays = at->second;
    rays.now = std::max(rays.now, of_part.rays);
    const double fraction = std::min((done_ + part_ * of_part.fraction) / work_, 1.0);
    if (outer_) outer_({stage, fraction, rays.before + rays.now});
}

}  // namespace lumel
