// Charts of real scenes: how many, how much smooth surface they cut, stretch, coverage, CPU seconds; flips, overlaps
// and unmapped faces by the independent checker. --write leaves the meshes for scripts/charts-peer, which prints the
// first columns for another unwrapper.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "bench.h"
#include "chart/chart_picture.h"
#include "chart/chart_set.h"
#include "chart/crease.h"
#include "chart/t_junctions.h"
#include "chart/topology.h"
#include "io/image_io.h"
#include "load.h"
#include "support/chart_checker.h"

namespace lumel::bench {
namespace {

struct Options {
    std::vector<std::string> scenes;
    std::string uv1 = "automatic", pictures, write;
    unsigned threads = 1;
    double texels = 1e6;
};

// ---- Seams ----------------------------------------------------------------------------------------------------------

Vec2 along(const UvTriangle& uv, std::uint32_t corner, double s) {
    return uv[corner] + (uv[(corner + 1) % 3] - uv[corner]) * static_cast<float>(s);
}

// Do the two triangles lie on other places of the layout where they touch on the surface?
bool is_cut(const MeshCharts& charts, const SmoothContact& c) {
    const std::uint32_t chart = charts.chart_of_triangle[c.a / 3];
    if (chart == kNone || chart != charts.chart_of_triangle[c.b / 3]) return true;
    const UvTriangle &a = charts.uv[c.a / 3], &b = charts.uv[c.b / 3];
    const Vec2 a_from = along(a, c.a % 3, c.a_from), a_to = along(a, c.a % 3, c.a_to);
    const Vec2 b_from = along(b, c.b % 3, c.b_from), b_to = along(b, c.b % 3, c.b_to);
    // A hundredth of the piece, or the rounding of the coordinates: no runtime shows that.
    const Vec2 extent = charts.charts[chart].max - charts.charts[chart].min;
    const float tolerance = std::max(0.01f * length(a_to - a_from), 1e-5f * std::max(extent.x, extent.y));
    return length(a_from - b_from) > tolerance || length(a_to - b_to) > tolerance;
}

struct Figures {
    std::size_t triangles = 0, charts = 0, meshes = 0;
    double surface = 0.0, smooth_edges = 0.0, seam = 0.0;
};

// ---- What the peer reads --------------------------------------------------------------------------------------------

template <class T>
void put(std::ofstream& file, const T& value) {
    file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void put_all(std::ofstream& file, const std::vector<T>& values) {
    file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

// Little-endian: the counts of vertices, triangles and contacts, float positions and normals, indices; per contact the
// two edges (u32), then a_from, a_to, b_from, b_to and length (f64). Meshes follow each other to the end of the file.
void write_mesh(std::ofstream& file, const Mesh& mesh, const std::vector<SmoothContact>& contacts) {
    put(file, static_cast<std::uint32_t>(mesh.positions.size()));
    put(file, static_cast<std::uint32_t>(mesh.triangles.size()));
    put(file, static_cast<std::uint32_t>(contacts.size()));
    put_all(file, mesh.positions);
    put_all(file, mesh.normals);
    put_all(file, mesh.triangles);
    for (const SmoothContact& c : contacts) {
        put(file, c.a), put(file, c.b);
        put(file, c.a_from), put(file, c.a_to), put(file, c.b_from), put(file, c.b_to), put(file, c.length);
    }
}

// ---- A scene --------------------------------------------------------------------------------------------------------

void measure_mesh(const Mesh& mesh, const MeshCharts& charts, std::ofstream& file, Figures& figures) {
    const MeshTopology topology = build_topology(mesh);
    std::vector<SmoothContact> contacts = smooth_contacts(mesh, topology, {});
    const std::vector<SmoothContact> across = t_junctions(mesh, topology);
    contacts.insert(contacts.end(), across.begin(), across.end());
    ++figures.meshes;
    figures.charts += charts.charts.size();
    for (const double area : topology.area) {
        figures.triangles += area > 0.0;
        figures.surface += area;
    }
    for (const SmoothContact& c : contacts) {
        figures.smooth_edges += c.length;
        if (is_cut(charts, c)) figures.seam += c.length;
    }
    if (file.is_open()) write_mesh(file, mesh, contacts);
}

Uv1Policy policy_of(const std::string& name) {
    return name == "mesh" ? Uv1Policy::mesh : name == "ignore" ? Uv1Policy::ignore : Uv1Policy::automatic;
}

void write_pictures(const std::string& folder, const std::string& name, const Scene& scene, const ChartSet& charts,
                    const Atlas& atlas) {
    std::filesystem::create_directories(folder);
    for (std::uint32_t p = 0; p < atlas.pages.size(); ++p)
        need(write_png(std::filesystem::path(folder) / (name + "_" + std::to_string(p) + ".png"), atlas.pages[p].width,
                       atlas.pages[p].height, 3, color_ids(chart_ids(scene, charts, atlas, p))));
}

void run_scene(const std::string& path, const Options& options) {
    Context context(options.threads);
    LoadedScene loaded = need(load_scene(path, context));
    Scene& scene = loaded.scene;
    for (Instance& i : scene.instances)
        if (i.node_class == NodeClass::probe) i.node_class = NodeClass::lightmap;  // charts for all there is
    const WorldGeometry geometry = need(flatten(scene, context));
    ChartOptions chart_options;
    chart_options.uv1 = policy_of(options.uv1);
    chart_options.texel_budget = options.texels;
    const CpuStopwatch unwrap_time;
    const ChartSet charts = need(make_charts(scene, geometry, chart_options, context));
    const double unwrap = unwrap_time.seconds();
    const CpuStopwatch pack_time;
    const Atlas atlas = need(make_atlas(scene, geometry, charts, chart_options, context));
    const double pack = pack_time.seconds();

    const std::string name = base_name(path).substr(0, base_name(path).rfind('.'));
    std::ofstream file;
    if (!options.write.empty()) {
        std::filesystem::create_directories(options.write);
        file.open(std::filesystem::path(options.write) / (name + ".meshes"), std::ios::binary);
    }
    Figures f;
    for (std::size_t m = 0; m < charts.meshes.size(); ++m)
        if (!charts.meshes[m].charts.empty()) measure_mesh(*scene.meshes[m], charts.meshes[m], file, f);
    const test::LayoutReport report = test::ChartChecker(scene, geometry, charts, atlas).run();
    const auto n = [](std::uint64_t count) { return static_cast<unsigned long long>(count); };
    std::printf("%s,%zu,%zu,%zu,%.1f,%.2f,%.2f,%.3f,%.4f,%.3f,%llu,%llu,%llu,%llu,%llu,%.1f,%.2f,%.2f\n", name.c_str(),
                f.meshes, f.triangles, f.charts, 1000.0 * double(f.charts) / double(f.triangles), f.surface, f.seam,
                f.seam / f.surface, report.stretch, report.worst_stretch, n(report.flipped), n(report.overlaps),
                n(report.shared_texels), n(report.unmapped), n(context.diagnostics.count("unwrap-fallback")),
                100.0 * double(report.texels) / double(report.page_texels), unwrap, pack);
    std::fflush(stdout);
    if (!options.pictures.empty()) write_pictures(options.pictures, name, scene, charts, atlas);
}

void run(const Options& options) {
    std::printf(
        "scene,meshes,triangles,charts,charts_per_1000,surface_m2,smooth_seam_m,seam_per_m2,l2_stretch,worst_stretch,"
        "flips,overlaps,shared_texels,unmapped,fallbacks,coverage_percent,unwrap_cpu_seconds,pack_cpu_seconds\n");
    for (const std::string& scene : options.scenes) run_scene(scene, options);
}

}  // namespace

void add_charts(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("charts", "Charts, smooth seams, stretch and CPU seconds of unwrapping");
    command->add_option("scenes", options->scenes, ".glb or .gltf")->required()->check(CLI::ExistingFile);
    command->add_option("--uv1", options->uv1, "automatic, mesh, ignore")
        ->check(CLI::IsMember({"automatic", "mesh", "ignore"}));
    command->add_option("--texels", options->texels, "Budget of the atlas")->check(CLI::PositiveNumber);
    command->add_option("--threads", options->threads, "1 to 256")->check(CLI::Range(1u, 256u));
    command->add_option("--pictures", options->pictures, "Folder for pictures of the pages, a colour per chart");
    command->add_option("--write", options->write, "Folder for the meshes, for scripts/charts-peer");
    command->callback([options] { run(*options); });
}

}  // namespace lumel::bench
