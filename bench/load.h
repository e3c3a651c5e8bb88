// Scenes for benchmarks: any failure ends the program with its message.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "io/gltf_document.h"
#include "scene/world_geometry.h"

namespace lumel::bench {

template <class T>
T need(Result<T> result) {
    if (!result.ok()) throw std::runtime_error(result.error().text());
    return std::move(result).value();
}

inline std::string base_name(const std::string& path) {
    const std::size_t slash = path.find_last_of('/');
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

}  // namespace lumel::bench
