#include "io/lit_mesh_plan.h"

#include <algorithm>
#include <map>

#include "base/try.h"
#include "io/gltf_accessor.h"
#include "io/lit_materials.h"

namespace lumel {
namespace {

// The page of every chart of a baked instance, and the same renumbered by rank among the pages it uses.
struct ChartPages {
    std::vector<std::uint32_t> group;  // per chart; kNone: not placed
    std::vector<std::uint32_t> pages;  // by group, ascending
};

ChartPages chart_pages(const Atlas& atlas, std::uint32_t instance) {
    ChartPages out;
    const std::uint32_t first = atlas.first_placement[instance], last = atlas.first_placement[instance + 1];
    for (std::uint32_t i = first; i < last; ++i) out.pages.push_back(atlas.placements[i].page);
    out.group = out.pages;
    std::sort(out.pages.begin(), out.pages.end());
    out.pages.erase(std::unique(out.pages.begin(), out.pages.end()), out.pages.end());
    if (!out.pages.empty() && out.pages.back() == kNone) out.pages.pop_back();
    for (std::uint32_t& group : out.group)
        if (group != kNone)
            group = static_cast<std::uint32_t>(std::lower_bound(out.pages.begin(), out.pages.end(), group) -
                                               out.pages.begin());
    return out;
}

// Mesh vertex -> element of its primitive's accessors.
std::vector<std::uint32_t> elements_of(const Mesh& mesh, const MeshSource& source) {
    std::vector<std::uint32_t> out(mesh.positions.size());
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
        for (std::uint32_t v = 0; v < mesh.primitives[p].vertex_count; ++v)
            out[mesh.primitives[p].first_vertex + v] = source.primitives[p].element(v);
    return out;
}

class Planner {
public:
    explicit Planner(const GltfWriteInput& input) : in_(input), document_(input.document) {}

    Result<LitMeshPlan> plan() && {
        LUMEL_TRY_STATUS(cut_meshes());
        find_replaced_meshes();
        return std::move(out_);
    }

private:
    // Once for all instances that can share the result.
    Status cut_meshes() {
        std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, std::size_t> known;
        for (std::uint32_t d = 0; d < in_.scene.display.instances.size(); ++d) {
            const DisplayInstance& display = in_.scene.display.instances[d];
            if (display.baked_instance == kNone) continue;
            ChartPages pages = chart_pages(in_.atlas, display.baked_instance);
            if (pages.pages.empty()) continue;
            const auto [at, added] = known.try_emplace({display.mesh, pages.group}, out_.geometries.size());
            if (added) {
                LUMEL_TRY(SharedGeometry geometry, plan_geometry(display, pages.group));
                out_.geometries.push_back(std::move(geometry));
            }
            out_.instances.push_back({d, at->second, std::move(pages.pages)});
        }
        return success();
    }

    Result<SharedGeometry> plan_geometry(const DisplayInstance& display, const std::vector<std::uint32_t>& group) {
        const Mesh& mesh = *in_.scene.display.meshes[display.mesh];
        const std::uint32_t baked_mesh = in_.scene.instances[display.baked_instance].mesh;
        SharedGeometry out;
        out.mesh = display.mesh;
        for (MeshPart& part : split_mesh(mesh, in_.charts.meshes[baked_mesh], group,
                                         elements_of(mesh, document_.meshes[display.mesh]))) {
            PartPlan plan;
            plan.part = std::move(part);
            const Json& primitive = gltf_primitive(document_, display.mesh, plan.part.primitive);
            LUMEL_TRY(plan.keeps_vertices, is_identity(primitive, plan.part.element));
            if (plan.keeps_vertices) {
                LUMEL_TRY(plan.keeps_indices, has_indices(primitive, plan.part.indices));
            }
            plan.old_uv1 = free_uv_set(primitive, baked_mesh);
            out.parts.push_back(std::move(plan));
        }
        return out;
    }

    Result<bool> is_identity(const Json& primitive, const std::vector<std::uint32_t>& elements) const {
        LUMEL_TRY(const AccessorView positions,
                  open_accessor(document_, index_at(primitive["attributes"], "POSITION")));
        if (positions.count != elements.size()) return false;
        for (std::uint32_t i = 0; i < elements.size(); ++i)
            if (elements[i] != i) return false;
        return true;
    }

