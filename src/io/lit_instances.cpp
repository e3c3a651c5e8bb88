#include "io/lit_instances.h"

#include <map>
#include <set>

#include "chart/chart_transform.h"
#include "chart/lift.h"
#include "io/instancing_expand.h"
#include "io/json_edit.h"
#include "io/page_files.h"

namespace lumel {
namespace {

class InstanceWriter {
public:
    InstanceWriter(const GltfWriteInput& input, const LitMeshPlan& plan,
                   const std::vector<std::vector<Json>>& primitives, LitMaterials& materials, GlbBuilder& glb)
        : in_(input),
          plan_(plan),
          primitives_(primitives),
          materials_(materials),
          glb_(glb),
          root_(glb.root()),
          free_meshes_(plan.replaced_meshes),
          uv_view_(glb.reserve_view()),
          transforms_(chart_transforms(input.atlas)),
          transform_view_(glb.add_view(std::as_bytes(std::span(transforms_)), ViewTarget::none)) {}

    ChartBuffer write() {
        const auto expanded = expand_instancing(in_.document, plan_.expanded_nodes, root_);
        for (const InstancePlan& plan : plan_.instances) {
            const DisplayInstance& display = in_.scene.display.instances[plan.display];
            const DisplaySource& source = display.source;
            const std::uint32_t node = source.instancing_index == kNone
                                           ? source.gltf_node
                                           : expanded.at(source.gltf_node).at(source.instancing_index);
            const std::uint32_t mesh = place_mesh(source.gltf_mesh, instance_mesh(plan));
            root_["nodes"][node]["mesh"] = mesh;
            root_["nodes"][node]["extensions"][kLightmapExtension] = node_extension(display.baked_instance);
        }
        glb_.put_view(uv_view_, std::as_bytes(std::span(uvs_)), ViewTarget::vertices, sizeof(Vec2));
        for (const char* name : {kLightmapExtension, "KHR_materials_emissive_strength", "KHR_materials_specular"})
            add_to_list(root_, "extensionsUsed", name);
        return chart_buffer();
    }

private:
    // A slot that a replaced mesh left, or a new one.
    std::uint32_t place_mesh(std::uint32_t gltf_mesh, Json mesh) {
        if (free_meshes_.erase(gltf_mesh) > 0) {
            root_["meshes"][gltf_mesh] = std::move(mesh);
            return gltf_mesh;
        }
        root_["meshes"].push_back(std::move(mesh));
        return static_cast<std::uint32_t>(root_["meshes"].size() - 1);
    }

    Json instance_mesh(const InstancePlan& plan) {
        const SharedGeometry& geometry = plan_.geometries[plan.geometry];
        const std::vector<Atlas::TriangleUv> uvs = lift(in_.scene, in_.charts, in_.atlas, plan.display);
        Json mesh = gltf_mesh(in_.document, geometry.mesh);
        Json primitives = Json::array();
        for (std::size_t p = 0; p < geometry.parts.size(); ++p) {
            const PartPlan& part = geometry.parts[p];
            const std::uint32_t page = part.part.group == kNone ? kNone : plan.pages[part.part.group];
            primitives.push_back(instance_primitive(primitives_[plan.geometry][p], part, page, uvs));
        }
        for (const std::uint32_t p : skipped_primitives(in_.document, geometry.mesh))
            primitives.push_back(mesh["primitives"][p]);
        mesh["primitives"] = std::move(primitives);
        return mesh;
    }

    Json instance_primitive(Json primitive, const PartPlan& plan, std::uint32_t page,
                            const std::vector<Atlas::TriangleUv>& uvs) {
        if (page == kNone) return primitive;
        Json& attributes = primitive["attributes"];
        attributes["TEXCOORD_1"] = add_lightmap_uvs(plan.part, page, uvs);
        // glTF counts UV sets from 0 without gaps: a file without UVs gets the lightmap's under both numbers.
        if (!find(attributes, "TEXCOORD_0")) attributes["TEXCOORD_0"] = attributes["TEXCOORD_1"];
        primitive["material"] = materials_.lit(index_at(primitive, "material"), page, plan.old_uv1);
        primitive["extensions"][kLightmapExtension]["page"] = page;
        return primitive;
    }

    std::uint32_t add_lightmap_uvs(const MeshPart& part, std::uint32_t page,
                                   const std::vector<Atlas::TriangleUv>& uvs) {
        const AtlasPage& size = in_.atlas.pages[page];
        const std::size_t offset = uvs_.size() * sizeof(Vec2);
        for (std::size_t v = 0; v < part.element.size(); ++v) {
            const Atlas::TriangleUv& triangle = uvs[part.triangles[part.corner[v] / 3]];
            const Vec2 texels = triangle.texels[part.corner[v] % 3];
            const Vec2 uv{texels.x / static_cast<float>(size.width), texels.y / static_cast<float>(size.height)};
            // A kept layout is kept to the bit.
            uvs_.push_back(part.chart[v] == kNone ? Vec2{} : (in_.charts.scene_wide ? part.chart_uv[v] : uv));
        }
        return glb_.add_accessor(
            GlbBuilder::accessor_json(uv_view_, offset, Component::float32, "VEC2", part.element.size()));
    }

    // Which baked instance this is, and where its charts lie: TEXCOORD_1 = chartUv * (x, y) + (z, w).
    Json node_extension(std::uint32_t instance) {
        const std::uint32_t first = in_.atlas.first_placement[instance], last = in_.atlas.first_placement[instance + 1];
        const std::uint32_t accessor = glb_.add_accessor(
            GlbBuilder::accessor_json(transform_view_, first * sizeof(Vec4), Component::float32, "VEC4", last - first));
        return {{"instance", instance}, {"firstChart", first}, {"transforms", accessor}};
    }

    // The transforms of all instances in one, and the page of each.
    ChartBuffer chart_buffer() {
        std::vector<std::uint32_t> pages;
        for (const ChartPlacement& place : in_.atlas.placements)
            pages.push_back(place.page == kNone ? 0 : place.page);  // of no triangle that is seen
        ChartBuffer out;
        out.transforms = glb_.add_accessor(
            GlbBuilder::accessor_json(transform_view_, 0, Component::float32, "VEC4", transforms_.size()));
        out.pages = glb_.add_unsigned(pages, ViewTarget::none);
        return out;
    }

    const GltfWriteInput& in_;
    const LitMeshPlan& plan_;
    const std::vector<std::vector<Json>>& primitives_;
    LitMaterials& materials_;
    GlbBuilder& glb_;
    Json& root_;
    std::set<std::uint32_t> free_meshes_;  // of the replaced ones
    std::vector<Vec2> uvs_;                // of all instances
    std::uint32_t uv_view_;
    std::vector<Vec4> transforms_;  // of all instances, as Atlas::placements
    std::uint32_t transform_view_;
};

}  // namespace

ChartBuffer write_lit_instances(const GltfWriteInput& input, const LitMeshPlan& plan,
                                const std::vector<std::vector<Json>>& primitives, LitMaterials& materials,
                                GlbBuilder& glb) {
    if (plan.instances.empty()) return {};
    return InstanceWriter(input, plan, primitives, materials, glb).write();
}

}  // namespace lumel
