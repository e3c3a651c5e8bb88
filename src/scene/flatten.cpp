// Instances to world space: transforms, per-triangle flags, bounds.
#include <algorithm>
#include <limits>

#include "base/check.h"
#include "base/try.h"
#include "scene/world_geometry.h"

namespace lumel {
namespace {

// A vertex normal this far from the face's (about one degree) means a smooth-shaded surface; what lies below is the
// rounding of normals stored in 8 bits.
constexpr float kFlatCosine = 0.9998f;

bool takes_part(const Instance& instance) {
    return instance.node_class != NodeClass::probe && instance.node_class != NodeClass::ignored;
}

std::uint8_t smallest_alpha(const Texture& texture) {
    std::uint8_t smallest = 255;
    for (std::size_t i = 3; i < texture.rgba.size(); i += 4) smallest = std::min(smallest, texture.rgba[i]);
    return smallest;
}

// MASK and BLEND materials whose alpha can never let a ray through are as good as opaque, and much faster.
bool may_be_transparent(const Scene& scene, const Material& material) {
    if (material.alpha_mode == AlphaMode::opaque) return false;
    const TextureRef& ref = material.base_color_texture;
    const float texture =
        ref.texture == kNone ? 1.0f : static_cast<float>(smallest_alpha(scene.textures[ref.texture])) / 255.0f;
    return material.alpha * texture < (material.alpha_mode == AlphaMode::mask ? material.alpha_cutoff : 1.0f);
}

std::vector<std::uint8_t> material_flags(const Scene& scene) {
    std::vector<std::uint8_t> flags(scene.materials.size());
    for (std::size_t i = 0; i < flags.size(); ++i) {
        const Material& material = scene.materials[i];
        if (material.double_sided) flags[i] |= kDoubleSided;
        if (may_be_transparent(scene, material)) flags[i] |= kNeedsAlpha;
        if (max_component(material.emission) > 0.0f) flags[i] |= kEmissive;
    }
    return flags;
}

struct Totals {
    std::uint64_t vertices = 0, triangles = 0;
    bool colors = false;
};

Totals count(const Scene& scene) {
    Totals totals;
    for (const Instance& instance : scene.instances) {
        if (!takes_part(instance)) continue;
        const Mesh& mesh = *scene.meshes[instance.mesh];
        totals.vertices += mesh.positions.size();
        totals.triangles += mesh.triangles.size();
        totals.colors = totals.colors || !mesh.colors.empty();
    }
    return totals;
}

class Flattener {
public:
    Flattener(const Scene& scene, Context& context) : scene_(scene), context_(context), flags_(material_flags(scene)) {}

    Result<WorldGeometry> run() {
        LUMEL_TRY_STATUS(reserve(count(scene_)));
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
            out_.first_triangle.push_back(out_.triangle_count());
            if (takes_part(scene_.instances[i])) LUMEL_TRY_STATUS(add(i));
        }
        out_.first_triangle.push_back(out_.triangle_count());
        return std::move(out_);
    }

private:
    Status reserve(const Totals& totals) {
        if (totals.vertices >= kNone || totals.triangles >= kNone)
            return Error{ErrorCode::unsupported, "more than 2^32 triangles or vertices once instances are expanded",
                         scene_.source, "split the scene"};
        out_.positions.reserve(totals.vertices);
        out_.normals.reserve(totals.vertices);
        out_.uv0.reserve(totals.vertices);
        out_.uv1.reserve(totals.vertices);
        if (totals.colors) out_.colors.reserve(totals.vertices);
        out_.triangles.reserve(totals.triangles);
        with_colors_ = totals.colors;
        return success();
    }

    Status add(std::uint32_t index) {
        const Instance& instance = scene_.instances[index];
        const Mesh& mesh = *scene_.meshes[instance.mesh];
        const auto first_vertex = static_cast<std::uint32_t>(out_.positions.size());
        LUMEL_TRY_STATUS(add_vertices(instance, mesh));
        for (const Primitive& primitive : mesh.primitives) add_triangles(index, mesh, primitive, first_vertex);
        return success();
    }

