// Primitives to one Mesh: vertices gathered from accessors, normals finished, sources remembered.
#include "io/gltf_meshes.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "base/try.h"
#include "io/gltf_accessor.h"
#include "io/gltf_topology.h"

namespace lumel {
namespace {

// The attributes of one primitive that a bake needs.
struct Attributes {
    AccessorView position, normal, uv0, uv1, color;  // all but the position may be absent
};

Vec2 vec2(const AccessorView& view, std::uint64_t i) { return {view.number(i, 0), view.number(i, 1)}; }
Vec3 vec3(const AccessorView& view, std::uint64_t i) {
    return {view.number(i, 0), view.number(i, 1), view.number(i, 2)};
}
Vec4 vec4(const AccessorView& view, std::uint64_t i) {
    return {view.number(i, 0), view.number(i, 1), view.number(i, 2), view.components == 4 ? view.number(i, 3) : 1.0f};
}

// Opens attribute `key`; not present() where the primitive does not have it.
Result<AccessorView> open_attribute(const GltfDocument& document, const Json& attributes, const char* key,
                                    std::uint32_t least, std::uint32_t most, const std::string& where) {
    LUMEL_TRY(const std::optional<std::uint64_t> accessor, optional_count(attributes, key, where));
    if (!accessor) return AccessorView{};
    LUMEL_TRY_STATUS(element_exists(document.root, "accessors", *accessor, where));
    LUMEL_TRY(AccessorView view, open_accessor(document, *accessor));
    if (view.components < least || view.components > most || view.component == Component::uint32)
        return invalid(
            where, std::string("accessor ") + std::to_string(*accessor) + " is of no type that " + key + " may have");
    return view;
}

Result<Attributes> open_attributes(const GltfDocument& document, const Json& attributes, ExpansionBudget& budget,
                                   const std::string& where) {
    Attributes out;
    LUMEL_TRY(out.position, open_attribute(document, attributes, "POSITION", 3, 3, where));
    LUMEL_TRY(out.normal, open_attribute(document, attributes, "NORMAL", 3, 3, where));
    LUMEL_TRY(out.uv0, open_attribute(document, attributes, "TEXCOORD_0", 2, 2, where));
    LUMEL_TRY(out.uv1, open_attribute(document, attributes, "TEXCOORD_1", 2, 2, where));
    LUMEL_TRY(out.color, open_attribute(document, attributes, "COLOR_0", 3, 4, where));
    // Colours of integers are normalised by definition; some exporters forget to say so.
    if (out.color.component != Component::float32) out.color.normalized = true;
    for (const AccessorView* attribute : {&out.position, &out.normal, &out.uv0, &out.uv1, &out.color}) {
        if (attribute->present() && attribute->count != out.position.count)
            return invalid(where, "its attributes have different numbers of elements");
        if (attribute->owns_storage()) LUMEL_TRY_STATUS(budget.take(attribute->count, where));
    }
    return out;
}

Result<std::vector<std::uint32_t>> read_indices(const GltfDocument& document, const Json& primitive,
                                                std::uint64_t vertices, ExpansionBudget& budget,
                                                const std::string& where) {
    LUMEL_TRY(const std::optional<std::uint64_t> accessor, optional_count(primitive, "indices", where));
    if (!accessor) {
        LUMEL_TRY_STATUS(budget.take(vertices, where));
        std::vector<std::uint32_t> indices(vertices);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    LUMEL_TRY_STATUS(element_exists(document.root, "accessors", *accessor, where));
    LUMEL_TRY(const AccessorView view, open_accessor(document, *accessor));
    if (view.components != 1 || (view.component != Component::uint8 && view.component != Component::uint16 &&
                                 view.component != Component::uint32))
        return invalid(where, "its indices are not unsigned integers");
    LUMEL_TRY_STATUS(budget.take(view.count, where));
    std::vector<std::uint32_t> indices(view.count);
    for (std::uint64_t i = 0; i < view.count; ++i) {
        indices[i] = view.index(i);
        if (indices[i] >= vertices)
            return invalid(where,
                           "index " + std::to_string(i) + " is " + std::to_string(indices[i]) +
                               ", out of range: there are " + std::to_string(vertices) + " vertices",
                           "export the mesh again");
    }
    return indices;
}

// Which elements become vertices; rewrites the triangles to index them. Empty means all, in order.
//
// glTF wants flat shading where NORMAL is absent, so each corner gets a vertex of its own. Where the triangles use only
// a part of the vertices (many primitives share one buffer), the others are left out. The order is kept in both cases.
std::vector<std::uint32_t> unweld(std::vector<Triangle>& triangles) {
    std::vector<std::uint32_t> source;
    source.reserve(triangles.size() * 3);
    for (Triangle& triangle : triangles)
        for (std::uint32_t& corner : triangle) {
            source.push_back(corner);
            corner = static_cast<std::uint32_t>(source.size() - 1);
        }
    return source;
}

std::vector<std::uint32_t> drop_unused(std::vector<Triangle>& triangles, std::uint64_t vertices) {
    std::vector<std::uint32_t> used;
    used.reserve(triangles.size() * 3);
    for (const Triangle& triangle : triangles) used.insert(used.end(), triangle.begin(), triangle.end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    if (used.size() == vertices) return {};
    for (Triangle& triangle : triangles)
        for (std::uint32_t& corner : triangle)
            corner = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), corner) - used.begin());
    return used;
}

// Zeros (or white) where earlier primitives had no such attribute and this one has, and the other way round.
template <class T, class Read>
void append(std::vector<T>& to, std::size_t before, std::size_t added, const AccessorView& view, T absent,
            Read&& read) {
    if (!view.present() && to.empty()) return;
    to.resize(before, absent);
    for (std::size_t v = 0; v < added; ++v) to.push_back(view.present() ? read(v) : absent);
}

class MeshReader {
public:
    MeshReader(const GltfDocument& document, std::uint64_t index, ExpansionBudget& budget, Diagnostics& diagnostics)
        : document_(document), index_(index), budget_(budget), diagnostics_(diagnostics) {}

