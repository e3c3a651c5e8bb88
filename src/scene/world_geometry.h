// The baked instances flattened to world space: one index space of triangles for charts, rays, lights and texels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/hash.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "lumel/scene.h"

namespace lumel {

// What a ray needs to know of a triangle before it touches the material.
enum TriangleFlags : std::uint8_t {
    kDoubleSided = 1,   // both faces are lit and bounce
    kNeedsAlpha = 2,    // MASK or BLEND: the tracer asks the material whether a hit counts
    kOccluderOnly = 4,  // NodeClass::occluder: blocks, bounces nothing
    kEmissive = 8,      // its material emits
    kMirrored = 16,     // the instance has a negative determinant: the front is -cross(e1, e2)
    kCurved = 32,       // some vertex normal differs from the face normal: smooth-shaded
};

struct WorldTriangle {
    Triangle vertices;           // into the arrays below; corner order is the mesh's own, mirrored or not
    std::uint32_t material = 0;  // into Scene::materials, never kNone
    std::uint32_t instance = 0;  // into Scene::instances
    std::uint32_t mesh_triangle = 0;
    std::uint8_t flags = 0;
    Vec3 normal{};  // unit, of the front face; zero for a zero-area triangle. Stored: paths ask for it at every bounce,
    float tracer_error = 0.0f;  // and for this: WorldGeometry::compute_tracer_error
};

// Instances of class probe and ignored have no triangles here. Triangles of an instance are consecutive and in mesh
// order.
struct WorldGeometry {
    std::vector<Vec3> positions;
    std::vector<Vec3>
        normals;  // unit vertex normals; the geometric normal's side is decided by the winding, not by these
    std::vector<Vec2> uv0, uv1;  // one per vertex; zero where the mesh has none
    std::vector<Vec4> colors;    // empty where no mesh has vertex colours
    std::vector<WorldTriangle> triangles;
    std::vector<std::uint32_t> first_triangle;  // per instance, plus one past the end
    Vec3 bounds_min{}, bounds_max{};

    [[nodiscard]] std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(triangles.size()); }
    [[nodiscard]] std::array<Vec3, 3> corners(std::uint32_t triangle) const {
        const Triangle& v = triangles[triangle].vertices;
        return {positions[v[0]], positions[v[1]], positions[v[2]]};
    }
    // Unit normal of the front face; zero for a zero-area triangle.
    [[nodiscard]] Vec3 geometric_normal(std::uint32_t triangle) const { return triangles[triangle].normal; }
    // Interpolated vertex normal at barycentrics (1-b1-b2, b1, b2), unit, on the front side: where the file's normal
    // points behind the face (n . n_g <= 0) it is the face normal. This is the normal that the runtime sees.
    [[nodiscard]] Vec3 shading_normal(std::uint32_t triangle, float b1, float b2) const {
        const WorldTriangle& t = triangles[triangle];
        const Vec3 n =
            normals[t.vertices[0]] * (1.0f - b1 - b2) + normals[t.vertices[1]] * b1 + normals[t.vertices[2]] * b2;
        if (dot(n, t.normal) > 0.0f) return normalize_or(n, t.normal);
        // A triangle without area has no front; the vertex normals are all there is.
        return t.normal != Vec3{} ? t.normal : normalize_or(n, {0, 1, 0});
    }
    [[nodiscard]] Vec3 position(std::uint32_t triangle, float b1, float b2) const {
        const auto [a, b, c] = corners(triangle);
        return a * (1.0f - b1 - b2) + b * b1 + c * b2;
    }
    [[nodiscard]] float area(std::uint32_t triangle) const;
    // From the corners; what `WorldTriangle::normal` is set to.
    [[nodiscard]] Vec3 compute_normal(std::uint32_t triangle) const;
    // How far off the triangle's plane a point may seem to lie to a ray tracer that works in single precision, in
    // metres: u E + 3 gamma(8) E_x E_y E_z / A, where E are the edges of the triangle's bounding box and A is its area
    // (docs/ray-offset.md). Slivers thinner than about 1/1000 of their length get the bound of one of that shape: see
    // Ray::skip.
    [[nodiscard]] float compute_tracer_error(std::uint32_t triangle) const;
};

// Errors: invalid_input for non-finite world positions. Zero-area triangles are counted ("zero-area-triangle") and
// kept.
Result<WorldGeometry> flatten(const Scene& scene, Context& context);

// Hash of everything in the scene that a bake's result depends on.
Hash128 hash_scene(const Scene& scene);

// Checks what every later stage takes for granted: indices in range, all numbers finite, primitives cover the mesh,
// unit directions, textures whole. For scenes built through the API as well as those read from a file.
Status validate(const Scene& scene);

// The part of it that asks about lights and sky, for those who change them later.
Status validate_lighting(const Scene& scene);

// Nits, lux or candela: the brightest light that Lumel takes. The disc of the sun has 1.6e9 nits; a few hundred
// times beyond it, sums over lights and samples still keep far from the end of single precision.
inline constexpr float kMaxRadiance = 1e12f;

}  // namespace lumel
