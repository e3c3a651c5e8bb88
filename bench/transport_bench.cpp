// Error against cost: each method of the table, at several numbers of samples, scored against a reference of two
// halves. Rays and CPU seconds are those of the gathering alone, with all that a method prepares for it; charts,
// rasterising and the acceleration structure are common to all and left out.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "bench.h"
#include "bench_scene.h"
#include "io/image_io.h"
#include "load.h"
#include "math/normal_quantile.h"
#include "methods.h"
#include "plot/plot.h"
#include "reference.h"
#include "score.h"

namespace lumel::bench {
namespace {

struct Options {
    std::vector<std::string> scenes, methods;
    std::vector<std::uint32_t> samples{16, 64, 256};
    std::vector<std::uint32_t> resolution{256, 256};
    std::size_t texels = 0;
    double texel_budget = 20000.0;
    ReferenceOptions reference{default_reference_folder()};
    std::string sky_map, reference_folder, csv, plot, stop = "fixed";
    double error = 0.05, confidence = 0.95;
    std::uint32_t seed = 1, runs = 1;
    unsigned threads = 0;
};

struct Row {
    std::string scene;
    std::string_view method;
    std::uint32_t samples = 0;
    double mean_samples = 0.0;
    std::uint64_t rays = 0;
    double cpu_seconds = 0.0;
    Score score;

    [[nodiscard]] double efficiency() const { return 1.0 / (score.relmse * static_cast<double>(rays)); }
};

// Lines to standard output and, where asked for, to a file; each at once, so that a run that is ended leaves its rows.
class Csv {
public:
    explicit Csv(const std::string& file) {
        if (file.empty()) return;
        file_.open(file);
        if (!file_) throw std::runtime_error("cannot write " + file);
    }
    void line(const std::string& text) {
        std::printf("%s\n", text.c_str());
        std::fflush(stdout);
        if (file_.is_open()) file_ << text << std::endl;
    }

private:
    std::ofstream file_;
};

// A scene that is one atlas already keeps it, at the size that is asked; others get charts by the texel budget.
std::unique_ptr<BenchScene> load(const Options& options, const std::string& path, Context& context) {
    ChartOptions charts;
    charts.texel_budget = options.texel_budget;
    if (base_name(path).starts_with("bench_")) {
        charts.resolution_width = options.resolution.at(0);
        charts.resolution_height = options.resolution.at(1);
    }
    return std::make_unique<BenchScene>(path, charts, context, options.sky_map);
}

std::vector<const Method*> chosen_methods(const Options& options) {
    std::vector<const Method*> out;
    for (const Method& method : methods())
        if (options.methods.empty() && method.by_default) out.push_back(&method);
    for (const std::string& name : options.methods) {
        const Method* method = find_method(name);
        if (!method) throw std::runtime_error("no method is called " + name);
        out.push_back(method);
    }
    return out;
}

PathOptions path_options(const Options& options, const BenchScene& bench, std::uint32_t samples) {
    PathOptions path;
    path.samples = samples;
    path.seed = options.seed;
    path.ao_distance = bench.ao_distance();
    if (options.stop == "flux") {
        path.stop = StopRule::flux;
        path.relative_error_of_mean = options.error / normal_quantile(0.5 + 0.5 * options.confidence);
    }
    return path;
}

void add(Score& sum, const Score& s, double share) {
    sum.texels = s.texels;
    sum.relmse += share * s.relmse;
    sum.relmse_without_worst += share * s.relmse_without_worst;
    sum.relmse_sh += share * s.relmse_sh;
    sum.bias += share * s.bias;
    sum.coverage += share * s.coverage;
    sum.lowest_coverage += share * s.lowest_coverage;
    sum.highest_coverage += share * s.highest_coverage;
    sum.block_bias += share * s.block_bias;
    sum.block_noise += share * s.block_noise;
    sum.reference_relmse += share * s.reference_relmse;
}

// The mean of several runs, with one seed after the other.
Row measure(const Method& method, GatherJob job, std::uint32_t runs, const ReferenceHalf& a, const ReferenceHalf& b) {
    Row row;
    row.scene = job.bench.name;
    row.method = method.name;
    row.samples = job.path.samples;
    std::uint64_t traced = 0;
    for (std::uint32_t run = 0; run < runs; ++run, ++job.path.seed) {
        const std::uint64_t rays_before = job.bench.tracer->statistics().rays;
        const CpuStopwatch stopwatch;
        const RadianceSums sums = method.gather(job);
        row.cpu_seconds += stopwatch.seconds() / runs;
        row.rays += job.bench.tracer->statistics().rays - rays_before;
        for (const std::uint32_t n : sums.count) traced += n;
        add(row.score, score(sums, a, b, job.bench.texels, job.range), 1.0 / runs);
    }
    row.rays /= runs;
    row.mean_samples =
        static_cast<double>(traced) / (static_cast<double>(std::max<std::size_t>(1, job.range.count)) * runs);
    return row;
}

constexpr const char* kHeader =
    "scene,width,height,texels,method,samples,mean_samples,rays,cpu_seconds,relmse_i,relmse_i_without_worst,relmse_sh,"
    "bias,block_bias_p95,block_noise_p95,coverage,lowest_coverage,highest_coverage,efficiency_over_flux,reference_"
    "samples,reference_relmse";

std::string csv_row(const Row& row, const BenchScene& bench, const std::string& over_flux, std::uint64_t reference) {
    char text[512];
    const Score& s = row.score;
    std::snprintf(text, sizeof text,
                  "%s,%u,%u,%zu,%s,%u,%.1f,%llu,%.3f,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.3f,%.3f,%.3f,%s,%llu,%.3g",
                  row.scene.c_str(), bench.texels.width, bench.texels.height, s.texels, std::string(row.method).c_str(),
                  row.samples, row.mean_samples, static_cast<unsigned long long>(row.rays), row.cpu_seconds, s.relmse,
                  s.relmse_without_worst, s.relmse_sh, s.bias, s.block_bias, s.block_noise, s.coverage,
                  s.lowest_coverage, s.highest_coverage, over_flux.c_str(), static_cast<unsigned long long>(reference),
                  s.reference_relmse);
    return text;
}

// 1/(relMSE x rays) over that of the peer with one light, at the same samples; empty where that did not run before.
std::string efficiency_over_flux(const Row& row, const std::vector<Row>& before) {
    for (const Row& flux : before)
        if (flux.method == "flux-uniform" && flux.scene == row.scene && flux.samples == row.samples) {
            char text[32];
            std::snprintf(text, sizeof text, "%.3g", row.efficiency() / flux.efficiency());
            return text;
        }
    return {};
}

void write_plot(const std::string& file, const std::vector<Row>& rows) {
    std::vector<PlotPanel> panels;
    for (const Row& row : rows) {
        if (panels.empty() || panels.back().title != row.scene)
            panels.push_back({row.scene, "CPU seconds", "relMSE of I", {}});
        std::vector<PlotLine>& lines = panels.back().lines;
        auto line = std::ranges::find(lines, row.method, &PlotLine::name);
        if (line == lines.end()) line = lines.insert(line, {std::string(row.method), {}});
        line->points.push_back({row.cpu_seconds, row.score.relmse});
    }
    const Image image = draw_plot(panels);
    std::vector<std::uint8_t> bytes(image.data.size());
    std::ranges::transform(image.data, bytes.begin(), [](float v) {
        return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f);
    });
    need(write_png(file, image.width, image.height, 3, bytes));
}

void run_transport(Options options) {
    if (!options.reference_folder.empty()) options.reference.folder = options.reference_folder;
    const std::vector<const Method*> chosen = chosen_methods(options);
    Csv csv(options.csv);
    csv.line(kHeader);
    std::vector<Row> rows;
    for (const std::string& path : options.scenes) {
        Context context(options.threads);
        const std::unique_ptr<BenchScene> bench = load(options, path, context);
        const TexelRange range = bench->middle_texels(options.texels);
        const ReferenceHalf a = reference_half(*bench, range, 0, options.reference, context);
        const ReferenceHalf b = reference_half(*bench, range, 1, options.reference, context);
        for (const Method* method : chosen)
            for (const std::uint32_t samples : options.samples) {
                Row row = measure(*method, {*bench, path_options(options, *bench, samples), range, context},
                                  options.runs, a, b);
                rows.push_back(row);
                csv.line(csv_row(row, *bench, efficiency_over_flux(row, rows), std::min(a.samples, b.samples)));
            }
    }
    if (!options.plot.empty()) write_plot(options.plot, rows);
}

std::string list_of_methods() {
    std::string out = "Methods:\n";
    for (const Method& m : methods())
        out += "  " + std::string(m.name) + ": " + std::string(m.about) + (m.by_default ? "\n" : " (if named)\n");
    return out;
}

}  // namespace

