// The error of work that the caller asked to stop.
#pragma once

#include "lumel/result.h"

namespace lumel {

inline Error cancelled_error() { return {ErrorCode::cancelled, "cancelled", {}, {}}; }

}  // namespace lumel
