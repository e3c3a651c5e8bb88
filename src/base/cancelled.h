// The error of work that the caller asked to stop.
#pragma once

#include <string>
#include <utility>

#include "lumel/result.h"

namespace lumel {

inline Error cancelled_error(std::string message = "the bake was cancelled") {
    return {ErrorCode::cancelled, std::move(message), {}, {}};
}

}  // namespace lumel
