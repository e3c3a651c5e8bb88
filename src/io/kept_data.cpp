#include "io/kept_data.h"

#include "base/try.h"
#include "io/accessor_use.h"
#include "io/json_edit.h"

namespace lumel {
namespace {

class Keeper {
public:
    Keeper(const GltfDocument& document, const LitMeshPlan& plan, GlbBuilder& glb)
        : document_(document), plan_(plan), glb_(glb) {}

    Status keep() {
        const Json& root = document_.root;
        const std::size_t accessors = array_size(root, "accessors"), views = array_size(root, "bufferViews");
        AccessorUse before(accessors), after(accessors);
        note_accessor_use(root, before);
        note_accessor_use_without(root, plan_.replaced_meshes, plan_.expanded_nodes, after);
        for (const SharedGeometry& geometry : plan_.geometries) note_kept_accessors(geometry, after);
        std::vector<bool> keep(accessors);
        for (std::size_t i = 0; i < accessors; ++i) keep[i] = after.used(i) || !before.used(i);
        // A view that no accessor or image uses belongs to an extension that we do not know.
        std::vector<bool> unknown(views, true);
        for (std::size_t i = 0; i < accessors; ++i) note_views(root["accessors"][i], unknown);
        for (std::size_t i = 0; i < array_size(root, "images"); ++i) note_views(root["images"][i], unknown);
        glb_.set_kept(keep, unknown);
        for (std::uint32_t i = 0; i < views; ++i)
            if (unknown[i] && !document_.views[i].empty())
                glb_.put_view(i, document_.views[i], ViewTarget::none, document_.view_strides[i]);
        for (std::uint32_t i = 0; i < accessors; ++i)
            if (keep[i]) LUMEL_TRY_STATUS(rewrite_accessor(i, root["accessors"][i], after));
        for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
            drop_extension(glb_.root(), extension);
        return success();
    }

private:
    static void note_views(const Json& json, std::vector<bool>& unknown) {
        if (const std::uint32_t view = index_at(json, "bufferView"); view < unknown.size()) unknown[view] = false;
        if (const Json* sparse = find(json, "sparse"))
            for (const char* part : {"indices", "values"})
                if (const Json* object = find(*sparse, part)) note_views(*object, unknown);
    }

    void note_kept_accessors(const SharedGeometry& geometry, AccessorUse& use) const {
        for (const PartPlan& plan : geometry.parts) {
            const Json& primitive = gltf_primitive(document_, geometry.mesh, plan.part.primitive);
            if (plan.keeps_vertices) note_vertex_accessors(primitive, use);
            if (plan.keeps_indices) use.note_indices(index_at(primitive, "indices"));
        }
        for (const std::uint32_t p : skipped_primitives(document_, geometry.mesh)) {
            const Json& primitive = gltf_mesh(document_, geometry.mesh)["primitives"][p];
            note_vertex_accessors(primitive, use);
            use.note_indices(index_at(primitive, "indices"));
        }
    }

    Status rewrite_accessor(std::uint32_t index, Json json, const AccessorUse& use) {
        if (!find(json, "bufferView") && !find(json, "sparse")) {
            glb_.put_accessor(index, std::move(json));  // all zeros by definition
            return success();
        }
        LUMEL_TRY(const AccessorBytes data, document_.accessor_bytes(index));
        json.erase("sparse");
        json.erase("byteOffset");
        const bool vertices = use.is_vertices(index);
        const ViewTarget target =
            vertices ? ViewTarget::vertices : (use.is_indices(index) ? ViewTarget::indices : ViewTarget::none);
        json["bufferView"] =
            glb_.add_elements(data.bytes, data.components, component_size(data.component), json, target);
        glb_.put_accessor(index, std::move(json));
        return success();
    }

    const GltfDocument& document_;
    const LitMeshPlan& plan_;
    GlbBuilder& glb_;
};

}  // namespace

Status keep_used_data(const GltfDocument& document, const LitMeshPlan& plan, GlbBuilder& glb) {
    return Keeper(document, plan, glb).keep();
}

}  // namespace lumel
