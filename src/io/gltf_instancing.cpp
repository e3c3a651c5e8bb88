// EXT_mesh_gpu_instancing: one transform per instance from accessors.
#include <cmath>

#include "base/try.h"
#include "io/gltf_accessor.h"
#include "io/gltf_nodes.h"

namespace lumel {
namespace {

Result<AccessorView> open_part(const GltfDocument& document, const Json& attributes, const char* key,
                               std::uint32_t components, std::optional<std::uint64_t>& count,
                               const std::string& where) {
    LUMEL_TRY(const std::optional<std::uint64_t> accessor, optional_count(attributes, key, where));
    if (!accessor) return AccessorView{};
    LUMEL_TRY(AccessorView view, open_accessor(document, *accessor));
    if (view.components != components)
        return invalid(where, std::string(key) + " must have " + std::to_string(components) + " components");
    if (count && *count != view.count) return invalid(where, "its attributes have different numbers of instances");
    count = view.count;
    return view;
}

template <std::size_t N>
std::array<double, N> read(const AccessorView& view, std::uint64_t i, std::array<double, N> fallback) {
    for (std::uint32_t c = 0; view.present() && c < N; ++c) fallback[c] = double{view.number(i, c)};
    return fallback;
}

}  // namespace

Result<std::vector<AffineD>> read_instancing(const GltfDocument& document, const Json& extension, std::uint64_t limit,
                                             const std::string& where) {
    LUMEL_TRY(const Json* attributes, optional_object(extension, "attributes", where));
    if (!attributes) return invalid(where, "has no 'attributes'");
    std::optional<std::uint64_t> count;
    LUMEL_TRY(const auto translation, open_part(document, *attributes, "TRANSLATION", 3, count, where));
    LUMEL_TRY(const auto rotation, open_part(document, *attributes, "ROTATION", 4, count, where));
    LUMEL_TRY(const auto scale, open_part(document, *attributes, "SCALE", 3, count, where));
    if (!count) return invalid(where, "has neither TRANSLATION, ROTATION nor SCALE");
    if (*count > limit)
        return invalid(where, "asks for " + std::to_string(*count) + " instances, more than such a file can hold");
    std::vector<AffineD> out;
    out.reserve(*count);
    for (std::uint64_t i = 0; i < *count; ++i) {
        const auto q = read<4>(rotation, i, {0, 0, 0, 1});
        if (q == std::array<double, 4>{})
            return invalid(where, "the rotation of instance " + std::to_string(i) + " is zero");
        out.push_back(compose(read<3>(translation, i, {0, 0, 0}), q, read<3>(scale, i, {1, 1, 1})));
    }
    return out;
}

}  // namespace lumel
