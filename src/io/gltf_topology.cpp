// Lists, strips and fans. glTF 2.0, section 3.7.2.1.
#include "io/gltf_topology.h"

#include <string>

namespace lumel {
namespace {

bool names_a_vertex_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

}  // namespace

Result<std::vector<Triangle>> make_triangles(PrimitiveMode mode, std::span<const std::uint32_t> indices,
                                             const std::string& where) {
    std::vector<Triangle> triangles;
    if (mode == PrimitiveMode::triangles) {
        if (indices.size() % 3 != 0)
            return Error{ErrorCode::invalid_input,
                         "has " + std::to_string(indices.size()) + " indices, which is not a multiple of three",
                         where,
                         {}};
        triangles.reserve(indices.size() / 3);
        for (std::size_t i = 0; i < indices.size(); i += 3)
            triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
        return triangles;
    }
    for (std::size_t i = 2; i < indices.size(); ++i) {
        // Every other triangle of a strip is wound the other way round (glTF 2.0, 3.7.2.1).
        const bool odd = i % 2 != 0;
        const Triangle strip{indices[i - 2], indices[odd ? i : i - 1], indices[odd ? i - 1 : i]};
        const Triangle fan{indices[i - 1], indices[i], indices[0]};
        const Triangle& triangle = mode == PrimitiveMode::triangle_strip ? strip : fan;
        if (!names_a_vertex_twice(triangle)) triangles.push_back(triangle);
    }
    return triangles;
}

}  // namespace lumel
