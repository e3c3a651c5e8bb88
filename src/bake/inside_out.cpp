#include "bake/inside_out.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/sampler.h"

namespace lumel {
namespace {

constexpr std::uint64_t kKey = 0x1bacd5u;  // of the random numbers: the same warnings for any seed

// Paths from the backs of a node's faces, spread over its triangles.
bool is_lit_from_behind(std::uint32_t instance, const Transport& transport, const PathIntegrator& integrator,
                        PathIntegrator::Workspace& workspace) {
    const std::uint32_t first = transport.geometry.first_triangle[instance];
    const std::uint64_t count = transport.geometry.first_triangle[instance + 1] - first;
    if (count == 0) return false;
    const std::uint32_t key = sampler_key(kKey, instance);
    std::array<SamplePoint, kWavefrontLanes> points;
    for (std::uint32_t i = 0; i < kWavefrontLanes; ++i) {
        const std::uint32_t a = mix32(key + i), b = mix32(a ^ 0x9e3779b9u);
        const float root = std::sqrt(unit_float(a)), along = unit_float(b);
        points[i] = {first + static_cast<std::uint32_t>(i * count / kWavefrontLanes), root * (1.0f - along),
                     root * along};
    }
    std::array<std::uint8_t, kWavefrontLanes> back_side;
    back_side.fill(1);
    std::array<SurfaceStart, kWavefrontLanes> surface;
    integrator.surface_starts(points, back_side, workspace, surface);
    std::array<PathStart, kWavefrontLanes> starts;
    for (std::uint32_t i = 0; i < kWavefrontLanes; ++i)
        starts[i] = {surface[i].origin, surface[i].normal, key, i, surface[i].skip};
    std::array<Vec3, kWavefrontLanes> light;
    integrator.gather_irradiance(starts, workspace, light);
    return std::ranges::count_if(light, [](Vec3 v) { return max_component(v) > 0.0f; }) * 8 >=
           std::ptrdiff_t{kWavefrontLanes};
}

}  // namespace

void InsideOutCheck::add(const Lightmap& map) {
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        if (map.coverage[i] == Coverage::dilated) continue;
        const auto after = std::ranges::upper_bound(atlas_.first_placement, map.chart[i]);
        Node& node = nodes_[static_cast<std::size_t>(after - atlas_.first_placement.begin()) - 1];
        ++node.texels;
        if (map.coverage[i] != Coverage::baked) {
            ++node.invalid;
            continue;
        }
        const auto is_dark = [](const LayerMoments& layer) { return layer.irradiance == Vec3{}; };
        node.dark += std::ranges::all_of(map.texels.layers[i], is_dark) ? 1 : 0;
    }
}

void InsideOutCheck::warn(const Transport& transport, Diagnostics& diagnostics) const {
    PathOptions options;
    options.samples = 1;
    const PathIntegrator integrator(transport, options);
    const PathIntegrator::WorkspacePtr workspace = integrator.make_workspace();
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        const Node& node = nodes_[i];
        if (node.texels < kFewestTexelsToWarn) continue;
        const double all = kShareToWarn * static_cast<double>(node.texels);
        const std::string& name = transport.scene.instances[i].name;
        if (static_cast<double>(node.invalid) >= all)
            diagnostics.add("backs-seen",
                            "Nearly all texels of these nodes see the backs of single-sided faces, and have no light "
                            "of their own: what surrounds them is inside out, or they are inside something solid; "
                            "flip the faces of what surrounds them, or make its material doubleSided",
                            name);
        else if (static_cast<double>(node.dark + node.invalid) >= all &&
                 is_lit_from_behind(i, transport, integrator, *workspace))
            diagnostics.add("inside-out",
                            "These nodes are black, but light reaches the backs of their faces: the faces look the "
                            "wrong way; flip them (their order of vertices and their normals), or make the material "
                            "doubleSided and bake with --two-sided",
                            name);
    }
}

}  // namespace lumel
