#include "chart/kept_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "base/union_find.h"
#include "chart/atlas_record.h"
#include "chart/chart_mask.h"
#include "chart/mesh_charts.h"
#include "chart/overlap.h"
#include "chart/uv1.h"
#include "chart/where.h"

namespace lumel {
namespace {

// Calls visit(instance, mesh triangle, x, y) for every texel of the page that a chart of a lightmap instance can touch,
// chart by chart; a texel as often as triangles of the chart touch it. Triangles that the layout collapsed are left
// out: they have no light there that could be read.
template <class Visit>
void for_each_texel(const Scene& scene, const ChartSet& charts, AtlasPage page, const Visit& visit) {
    const double floor = uv1_tolerance().floor;
    const TexelMap map{double(page.width), double(page.height), 0.0, 0.0};
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        if (scene.instances[i].node_class != NodeClass::lightmap) continue;
        const MeshCharts& mesh = charts.meshes[scene.instances[i].mesh];
        for (const std::uint32_t t : mesh.order) {
            if (uv_altitude(mesh.uv[t]) <= floor) continue;
            for_each_mask_span(mesh.uv[t], map, page.width, page.height,
                               [&](std::uint32_t y, std::uint32_t x0, std::uint32_t x1) {
                                   for (std::uint32_t x = x0; x < x1; ++x) visit(i, t, x, y);
                               });
        }
    }
}

// ---- Is it one surface? ---------------------------------------------------------------------------------------------

// Where the plane of a triangle puts a point of the layout, and how long a step of one texel is there.
struct PlanePoint {
    double p[3];
    double texel = 0.0;  // metres
};

PlanePoint on_plane(const std::array<Vec3, 3>& corners, const UvTriangle& uv, double u, double v, AtlasPage page) {
    const double cross = uv_cross(uv);
    const double du = u - uv[0].x, dv = v - uv[0].y;
    const double b1 = (du * (double{uv[2].y} - uv[0].y) - dv * (double{uv[2].x} - uv[0].x)) / cross;
    const double b2 = (dv * (double{uv[1].x} - uv[0].x) - du * (double{uv[1].y} - uv[0].y)) / cross;
    PlanePoint out{};
    for (std::size_t c = 0; c < 3; ++c)
        out.p[c] =
            corners[0][c] + b1 * (double{corners[1][c]} - corners[0][c]) + b2 * (double{corners[2][c]} - corners[0][c]);
    const double area = double{length(lumel::cross(corners[1] - corners[0], corners[2] - corners[0]))};
    out.texel = std::sqrt(area / (std::abs(cross) * page.width * page.height));
    return out;
}

// Charts that a layout cut for no reason of light (tiles of one floor side by side) go on in each other: at the texel
// both lie at one place, within a texel, and face one way, within 30 degrees.
bool goes_on(const WorldGeometry& geometry, const ChartSet& charts, const Scene& scene, std::uint32_t a,
             std::uint32_t b, std::uint32_t x, std::uint32_t y, AtlasPage page) {
    constexpr float kOneWay = 0.8660254f;
    if (dot(geometry.geometric_normal(a), geometry.geometric_normal(b)) < kOneWay) return false;
    const auto at = [&](std::uint32_t w) {
        const WorldTriangle& t = geometry.triangles[w];
        const UvTriangle& uv = charts.meshes[scene.instances[t.instance].mesh].uv[t.mesh_triangle];
        return on_plane(geometry.corners(w), uv, (x + 0.5) / page.width, (y + 0.5) / page.height, page);
    };
    const PlanePoint pa = at(a), pb = at(b);
    double apart = 0.0;
    for (std::size_t c = 0; c < 3; ++c) apart += (pa.p[c] - pb.p[c]) * (pa.p[c] - pb.p[c]);
    const double texel = std::min(pa.texel, pb.texel);
    return apart <= texel * texel;
}

}  // namespace

AtlasPage kept_page(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                    const ChartOptions& options) {
    if (options.previous) return options.previous->pages.front();
    if (options.resolution_width != 0) return {options.resolution_width, options.resolution_height};
    double world = 0.0, uv = 0.0;
    for (std::uint32_t t = 0; t < geometry.triangle_count(); ++t) {
        const WorldTriangle& triangle = geometry.triangles[t];
        const Instance& instance = scene.instances[triangle.instance];
        if (instance.node_class != NodeClass::lightmap) continue;
        const MeshCharts& mesh = charts.meshes[instance.mesh];
        if (mesh.chart_of_triangle[triangle.mesh_triangle] == kNone) continue;
        world += geometry.area(t);
        uv += 0.5 * std::abs(uv_cross(mesh.uv[triangle.mesh_triangle]));
    }
    const double texels = options.texels_per_metre > 0.0 ? world * options.texels_per_metre * options.texels_per_metre
                                                         : options.texel_budget;
    const double edge = uv > 0.0 ? std::ceil(std::sqrt(texels / uv) / 4.0) * 4.0 : 4.0;
    const auto size = static_cast<std::uint32_t>(std::clamp(edge, 4.0, static_cast<double>(options.max_page)));
    return {size, size};
}

