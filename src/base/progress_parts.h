// Progress of work done in parts, each of which reports as if it were all of it: while a ProgressParts lives, what is
// reported counts as one part of one stage, so that its fraction and rays only grow. They may be nested.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "lumel/context.h"

namespace lumel {

class ProgressParts {
public:
    // Takes the place of context.on_progress. `work`: of all parts, in any unit.
    ProgressParts(Context& context, std::string stage, double work);
    ~ProgressParts();
    ProgressParts(const ProgressParts&) = delete;
    ProgressParts& operator=(const ProgressParts&) = delete;
    // A part of so much work begins, the one before is done.
    void begin(double work);

private:
    void report(const Progress& of_part);

    Context& context_;
    std::function<void(const Progress&)> outer_;
    std::string stage_;
    double work_, done_ = 0.0, part_ = 0.0;     // of all, of the parts that are done, of this one
    std::uint64_t rays_before_ = 0, rays_ = 0;  // of the parts that are done, of this one so far
};

}  // namespace lumel
