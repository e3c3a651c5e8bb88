// A glTF file as its JSON document and its buffers: load_scene() and what else reads one.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "lumel/load.h"

namespace lumel {

// The bytes of a .glb (fuzz target; external files are refused).
Result<LoadedScene> load_glb(std::span<const std::byte> bytes, const std::string& where, Context& context);

}  // namespace lumel
