#include "io/json_edit.h"

#include <algorithm>

namespace lumel {

void erase_extension(Json& object, const char* name) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return;
    extensions->erase(name);
    if (extensions->empty()) object.erase("extensions");
}

void add_to_list(Json& root, const char* key, const std::string& name) {
    Json& list = root[key];
    if (!list.is_array()) list = Json::array();
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
}

void remove_from_list(Json& root, const char* key, const std::string& name) {
    const auto at = root.find(key);
    if (at == root.end() || !at->is_array()) return;
    at->erase(std::remove(at->begin(), at->end(), name), at->end());
    if (at->empty()) root.erase(key);
}

void drop_extension(Json& root, const char* name) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) remove_from_list(root, list, name);
}

bool nodes_use_extension(const Json& root, const char* name) {
    const Json* nodes = find(root, "nodes");
    return nodes && std::ranges::any_of(*nodes, [&](const Json& node) { return find_extension(node, name); });
}

}  // namespace lumel
