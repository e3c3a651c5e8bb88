// A fence before OpenEXR's header parser, which allocates what an attribute says is its size before it looks for so
// many bytes: a file of 500 bytes could take 2 GB (OpenEXR 3.1.5, OpaqueAttribute, StringVectorAttribute, IDManifest).
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "lumel/result.h"

namespace lumel {

// An error where an attribute of a header leaves the file, or has another size than its type. What the attributes mean
// is the library's business.
Status check_exr_headers(std::span<const std::byte> exr, const std::string& where);

}  // namespace lumel
