// A bake's files as what lights a picture.
#pragma once

#include "io/baked.h"
#include "render/picture.h"

namespace lumel {

// For render_picture; borrows `baked`.
BakedLight light_of(BakedLighting& baked);

}  // namespace lumel
