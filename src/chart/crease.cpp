#include "chart/crease.h"

#include <algorithm>
#include <cmath>

namespace lumel {
namespace {

// Do both triangles shade the shared edge with the same vertex normals (within 10 degrees)?
bool shaded_smoothly(const Mesh& mesh, std::uint32_t edge, std::uint32_t twin) {
    constexpr float kSameNormalCos = 0.985f;
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
        return a == b || dot(mesh.normals[a], mesh.normals[b]) > kSameNormalCos;
    };
    return same(corner_vertex(mesh, edge), corner_vertex(mesh, next_edge(twin))) &&
           same(corner_vertex(mesh, next_edge(edge)), corner_vertex(mesh, twin));
}

}  // namespace

bool is_crease(const Mesh& mesh, const MeshTopology& topology, const CreaseRule& rule, std::uint32_t edge) {
    edge = std::min(edge, topology.twin[edge]);
    const std::uint32_t twin = topology.twin[edge];
    const double cosine = dot(topology.normal[edge / 3], topology.normal[twin / 3]);
    if (cosine >= rule.hard_cos) return false;
    return cosine < rule.soft_cos || !shaded_smoothly(mesh, edge, twin);
}

double edge_length(const Mesh& mesh, std::uint32_t edge) {
    const Vec3 a = mesh.positions[corner_vertex(mesh, edge)], b = mesh.positions[corner_vertex(mesh, next_edge(edge))];
    const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
    return std::sqrt(x * x + y * y + z * z);
}

std::vector<SmoothContact> smooth_contacts(const Mesh& mesh, const MeshTopology& topology, const CreaseRule& rule) {
    std::vector<SmoothContact> contacts;
    for (std::uint32_t e = 0; e < topology.twin.size(); ++e) {
        const std::uint32_t twin = topology.twin[e];
        if (twin == kNone || twin < e || is_crease(mesh, topology, rule, e)) continue;
        contacts.push_back({.a = e, .b = twin, .length = edge_length(mesh, e)});
    }
    return contacts;
}

}  // namespace lumel
