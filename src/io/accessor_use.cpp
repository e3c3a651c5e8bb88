#include "io/accessor_use.h"

namespace lumel {
namespace {

// Calls visit for the elements of the array `key`, if there is one.
template <class Visit>
void for_each(const Json& object, const char* key, Visit&& visit) {
    const Json* array = find(object, key);
    if (!array || !array->is_array()) return;
    for (const Json& item : *array) visit(item);
}

void note_all_vertices(const Json& attributes, AccessorUse& use) {
    if (!attributes.is_object()) return;
    for (const auto& [name, value] : attributes.items()) use.note_vertices(index_of(value));
}

void note_instancing(const Json& node, AccessorUse& use) {
    const Json* extension = find_extension(node, "EXT_mesh_gpu_instancing");
    const Json* attributes = extension ? find(*extension, "attributes") : nullptr;
    if (!attributes || !attributes->is_object()) return;
    for (const auto& [name, value] : attributes->items()) use.note_other(index_of(value));
}

}  // namespace

void note_vertex_accessors(const Json& primitive, AccessorUse& use) {
    if (const Json* attributes = find(primitive, "attributes")) note_all_vertices(*attributes, use);
    for_each(primitive, "targets", [&](const Json& target) { note_all_vertices(target, use); });
}

void note_accessor_use(const Json& root, AccessorUse& use) { note_accessor_use_without(root, {}, {}, use); }

void note_accessor_use_without(const Json& root, const std::set<std::uint32_t>& meshes,
                               const std::set<std::uint32_t>& instancing_nodes, AccessorUse& use) {
    std::uint32_t m = 0;
    for_each(root, "meshes", [&](const Json& mesh) {
        if (meshes.count(m++)) return;
        for_each(mesh, "primitives", [&](const Json& primitive) {
            note_vertex_accessors(primitive, use);
            use.note_indices(index_at(primitive, "indices"));
        });
    });
    for_each(root, "skins", [&](const Json& skin) { use.note_other(index_at(skin, "inverseBindMatrices")); });
    for_each(root, "animations", [&](const Json& animation) {
        for_each(animation, "samplers", [&](const Json& sampler) {
            use.note_other(index_at(sampler, "input"));
            use.note_other(index_at(sampler, "output"));
        });
    });
    std::uint32_t n = 0;
    for_each(root, "nodes", [&](const Json& node) {
        if (!instancing_nodes.count(n++)) note_instancing(node, use);
    });
}

}  // namespace lumel
