// How hard the block encoders search.
#pragma once

namespace lumel {

enum class BcQuality { fast, normal, best };

}  // namespace lumel
