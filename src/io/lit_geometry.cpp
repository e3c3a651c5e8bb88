#include "io/lit_geometry.h"

#include <algorithm>

#include "base/check.h"
#include "base/try.h"
#include "io/gltf_accessor.h"
#include "io/json_write.h"
#include "io/page_files.h"

namespace lumel {
namespace {

void make_room_for_uv1(Json& attributes, std::uint32_t old_uv1) {
    const auto uv1 = attributes.find("TEXCOORD_1");
    if (uv1 == attributes.end()) return;
    const Json accessor = *uv1;
    attributes.erase("TEXCOORD_1");
    if (old_uv1 != 1) attributes["TEXCOORD_" + std::to_string(old_uv1)] = accessor;
}

// min and max of the stored numbers, which POSITION must have.
void set_bounds(Json& json, std::span<const std::byte> packed, const AccessorView& view) {
    const std::size_t size = component_size(view.component);
    std::vector<float> low(view.components), high(view.components);
    for (std::size_t i = 0; i < packed.size() / size; ++i) {
        const float v = component_number(&packed[i * size], view.component, false);
        const std::size_t c = i % view.components;
        low[c] = i < view.components ? v : std::min(low[c], v);
        high[c] = i < view.components ? v : std::max(high[c], v);
    }
    json["min"] = Json::array();
    json["max"] = Json::array();
    for (std::size_t c = 0; c < view.components; ++c) {
        json["min"].push_back(json_number(low[c]));
        json["max"].push_back(json_number(high[c]));
    }
}

class GeometryWriter {
public:
    GeometryWriter(const GltfDocument& document, std::uint32_t mesh, GlbBuilder& glb)
        : document_(document), mesh_(mesh), glb_(glb) {}

    Result<Json> write(const PartPlan& plan) {
        Json primitive = gltf_primitive(document_, mesh_, plan.part.primitive);
        if (plan.part.group != kNone) make_room_for_uv1(primitive["attributes"], plan.old_uv1);
        LUMEL_TRY_STATUS(gather_attributes(primitive["attributes"], plan));
        if (const auto targets = primitive.find("targets"); targets != primitive.end())
            for (Json& target : *targets) LUMEL_TRY_STATUS(gather_attributes(target, plan));
        primitive.erase("mode");
        if (!plan.keeps_indices) primitive["indices"] = glb_.add_unsigned(plan.part.indices, ViewTarget::indices);
        primitive["extensions"][kLightmapExtension] = compact_form(plan.part);
        return primitive;
    }

private:
    Status gather_attributes(Json& attributes, const PartPlan& plan) {
        if (plan.keeps_vertices) return success();
        for (const auto& [name, value] : attributes.items()) {
            if (!value.is_number_unsigned()) continue;
            LUMEL_TRY(const std::uint32_t gathered, gather(value.get<std::uint32_t>(), plan.part.element, name));
            value = gathered;
        }
        return success();
    }

    // The elements of a vertex accessor that a part uses, in its order; components stay as the file stores them.
    Result<std::uint32_t> gather(std::uint32_t accessor, const std::vector<std::uint32_t>& elements,
                                 const std::string& name) {
        LUMEL_TRY(const AccessorView view, open_accessor(document_, accessor));
        std::vector<std::byte> packed(elements.size() * view.packed_size());
        for (std::size_t i = 0; i < elements.size(); ++i) {
            LUMEL_CHECK(elements[i] < view.count, elements[i], view.count, name);
            view.copy_element(elements[i], &packed[i * view.packed_size()]);
        }
        Json json = document_.root["accessors"][accessor];
        for (const char* key : {"sparse", "byteOffset", "min", "max"}) json.erase(key);
        json["count"] = elements.size();
        json["bufferView"] =
            glb_.add_elements(packed, view.components, component_size(view.component), json, ViewTarget::vertices);
        if (name == "POSITION") set_bounds(json, packed, view);
        return glb_.add_accessor(std::move(json));
    }

    // Chart and chart UV per vertex, and which triangles of the mesh these are.
    Json compact_form(const MeshPart& part) {
        Json out;
        out["primitive"] = document_.meshes[mesh_].primitives[part.primitive].gltf_primitive;
        const std::uint32_t first = part.triangles.front();
        const bool consecutive = part.triangles.back() - first + 1 == part.triangles.size();
        if (consecutive)
            out["firstTriangle"] = first;
        else
            out["triangles"] = glb_.add_unsigned(part.triangles, ViewTarget::none);
        if (part.group == kNone) return out;
        std::vector<std::uint32_t> charts = part.chart;
        for (std::uint32_t& chart : charts)
            if (chart == kNone) chart = 0;  // of zero-area triangles: never seen
        out["charts"] = glb_.add_unsigned(charts, ViewTarget::none);
        out["chartUvs"] = glb_.add_array(std::span<const Vec2>(part.chart_uv), Component::float32, "VEC2",
                                         part.chart_uv.size(), ViewTarget::none);
        return out;
    }

    const GltfDocument& document_;
    std::uint32_t mesh_;
    GlbBuilder& glb_;
};

}  // namespace

Result<std::vector<Json>> write_geometry(const GltfDocument& document, const SharedGeometry& geometry,
                                         GlbBuilder& glb) {
    GeometryWriter writer(document, geometry.mesh, glb);
    std::vector<Json> out;
    for (const PartPlan& plan : geometry.parts) {
        LUMEL_TRY(Json primitive, writer.write(plan));
        out.push_back(std::move(primitive));
    }
    return out;
}

}  // namespace lumel