    Result<ReadMesh> read() {
        LUMEL_TRY(const Json* json, element(document_.root, "meshes", index_, document_.where));
        name_ = label("mesh", index_, *json);
        LUMEL_TRY(mesh_.name,
                  string_or(*json, "name", "mesh " + std::to_string(index_), document_.where + ": " + name_));
        source_.gltf_mesh = static_cast<std::uint32_t>(index_);
        const std::size_t count = array_size(*json, "primitives");
        for (std::size_t i = 0; i < count; ++i) {
            LUMEL_TRY(const Json* primitive, element(*json, "primitives", i, document_.where + ": " + name_));
            LUMEL_TRY_STATUS(read_primitive(*primitive, static_cast<std::uint32_t>(i)));
        }
        ReadMesh out{nullptr, std::move(source_)};
        if (!mesh_.triangles.empty()) out.mesh = std::make_shared<const Mesh>(std::move(mesh_));
        return out;
    }

private:
    Status read_primitive(const Json& json, std::uint32_t index) {
        const std::string name = name_ + ", primitive " + std::to_string(index);
        const std::string where = document_.where + ": " + name;
        LUMEL_TRY(const std::uint64_t mode_code, count_or(json, "mode", 4, where));
        if (mode_code > 6)
            return invalid(where, "'mode' is " + std::to_string(mode_code) + ", which glTF does not know");
        const auto mode = static_cast<PrimitiveMode>(mode_code);
        if (!has_triangles(mode)) return skip(name, "Points and lines are skipped: they have no surface");
        LUMEL_TRY(const Json* attributes, optional_object(json, "attributes", where));
        if (!attributes || !find(*attributes, "POSITION"))
            return skip(name, "Primitives without positions are skipped");
        LUMEL_TRY_STATUS(refuse_draco(json, *attributes, where));
        if (array_size(json, "targets") > 0)
            diagnostics_.add("morph-targets", "Morph targets are not applied: the mesh is baked in its base shape",
                             name);

        LUMEL_TRY(const Attributes open, open_attributes(document_, *attributes, budget_, where));
        LUMEL_TRY(const auto indices, read_indices(document_, json, open.position.count, budget_, where));
        LUMEL_TRY(std::vector<Triangle> triangles, make_triangles(mode, indices, where));
        if (triangles.empty()) return skip(name, "Primitives without triangles are skipped");
        LUMEL_TRY(const std::uint32_t material, material_index(json, where));
        return add(open, std::move(triangles), material, index, name);
    }

