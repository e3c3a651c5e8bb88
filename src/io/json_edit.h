// Changing a glTF document: extensions taken out of objects and out of the lists that announce them.
#pragma once

#include <string>

#include "io/json_read.h"

namespace lumel {

// Takes the extension off an object, and the object's "extensions" with the last of them.
void erase_extension(Json& object, const char* name);

// Appends to the string array `key` of the root unless it is there; and takes out, the key with the last.
void add_to_list(Json& root, const char* key, const std::string& name);
void remove_from_list(Json& root, const char* key, const std::string& name);
// Out of extensionsUsed and extensionsRequired.
void drop_extension(Json& root, const char* name);

// Does any node carry the extension?
bool nodes_use_extension(const Json& root, const char* name);

}  // namespace lumel