void add_transport(CLI::App& app) {
    auto o = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("transport", "Error against rays and CPU seconds of the integrators");
    command->footer(list_of_methods());
    command->add_option("scenes", o->scenes, ".glb or .gltf")->required()->check(CLI::ExistingFile);
    command->add_option("--methods", o->methods, "Some of the table below, separated by commas")->delimiter(',');
    command->add_option("--samples", o->samples, "Per texel, separated by commas")
        ->delimiter(',')
        ->check(CLI::Range(1u, 1u << 20));
    command->add_option("--resolution", o->resolution, "Page of the bench_* scenes, which keep their TEXCOORD_1: WxH")
        ->delimiter('x')
        ->expected(2)
        ->check(CLI::Range(16u, 4096u));
    command->add_option("--sky", o->sky_map, "Map over scenes without a light of their own: .hdr or .exr")
        ->check(CLI::ExistingFile);
    command->add_option("--texel-budget", o->texel_budget, "Texels of other scenes")->check(CLI::Range(100.0, 1e7));
    command->add_option("--texels", o->texels, "At most so many, from the middle of page 0; 0: all of it");
    command->add_option("--seed", o->seed, "Of the methods");
    command->add_option("--runs", o->runs, "Figures are means over so many runs, with one seed after the other")
        ->check(CLI::Range(1u, 1000u));
    command
        ->add_option("--stop", o->stop, "fixed, or flux: a texel stops by its own standard error, where a method can")
        ->check(CLI::IsMember({"fixed", "flux"}));
    command->add_option("--error", o->error, "Of --stop flux, relative")->check(CLI::Range(1e-6, 10.0));
    command->add_option("--confidence", o->confidence, "Of --stop flux")->check(CLI::Range(0.5, 0.9999));
    command->add_option(
        "--reference", o->reference_folder,
        "Folder of the references; default $LUMEL_BENCH_REFERENCES or " + default_reference_folder().string());
    command->add_option("--reference-minutes", o->reference.minutes, "Of each half of a reference")
        ->check(CLI::Range(0.0, 10000.0));
    command->add_option("--reference-samples", o->reference.samples, "Of each half of a reference, no more")
        ->check(CLI::Range(1u, 1u << 30));
    command->add_option("--threads", o->threads, "0: one per hardware thread");
    command->add_option("--csv", o->csv, "Also write the figures here");
    command->add_option("--plot", o->plot, "PNG: relMSE of I over CPU seconds, a line per method, a panel per scene");
    command->callback([o] { run_transport(*o); });
}

}  // namespace lumel::bench