    Status skip(const std::string& name, const char* why) {
        diagnostics_.add("skipped-primitive", why, name);
        return success();
    }

    // A Draco primitive may carry plain accessors as a fallback; then those are read.
    Status refuse_draco(const Json& primitive, const Json& attributes, const std::string& where) {
        if (!find_extension(primitive, "KHR_draco_mesh_compression")) return success();
        LUMEL_TRY(const std::uint64_t accessor, required_count(attributes, "POSITION", where));
        LUMEL_TRY(const Json* position, element(document_.root, "accessors", accessor, where));
        if (find(*position, "bufferView")) return success();
        return unsupported(where, "is compressed with KHR_draco_mesh_compression, which Lumel does not read",
                           "decompress it: gltf-transform copy in.glb out.glb");
    }

    Result<std::uint32_t> material_index(const Json& primitive, const std::string& where) {
        LUMEL_TRY(const std::optional<std::uint64_t> material, optional_count(primitive, "material", where));
        if (!material) return kNone;
        if (*material >= array_size(document_.root, "materials"))
            return invalid(where, "refers to materials[" + std::to_string(*material) + "], which does not exist");
        return static_cast<std::uint32_t>(*material);
    }

    Status add(const Attributes& open, std::vector<Triangle> triangles, std::uint32_t material, std::uint32_t index,
               const std::string& name) {
        PrimitiveSource source{index, {}, !open.normal.present()};
        source.vertex = open.normal.present() ? drop_unused(triangles, open.position.count) : unweld(triangles);
        const std::size_t count = source.vertex.empty() ? open.position.count : source.vertex.size();
        LUMEL_TRY_STATUS(budget_.take(count, document_.where + ": " + name));
        if (mesh_.positions.size() + count >= kNone)
            return unsupported(document_.where + ": " + name, "has more than 2^32 vertices");

        Primitive primitive{static_cast<std::uint32_t>(mesh_.positions.size()), static_cast<std::uint32_t>(count),
                            static_cast<std::uint32_t>(mesh_.triangles.size()),
                            static_cast<std::uint32_t>(triangles.size()), material};
        for (const Triangle& t : triangles)
            mesh_.triangles.push_back(
                {t[0] + primitive.first_vertex, t[1] + primitive.first_vertex, t[2] + primitive.first_vertex});
        append_vertices(open, source, count);
        LUMEL_TRY_STATUS(check_finite(primitive, source, name));
        finish_normals(primitive, open.normal.present(), name);
        mesh_.primitives.push_back(primitive);
        source_.primitives.push_back(std::move(source));
        return success();
    }

    void append_vertices(const Attributes& open, const PrimitiveSource& source, std::size_t count) {
        const std::size_t before = mesh_.positions.size();
        const auto element = [&](std::size_t v) { return source.element(static_cast<std::uint32_t>(v)); };
        for (std::size_t v = 0; v < count; ++v) {
            mesh_.positions.push_back(vec3(open.position, element(v)));
            mesh_.normals.push_back(open.normal.present() ? vec3(open.normal, element(v)) : Vec3{});
        }
        append(mesh_.uv0, before, count, open.uv0, Vec2{}, [&](std::size_t v) { return vec2(open.uv0, element(v)); });
        append(mesh_.uv1, before, count, open.uv1, Vec2{}, [&](std::size_t v) { return vec2(open.uv1, element(v)); });
        append(mesh_.colors, before, count, open.color, Vec4{1, 1, 1, 1}, [&](std::size_t v) {
            const Vec4 c = vec4(open.color, element(v));
            return Vec4{std::max(c.x, 0.0f), std::max(c.y, 0.0f), std::max(c.z, 0.0f), std::max(c.w, 0.0f)};
        });
    }