std::vector<ChartContact> find_contacts(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                        AtlasPage page) {
    constexpr std::uint64_t kNoPair = ~std::uint64_t{0};
    struct Texel {
        std::uint32_t owner = kNone;   // the first world triangle here
        std::uint32_t latest = kNone;  // the chart that was counted last
    };
    std::vector<Texel> texels(std::size_t{page.width} * page.height);
    std::vector<std::uint32_t> first{0};  // charts of all instances in one row
    for (const Instance& instance : scene.instances)
        first.push_back(first.back() + static_cast<std::uint32_t>(charts.meshes[instance.mesh].charts.size()));
    const auto side_of = [&](std::uint32_t world_triangle) {
        const WorldTriangle& t = geometry.triangles[world_triangle];
        const MeshCharts& mesh = charts.meshes[scene.instances[t.instance].mesh];
        return ChartContact::Side{t.instance, mesh.chart_of_triangle[t.mesh_triangle], t.mesh_triangle};
    };

    std::map<std::uint64_t, ChartContact> contacts;  // by the two charts
    std::uint64_t pair = kNoPair;                    // neighbouring texels mostly are of one pair
    ChartContact* contact = nullptr;
    for_each_texel(scene, charts, page, [&](std::uint32_t i, std::uint32_t t, std::uint32_t x, std::uint32_t y) {
        Texel& texel = texels[std::size_t{y} * page.width + x];
        const std::uint32_t world = geometry.first_triangle[i] + t;
        const std::uint32_t chart = first[i] + charts.meshes[scene.instances[i].mesh].chart_of_triangle[t];
        if (texel.owner == kNone) texel = {world, chart};
        if (texel.latest == chart) return;
        texel.latest = chart;
        const ChartContact::Side a = side_of(texel.owner), b = side_of(world);
        const std::uint64_t key = std::uint64_t{first[a.instance] + a.chart} << 32 | chart;
        if (key != pair) {
            pair = key;
            contact = &contacts[key];
        }
        const bool foreign = !goes_on(geometry, charts, scene, texel.owner, world, x, y, page);
        if (contact->texels == 0 || (foreign && contact->foreign == 0)) {
            contact->a = a, contact->b = b;
            contact->texel_x = x, contact->texel_y = y;
        }
        ++contact->texels;
        contact->foreign += foreign ? 1 : 0;
    });
    std::vector<ChartContact> out;
    out.reserve(contacts.size());
    for (const auto& [key, found] : contacts) out.push_back(found);
    return out;
}

void merge_contacts(const Scene& scene, const std::vector<ChartContact>& contacts, ChartSet& charts) {
    std::vector<std::uint32_t> first(charts.meshes.size() + 1, 0);  // charts of all meshes in one row
    for (std::size_t m = 0; m < charts.meshes.size(); ++m)
        first[m + 1] = first[m] + static_cast<std::uint32_t>(charts.meshes[m].charts.size());
    UnionFind united(first.back());
    for (const ChartContact& contact : contacts) {
        if (contact.a.instance != contact.b.instance) continue;
        const std::uint32_t base = first[scene.instances[contact.a.instance].mesh];
        united.unite(base + contact.a.chart, base + contact.b.chart);
    }
    for (std::size_t m = 0; m < charts.meshes.size(); ++m) {
        MeshCharts& mesh = charts.meshes[m];
        std::vector<std::uint32_t> number(mesh.charts.size(), kNone);
        std::uint32_t count = 0;
        for (std::uint32_t c = 0; c < mesh.charts.size(); ++c) {
            const std::uint32_t r = united.find(first[m] + c) - first[m];
            number[c] = r == c ? count++ : number[r];
        }
        if (count == mesh.charts.size()) continue;
        for (std::uint32_t& c : mesh.chart_of_triangle)
            if (c != kNone) c = number[c];
        index_charts(mesh);
    }
}

void report_bleeding(const Scene& scene, std::vector<ChartContact> contacts, AtlasPage page, Diagnostics& diagnostics) {
    std::erase_if(contacts, [](const ChartContact& c) { return c.foreign == 0; });
    std::stable_sort(contacts.begin(), contacts.end(),
                     [](const ChartContact& x, const ChartContact& y) { return x.foreign > y.foreign; });
    const auto side = [&](const ChartContact::Side& s) {
        return node_and_mesh(scene, s.instance) + " chart " + std::to_string(s.chart) + " triangle " +
               std::to_string(s.triangle);
    };
    const auto text = [&](const ChartContact& c) {
        const Vec2 uv{(static_cast<float>(c.texel_x) + 0.5f) / static_cast<float>(page.width),
                      (static_cast<float>(c.texel_y) + 0.5f) / static_cast<float>(page.height)};
        return side(c.a) + " and " + side(c.b) + ": " + std::to_string(c.foreign) +
               (c.foreign == 1 ? " texel of " : " texels of ") + std::to_string(page.width) + "x" +
               std::to_string(page.height) + " at UV " + uv_text(uv);
    };
    for (std::size_t k = 0; k < contacts.size(); ++k)
        diagnostics.add("uv-bleeding",
                        "texels are read by two charts of TEXCOORD_1 under bilinear filtering, so that light of one "
                        "shows on the other; the layout was kept as it is: give it more padding, ask for a higher "
                        "--resolution, or take --uv1 mesh to have its charts packed anew",
                        k < Diagnostics::kMaxExamples ? text(contacts[k]) : "", contacts[k].foreign);
}

}  // namespace lumel
