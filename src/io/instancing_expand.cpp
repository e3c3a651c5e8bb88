#include "io/instancing_expand.h"

#include "base/check.h"
#include "io/gltf_accessor.h"
#include "io/json_edit.h"
#include "io/json_write.h"

namespace lumel {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

// Translation, rotation and scale of every instance.
std::vector<Json> instance_nodes(const Json& extension, const GltfDocument& document) {
    static constexpr std::array<std::pair<const char*, const char*>, 3> kParts{
        {{"TRANSLATION", "translation"}, {"ROTATION", "rotation"}, {"SCALE", "scale"}}};
    std::vector<Json> out;
    for (const auto& [attribute, key] : kParts) {
        const std::uint32_t accessor = index_at(extension["attributes"], attribute);
        if (accessor == kNone) continue;
        const auto view = open_accessor(document, accessor);
        LUMEL_CHECK(view.ok(), accessor);
        if (out.empty()) out.assign(view->count, Json::object());
        for (std::size_t i = 0; i < out.size(); ++i)
            for (std::uint32_t c = 0; c < view->components; ++c) out[i][key].push_back(json_number(view->number(i, c)));
    }
    return out;
}

std::vector<std::uint32_t> expand(std::uint32_t node, const GltfDocument& document, Json& root) {
    const Json extension = root["nodes"][node]["extensions"][kInstancing];
    const Json mesh = root["nodes"][node]["mesh"];
    std::vector<std::uint32_t> children;
    for (Json& child : instance_nodes(extension, document)) {
        const Json* name = find(root["nodes"][node], "name");
        const std::string stem = name && name->is_string() ? name->get<std::string>() : "node " + std::to_string(node);
        Json named = {{"name", stem + "#" + std::to_string(children.size())}};
        named.update(child);
        named["mesh"] = mesh;
        children.push_back(static_cast<std::uint32_t>(root["nodes"].size()));
        root["nodes"].push_back(std::move(named));
    }
    Json& parent = root["nodes"][node];
    parent.erase("mesh");
    erase_extension(parent, kInstancing);
    for (const std::uint32_t child : children) parent["children"].push_back(child);
    return children;
}

}  // namespace

std::map<std::uint32_t, std::vector<std::uint32_t>> expand_instancing(const GltfDocument& document,
                                                                      const std::set<std::uint32_t>& nodes,
                                                                      Json& root) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> out;
    for (const std::uint32_t node : nodes) out[node] = expand(node, document, root);
    if (!out.empty() && !nodes_use_extension(root, kInstancing)) drop_extension(root, kInstancing);
    return out;
}

}  // namespace lumel
