// Which of an encoding's numbers are light, and scale with it.
#pragma once

#include "encode/encoding.h"

namespace lumel {

constexpr bool is_light(FieldKind kind) { return kind == FieldKind::light || kind == FieldKind::signed_light; }

}  // namespace lumel
