// Progress of work done in parts, each of which reports as if it were all of it: while a ProgressParts lives, what is
// reported counts as one part of one stage, or of each of several, so that fractions and rays only grow. They may be
// nested.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "lumel/context.h"

namespace lumel {

class ProgressParts {
public:
    // Takes the place of context.on_progress. `work`: of all parts, in any unit.
    ProgressParts(Context& context, std::string stage, double work);
    // The same where each part goes through stages of its own, which keep their names.
    ProgressParts(Context& context, double work) : ProgressParts(context, {}, work) {}
    ~ProgressParts();
    ProgressParts(const ProgressParts&) = delete;
    ProgressParts& operator=(const ProgressParts&) = delete;
    // A part of so much work begins, the one before is done.
    void begin(double work);

private:
    struct Rays {
        std::uint64_t before = 0, now = 0;  // of the parts that are done, of this one so far
    };
    void report(const Progress& of_part);

    Context& context_;
    std::function<void(const Progress&)> outer_;
    std::string stage_;                              // empty: those that are reported
    double work_, done_ = 0.0, part_ = 0.0;          // of all, of the parts that are done, of this one
    std::map<std::string, Rays, std::less<>> rays_;  // by stage
};

}  // namespace lumel
