// Small meshes made of formulas, for tests of charts.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include "lumel/scene.h"

namespace lumel::test {

// Unit vertex normals: sums of the faces around each vertex of the arrays.
inline void add_face_normals(Mesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), Vec3{});
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t[0]];
        const Vec3 n = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
        for (const std::uint32_t v : t) mesh.normals[v] += n;
    }
    for (Vec3& n : mesh.normals) n = normalize_or(n, {0, 1, 0});
}

inline void cover_with_one_primitive(Mesh& mesh) {
    mesh.primitives = {{0, static_cast<std::uint32_t>(mesh.positions.size()), 0,
                        static_cast<std::uint32_t>(mesh.triangles.size()), kNone}};
}

// nu x nv quads over (u, v) in [0, 1]^2, smooth-shaded; the front is dP/du x dP/dv.
inline Mesh surface(std::uint32_t nu, std::uint32_t nv, const std::function<Vec3(float, float)>& position) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= nv; ++j)
        for (std::uint32_t i = 0; i <= nu; ++i)
            mesh.positions.push_back(position(static_cast<float>(i) / static_cast<float>(nu),
                                              static_cast<float>(j) / static_cast<float>(nv)));
    for (std::uint32_t j = 0; j < nv; ++j)
        for (std::uint32_t i = 0; i < nu; ++i) {
            const std::uint32_t a = j * (nu + 1) + i, b = a + 1, c = a + nu + 2, d = a + nu + 1;
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
        }
    add_face_normals(mesh);
    cover_with_one_primitive(mesh);
    return mesh;
}

inline Mesh flat_grid(std::uint32_t n, float edge) {
    return surface(n, n, [&](float u, float v) { return Vec3{edge * u, 0, -edge * v}; });
}

// Angle of a share of a full circle; the whole of it is exactly none, so that closed surfaces weld.
inline float turn_angle(float share) { return share == 1.0f ? 0.0f : 6.2831853f * share; }

// `turn` of a full circle, radius r about the z axis, height h; the outside is the front.
inline Mesh cylinder(std::uint32_t n, float turn, float r, float h) {
    return surface(n, 4, [&](float u, float v) {
        const float angle = turn_angle(turn * u);
        return Vec3{r * std::cos(angle), r * std::sin(angle), h * v};
    });
}

// 2n x n quads; those at the poles have one side without length.
inline Mesh sphere(std::uint32_t n, float r) {
    return surface(2 * n, n, [&](float u, float v) {
        const float phi = turn_angle(u), theta = 3.1415927f * (1.0f - v);
        const float ring = v == 0.0f || v == 1.0f ? 0.0f : r * std::sin(theta);
        return Vec3{ring * std::cos(phi), ring * std::sin(phi), r * std::cos(theta)};
    });
}

// Flat-shaded: four vertices per side.
inline Mesh box(Vec3 size) {
    Mesh mesh;
    const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    const Vec3 sides[6][3] = {{{}, y, x}, {z, x, y}, {{}, z, y}, {x, y, z}, {{}, x, z}, {y, z, x}};
    for (const auto& [corner, u, v] : sides) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3 p : {corner, corner + u, corner + u + v, corner + v}) mesh.positions.push_back(p);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    add_face_normals(mesh);
    cover_with_one_primitive(mesh);
    return mesh;
}

}  // namespace lumel::test
