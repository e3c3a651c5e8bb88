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
    rays_before_ += std::exchange(rays_, 0);
}

void ProgressParts::report(const Progress& of_part) {
    rays_ = std::max(rays_, of_part.rays);
    const double fraction = std::min((done_ + part_ * of_part.fraction) / work_, 1.0);
    if (outer_) outer_({stage_, fraction, rays_before_ + rays_});
}

}  // namespace lumel