    Status check_finite(const Primitive& primitive, const PrimitiveSource& source, const std::string& name) {
        for (std::uint32_t v = 0; v < primitive.vertex_count; ++v) {
            const std::size_t i = primitive.first_vertex + v;
            const char* what = nullptr;
            if (!is_finite(mesh_.positions[i])) what = "POSITION";
            if (!is_finite(mesh_.normals[i])) what = "NORMAL";
            if (!mesh_.uv0.empty() && !is_finite(mesh_.uv0[i])) what = "TEXCOORD_0";
            if (!mesh_.uv1.empty() && !is_finite(mesh_.uv1[i])) what = "TEXCOORD_1";
            if (!mesh_.colors.empty()) {
                const Vec4 c = mesh_.colors[i];
                if (!is_finite(Vec3{c.x, c.y, c.z}) || !std::isfinite(c.w)) what = "COLOR_0";
            }
            if (what)
                return invalid(document_.where + ": " + name + ", vertex " + std::to_string(source.element(v)),
                               std::string(what) + " is not finite", "repair the mesh and export it again");
        }
        return success();
    }

    // Unit normals: the file's, or the face's where the file has none or one without direction.
    void finish_normals(const Primitive& primitive, bool from_file, const std::string& name) {
        std::uint64_t without_direction = 0;
        for (std::uint32_t v = 0; v < primitive.vertex_count; ++v) {
            Vec3& normal = mesh_.normals[primitive.first_vertex + v];
            normal = normalize_or(normal, Vec3{});
            if (normal == Vec3{}) ++without_direction;
        }
        if (without_direction == 0) return;
        make_missing_normals(primitive);
        if (from_file)
            diagnostics_.add("zero-length-normal",
                             "Vertex normals of length zero were replaced by the normal of the faces around them", name,
                             without_direction);
        else
            diagnostics_.add("missing-normals", "Primitives without NORMAL are flat-shaded, as glTF asks", name);
    }

    // Vertices with a zero normal get the area-weighted mean of their faces; (0, 1, 0) where that is zero too.
    void make_missing_normals(const Primitive& primitive) {
        std::vector<Vec3> sum(primitive.vertex_count);
        for (std::uint32_t t = 0; t < primitive.triangle_count; ++t) {
            const Triangle& corners = mesh_.triangles[primitive.first_triangle + t];
            const Vec3 a = mesh_.positions[corners[0]], b = mesh_.positions[corners[1]],
                       c = mesh_.positions[corners[2]];
            const Vec3 area = cross(b - a, c - a);
            for (const std::uint32_t corner : corners) sum[corner - primitive.first_vertex] += area;
        }
        for (std::uint32_t v = 0; v < primitive.vertex_count; ++v) {
            Vec3& normal = mesh_.normals[primitive.first_vertex + v];
            if (normal == Vec3{}) normal = direction_of(sum[v]);
        }
    }

    // Scaled first: the squared length of a small face's area vector would vanish.
    static Vec3 direction_of(Vec3 v) {
        const float scale = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
        if (!(scale > 0.0f) || !std::isfinite(scale)) return {0, 1, 0};
        return normalize(v / scale);
    }

    const GltfDocument& document_;
    std::uint64_t index_;
    ExpansionBudget& budget_;
    Diagnostics& diagnostics_;
    std::string name_;
    Mesh mesh_;
    MeshSource source_;
};

}  // namespace

Status ExpansionBudget::take(std::uint64_t items, const std::string& where) {
    if (items > left_)
        return unsupported(where, "the scene grows to far more vertices and indices than its file size allows",
                           "the file is damaged, or shares its vertex buffers in an unusual way: export it again");
    left_ -= items;
    return success();
}

Result<ReadMesh> read_mesh(const GltfDocument& document, std::uint64_t index, ExpansionBudget& budget,
                           Diagnostics& diagnostics) {
    return MeshReader(document, index, budget, diagnostics).read();
}

}  // namespace lumel
