// What Lumel sees in a scene, for people and for programs: `lumel info`.
#pragma once

#include <string>

#include "lumel/context.h"
#include "lumel/scene.h"

namespace lumel {

// Several lines of text.
std::string describe(const Scene& scene, const Diagnostics& diagnostics);
// The same as one JSON object.
std::string describe_json(const Scene& scene, const Diagnostics& diagnostics);

}  // namespace lumel
