// The camera that --camera asks for.
#pragma once

#include <string>

#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"
#include "path/path_integrator.h"

namespace lumel::cli {

// A camera of the scene by name, "view K" (that of preview_view_K.png), a point of view (eye;target;vfov_degrees), or,
// of an empty text, the first there is. Errors: usage; cancelled.
Result<Camera> find_camera(const std::string& text, const Transport& transport, Context& context);

}  // namespace lumel::cli