    Status add_vertices(const Instance& instance, const Mesh& mesh) {
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const Vec3 position = transform_point(instance.transform, mesh.positions[v]);
            if (!is_finite(position))
                return Error{ErrorCode::invalid_input, "vertex " + std::to_string(v) + " is not finite in world space",
                             scene_.source + ": node '" + instance.name + "', mesh '" + mesh.name + "'",
                             "check the node's transform"};
            include_in_bounds(position);
            out_.positions.push_back(position);
            // A transform that flattens the mesh leaves no normal; the mesh's own is as good as any.
            out_.normals.push_back(
                normalize_or(transform_normal(instance.transform, mesh.normals[v]), mesh.normals[v]));
        }
        extend(out_.uv0, mesh.uv0, Vec2{});
        extend(out_.uv1, mesh.uv1, Vec2{});
        if (with_colors_) extend(out_.colors, mesh.colors, Vec4{1, 1, 1, 1});
        return success();
    }

    template <class T>
    void extend(std::vector<T>& to, const std::vector<T>& from, T absent) {
        to.insert(to.end(), from.begin(), from.end());
        to.resize(out_.positions.size(), absent);
    }

    void add_triangles(std::uint32_t index, const Mesh& mesh, const Primitive& primitive, std::uint32_t first_vertex) {
        const Instance& instance = scene_.instances[index];
        const std::uint32_t material =
            primitive.material == kNone ? static_cast<std::uint32_t>(scene_.materials.size() - 1) : primitive.material;
        const std::uint8_t flags = flags_of(instance, mesh, material);
        for (std::uint32_t t = 0; t < primitive.triangle_count; ++t) {
            const std::uint32_t mesh_triangle = primitive.first_triangle + t;
            const Triangle& v = mesh.triangles[mesh_triangle];
            out_.triangles.push_back({{v[0] + first_vertex, v[1] + first_vertex, v[2] + first_vertex},
                                      material,
                                      index,
                                      mesh_triangle,
                                      flags,
                                      {},
                                      0.0f});
            finish_triangle(out_.triangle_count() - 1);
        }
    }

    [[nodiscard]] std::uint8_t flags_of(const Instance& instance, const Mesh& mesh, std::uint32_t material) const {
        std::uint8_t flags = flags_[material];
        // Vertex alpha can let rays through where factor and texture would not.
        if (!mesh.colors.empty() && scene_.materials[material].alpha_mode != AlphaMode::opaque) flags |= kNeedsAlpha;
        if (instance.node_class == NodeClass::occluder)
            flags = static_cast<std::uint8_t>((flags | kOccluderOnly) & ~kEmissive);
        if (determinant(instance.transform) < 0.0f) flags |= kMirrored;
        return flags;
    }

    void finish_triangle(std::uint32_t triangle) {
        WorldTriangle& t = out_.triangles[triangle];
        t.normal = out_.compute_normal(triangle);
        t.tracer_error = out_.compute_tracer_error(triangle);
        const Vec3 face = t.normal;
        if (face == Vec3{}) {
            const Instance& instance = scene_.instances[t.instance];
            context_.diagnostics.add("zero-area-triangle", "Triangles without area get no texels and stop no rays",
                                     instance.name + " triangle " + std::to_string(t.mesh_triangle));
            return;
        }
        const bool curved = std::any_of(t.vertices.begin(), t.vertices.end(),
                                        [&](std::uint32_t v) { return dot(out_.normals[v], face) < kFlatCosine; });
        if (curved) t.flags |= kCurved;
    }

    void include_in_bounds(Vec3 position) {
        if (out_.positions.empty()) out_.bounds_min = out_.bounds_max = position;
        out_.bounds_min = min(out_.bounds_min, position);
        out_.bounds_max = max(out_.bounds_max, position);
    }

    const Scene& scene_;
    Context& context_;
    std::vector<std::uint8_t> flags_;  // per material
    bool with_colors_ = false;
    WorldGeometry out_;
};

}  // namespace

Result<WorldGeometry> flatten(const Scene& scene, Context& context) { return Flattener(scene, context).run(); }

}  // namespace lumel
