// A sky and a sun that do not belong together: each is right alone, but nobody sees the one beside the other.
#pragma once

#include "lumel/context.h"
#include "lumel/scene.h"

namespace lumel {

// Warns ("dark-sky") where the sky lights a thousandth of what the suns do, or less. Outdoors it is a tenth to a fifth
// under a clear sky: most likely the sky's numbers are not in nits. A black sky is meant.
void warn_of_dark_sky(const Scene& scene, Diagnostics& diagnostics);

}  // namespace lumel