    Result<bool> has_indices(const Json& primitive, const std::vector<std::uint32_t>& indices) const {
        const std::uint32_t accessor = index_at(primitive, "indices");
        const Json* mode = find(primitive, "mode");
        if (accessor == kNone || (mode && *mode != 4)) return false;
        LUMEL_TRY(const AccessorView view, open_accessor(document_, accessor));
        if (view.count != indices.size()) return false;
        for (std::size_t i = 0; i < indices.size(); ++i)
            if (view.index(i) != indices[i]) return false;
        return true;
    }

    // TEXCOORD_1 becomes the lightmap's. Where the material looks something up by the file's own, that moves to the
    // next free set; a layout that is kept as it was needs no second copy.
    [[nodiscard]] std::uint32_t free_uv_set(const Json& primitive, std::uint32_t baked_mesh) const {
        const Json& attributes = primitive["attributes"];
        const bool kept = in_.charts.scene_wide && in_.charts.meshes[baked_mesh].from_uv1;
        const std::uint32_t material = index_at(primitive, "material");
        if (kept || !find(attributes, "TEXCOORD_1") || !uses_uv1(document_.root, material)) return 1;
        std::uint32_t set = 2;
        while (find(attributes, ("TEXCOORD_" + std::to_string(set)).c_str())) ++set;
        return set;
    }

    // A mesh whose every node gets meshes of its own gives its place to the first of them.
    void find_replaced_meshes() {
        std::set<std::uint32_t> replaced, needed;
        std::set<std::pair<std::uint32_t, std::uint32_t>> lit;  // display source: node, instancing index
        for (const InstancePlan& plan : out_.instances) {
            const DisplaySource& source = in_.scene.display.instances[plan.display].source;
            replaced.insert(source.gltf_mesh);
            if (source.instancing_index != kNone) out_.expanded_nodes.insert(source.gltf_node);
            lit.insert({source.gltf_node, source.instancing_index});
        }
        std::set<std::uint32_t> displayed;
        for (const DisplayInstance& instance : in_.scene.display.instances) {
            displayed.insert(instance.source.gltf_node);
            if (!lit.count({instance.source.gltf_node, instance.source.instancing_index}))
                needed.insert(instance.source.gltf_mesh);
        }
        // Nodes of other scenes are not ours.
        for (std::uint32_t n = 0; n < array_size(document_.root, "nodes"); ++n)
            if (const std::uint32_t mesh = index_at(document_.root["nodes"][n], "mesh");
                mesh != kNone && !displayed.count(n))
                needed.insert(mesh);
        for (const std::uint32_t mesh : replaced)
            if (!needed.count(mesh)) out_.replaced_meshes.insert(mesh);
    }

    const GltfWriteInput& in_;
    const GltfDocument& document_;
    LitMeshPlan out_;
};

}  // namespace

Result<LitMeshPlan> plan_lit_meshes(const GltfWriteInput& input) { return Planner(input).plan(); }

const Json& gltf_mesh(const GltfDocument& document, std::uint32_t scene_mesh) {
    return document.root["meshes"][document.meshes[scene_mesh].gltf_mesh];
}

const Json& gltf_primitive(const GltfDocument& document, std::uint32_t scene_mesh, std::uint32_t primitive) {
    return gltf_mesh(document,
                     scene_mesh)["primitives"][document.meshes[scene_mesh].primitives[primitive].gltf_primitive];
}

std::vector<std::uint32_t> skipped_primitives(const GltfDocument& document, std::uint32_t scene_mesh) {
    std::vector<bool> read(gltf_mesh(document, scene_mesh)["primitives"].size());
    for (const PrimitiveSource& source : document.meshes[scene_mesh].primitives) read[source.gltf_primitive] = true;
    std::vector<std::uint32_t> out;
    for (std::uint32_t p = 0; p < read.size(); ++p)
        if (!read[p]) out.push_back(p);
    return out;
}

}  // namespace lumel
