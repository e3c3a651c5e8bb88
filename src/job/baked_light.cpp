#include "job/baked_light.h"

namespace lumel {

BakedLight light_of(BakedLighting& baked) {
    return {[&baked](std::uint32_t triangle, float b1, float b2) { return baked.irradiance(triangle, b1, b2); },
            baked.parts(), [&baked](std::uint32_t part) { return baked.load(part); }};
}

}  // namespace lumel
