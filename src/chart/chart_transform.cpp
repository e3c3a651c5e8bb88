#include "chart/chart_transform.h"

#include "lumel/scene.h"

namespace lumel {

std::vector<Vec4> chart_transforms(const Atlas& atlas) {
    std::vector<Vec4> out;
    out.reserve(atlas.placements.size());
    for (const ChartPlacement& place : atlas.placements) {
        const AtlasPage size = place.page == kNone ? AtlasPage{1, 1} : atlas.pages[place.page];
        const float w = static_cast<float>(size.width), h = static_cast<float>(size.height);
        out.push_back({place.scale.x / w, place.scale.y / h, place.offset.x / w, place.offset.y / h});
    }
    return out;
}

}  // namespace lumel
