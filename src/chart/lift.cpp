#include "chart/lift.h"

#include "base/check.h"

namespace lumel {

std::vector<Atlas::TriangleUv> lift(const Scene& scene, const ChartSet& charts, const Atlas& atlas,
                                    std::uint32_t display_instance) {
    const DisplayInstance& shown = scene.display.instances[display_instance];
    if (shown.baked_instance == kNone) return {};
    if (atlas.first_placement[shown.baked_instance] == atlas.first_placement[shown.baked_instance + 1]) return {};
    const std::uint32_t baked_mesh = scene.instances[shown.baked_instance].mesh;
    LUMEL_CHECK(scene.display.meshes[shown.mesh] == scene.meshes[baked_mesh], "displayed mesh", shown.mesh,
                "is not baked mesh", baked_mesh);
    std::vector<Atlas::TriangleUv> out(scene.meshes[baked_mesh]->triangles.size());
    for (std::uint32_t t = 0; t < out.size(); ++t)
        out[t] = atlas.mesh_triangle_uv(charts, scene, shown.baked_instance, t);
    return out;
}

}  // namespace lumel
