// Packing of chart masks: texels used and CPU seconds, the published packer and packing by mesh beside it, every
// placement drawn by an independent checker.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench.h"
#include "io/mask_file.h"
#include "level_masks.h"
#include "pack/pack_groups.h"
#include "pack/pack_pages.h"
#include "pack/sweep.h"

namespace lumel::bench {
namespace {

struct Options {
    std::vector<std::string> files;
    std::uint32_t width = 0, made_charts = 263'000;
    std::uint64_t seed = 1;
    unsigned threads = 1;
    int repeats = 1;
    bool published = true, by_mesh = false, histogram = false, groups = false;
    std::string orientations = "auto";
};

// ---- The checker ----------------------------------------------------------------------------------------------------

struct Check {
    std::uint64_t drawn = 0, overlaps = 0, outside = 0;
    std::uint32_t height = 0;
};

// Draws every texel of one page into bytes. Its arithmetic of orientations is its own.
Check draw(const std::vector<ChartMask>& masks, const std::vector<PackedChart>& charts, std::uint32_t width) {
    Check out;
    std::vector<std::uint8_t> page;
    for (std::size_t i = 0; i < masks.size(); ++i) {
        const ChartMask& m = masks[i];
        const PackedChart& c = charts[i];
        const bool swapped = (c.orientation & 4) != 0;
        const std::uint32_t w = swapped ? m.height : m.width, h = swapped ? m.width : m.height;
        for (std::uint32_t v = 0; v < m.height; ++v)
            for (std::uint32_t u = 0; u < m.width; ++u) {
                if (!m.get(u, v)) continue;
                std::uint32_t a = swapped ? v : u, b = swapped ? u : v;
                if ((c.orientation & 1) != 0) a = w - 1 - a;
                if ((c.orientation & 2) != 0) b = h - 1 - b;
                const std::uint32_t x = c.x + a, y = c.y + b;
                ++out.drawn;
                if (x >= width) {
                    ++out.outside;
                    continue;
                }
                const std::size_t texel = std::size_t{y} * width + x;
                if (texel >= page.size()) page.resize(std::size_t{y + 1} * width * 5 / 4, 0);
                out.overlaps += page[texel];
                page[texel] = 1;
                out.height = std::max(out.height, y + 1);
            }
    }
    return out;
}

// ---- The rows -------------------------------------------------------------------------------------------------------

std::uint64_t used_by(const std::vector<ChartMask>& masks) {
    std::uint64_t used = 0;
    for (const ChartMask& m : masks) used += m.used;
    return used;
}

// Throws where charts overlap or are missing: such a row must not pass for a result.
void print_row(const std::string& set, const char* method, const std::vector<ChartMask>& masks,
               const std::vector<PackedChart>& charts, std::uint32_t width, double seconds) {
    const Check check = draw(masks, charts, width);
    const double area = static_cast<double>(width) * check.height;
    std::printf("%s,%s,%zu,%llu,%u,%u,%.3f,%.3f,%llu,%llu\n", set.c_str(), method, masks.size(),
                static_cast<unsigned long long>(check.drawn), width, check.height,
                100.0 * static_cast<double>(check.drawn) / area, seconds,
                static_cast<unsigned long long>(check.overlaps),
                static_cast<unsigned long long>(check.outside + used_by(masks) - check.drawn));
    std::fflush(stdout);
    if (check.overlaps != 0 || check.outside != 0 || check.drawn != used_by(masks))
        throw std::runtime_error(set + ": " + method + " has charts that overlap or are missing");
}

void run_lumel(const std::string& set, const std::vector<ChartMask>& masks, const Options& options,
               std::uint32_t width) {
    PackOptions how;
    how.width = width;
    how.orientations = options.orientations == "1"   ? Orientations::one
                       : options.orientations == "8" ? Orientations::eight
                                                     : Orientations::automatic;
    PagePacking packing;
    double seconds = 1e30;
    for (int i = 0; i < options.repeats; ++i) {
        Context context(options.threads);
        const CpuStopwatch time;
        packing = pack_pages(masks, how, context);
        seconds = std::min(seconds, time.seconds());
    }
    print_row(set, "lumel", masks, packing.charts, width, seconds);
}

std::vector<PackedChart> sweep(const std::vector<ChartMask>& masks, std::uint32_t width, Context& context) {
    std::vector<std::uint32_t> all(masks.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<PackedChart> out;
    for (const PageSpot& s : sweep_page(masks, all, width, context).spots) out.push_back({0, s.x, s.y, 0});
    return out;
}

void run_published(const std::string& set, const std::vector<ChartMask>& masks, std::uint32_t width) {
    Context context(1);
    const CpuStopwatch time;
    const std::vector<PackedChart> charts = sweep(masks, width, context);
    print_row(set, "published", masks, charts, width, time.seconds());
}

// What tools do that pack each mesh first and the meshes' rectangles then. Which charts are of one mesh the files do
// not say: 16 that follow each other are taken for one.
void run_by_mesh(const std::string& set, const std::vector<ChartMask>& masks, std::uint32_t width) {
    constexpr std::size_t kChartsPerMesh = 16;
    Context context(1);
    const CpuStopwatch time;
    std::vector<ChartMask> boxes;
    std::vector<PackedChart> charts;
    for (std::size_t first = 0; first < masks.size(); first += kChartsPerMesh) {
        const auto end = static_cast<std::ptrdiff_t>(std::min(first + kChartsPerMesh, masks.size()));
        const std::vector<ChartMask> mesh(masks.begin() + static_cast<std::ptrdiff_t>(first), masks.begin() + end);
        const std::uint32_t mesh_width = std::min(default_width(mesh), width);
        const std::vector<PackedChart> inside = sweep(mesh, mesh_width, context);
        std::uint32_t height = 0;
        for (std::size_t i = 0; i < mesh.size(); ++i) height = std::max(height, inside[i].y + mesh[i].height);
        ChartMask box(mesh_width, height);
        for (std::uint32_t y = 0; y < height; ++y) box.set_span(y, 0, mesh_width);
        box.used = box.count();
        boxes.push_back(std::move(box));
        charts.insert(charts.end(), inside.begin(), inside.end());
    }
    const std::vector<PackedChart> at = sweep(boxes, width, context);
    for (std::size_t i = 0; i < charts.size(); ++i) {
        charts[i].x += at[i / kChartsPerMesh].x;
        charts[i].y += at[i / kChartsPerMesh].y;
    }
    print_row(set, "by_mesh", masks, charts, width, time.seconds());
}

// Groups of about 106 x 106 texels that each get an atlas of their own (Martin and Einarsson 2010: a system of
// radiosity): charts in order, as many as fill 93 % of that. What is wider than half of it gets no place.
void run_groups(const std::string& set, const std::vector<ChartMask>& all, const Options& options) {
    constexpr std::uint32_t kSide = 106;
    constexpr double kAimedAt = 0.93;
    std::vector<ChartMask> masks;
    std::vector<std::uint32_t> group_of;
    std::uint32_t groups = 0;
    double used = kSide * kSide;
    for (const ChartMask& mask : all) {
        if (std::max(mask.width, mask.height) > kSide / 2) continue;
        if (used + static_cast<double>(mask.used) > kAimedAt * kSide * kSide) {
            ++groups;
            used = 0.0;
        }
        used += static_cast<double>(mask.used);
        masks.push_back(mask);
        group_of.push_back(groups - 1);
    }
    GroupOptions how;
    how.orientations = options.orientations == "1"   ? Orientations::one
                       : options.orientations == "8" ? Orientations::eight
                                                     : Orientations::automatic;
    Context context(options.threads);
    const CpuStopwatch time;
    const GroupPacking packing = pack_groups(masks, group_of, groups, how, context);
    const double seconds = time.seconds();
    std::vector<std::vector<ChartMask>> drawn(groups);
    std::vector<std::vector<PackedChart>> placed(groups);
    for (std::size_t i = 0; i < masks.size(); ++i) {
        drawn[group_of[i]].push_back(masks[i]);
        placed[group_of[i]].push_back(packing.charts[i]);
    }
    double area = 0.0, least = 1.0;
    std::uint64_t texels = 0, overlaps = 0, missing = 0;
    for (std::uint32_t g = 0; g < groups; ++g) {
        const GroupPage& page = packing.groups[g];
        const Check check = draw(drawn[g], placed[g], page.width);
        overlaps += check.overlaps;
        missing += check.outside + page.used - check.drawn + (check.height > page.height ? 1 : 0);
        texels += check.drawn;
        area += static_cast<double>(page.area());
        if (g + 1 < groups) least = std::min(least, static_cast<double>(page.used) / static_cast<double>(page.area()));
    }
    std::printf("set,groups,charts,used,mean_area,percent,least_percent,cpu_seconds,overlaps,missing\n");
    std::printf("%s,%u,%zu,%llu,%.0f,%.3f,%.3f,%.3f,%llu,%llu\n", set.c_str(), groups, masks.size(),
                static_cast<unsigned long long>(texels), area / groups, 100.0 * static_cast<double>(texels) / area,
                100.0 * least, seconds, static_cast<unsigned long long>(overlaps),
                static_cast<unsigned long long>(missing));
    if (overlaps + missing != 0) throw std::runtime_error(set + ": groups have charts that overlap or are missing");
}

// Charts and their texels by size, in powers of two.
void print_histogram(const std::string& set, const std::vector<ChartMask>& masks) {
    std::map<std::uint64_t, std::array<std::uint64_t, 2>> bins;
    for (const ChartMask& m : masks) {
        std::uint64_t bin = 4;
        while (bin < m.used) bin *= 2;
        ++bins[bin][0];
        bins[bin][1] += m.used;
    }
    std::printf("set,texels_up_to,charts,texels\n");
    for (const auto& [bin, count] : bins)
        std::printf("%s,%llu,%llu,%llu\n", set.c_str(), static_cast<unsigned long long>(bin),
                    static_cast<unsigned long long>(count[0]), static_cast<unsigned long long>(count[1]));
}

void run_set(const std::string& set, const std::vector<ChartMask>& masks, const Options& options) {
    const std::uint32_t width = options.width != 0 ? options.width : default_width(masks);
    for (const ChartMask& m : masks)
        if (m.width > width) throw std::runtime_error(set + " has charts wider than the page: give a larger --width");
    run_lumel(set, masks, options, width);
    if (options.published) run_published(set, masks, width);
    if (options.by_mesh) run_by_mesh(set, masks, width);
}

void run(const Options& options) {
    std::vector<std::pair<std::string, std::vector<ChartMask>>> sets;
    for (const std::string& file : options.files) {
        Result<std::vector<ChartMask>> masks = read_masks(file);
        if (!masks.ok()) throw std::runtime_error(masks.error().text());
        std::string name = file.substr(file.find_last_of('/') + 1);
        sets.emplace_back(name.substr(0, name.find('.')), std::move(*masks));
    }
    if (sets.empty()) {
        samples::LevelMasks level;
        level.texels *= static_cast<double>(options.made_charts) / level.charts;
        level.charts = options.made_charts;
        level.seed = options.seed;
        sets.emplace_back("made", samples::level_masks(level));
    }
    if (!options.groups) {
        std::printf("set,method,charts,used,width,height,percent,cpu_seconds,overlaps,missing\n");
        for (const auto& [name, masks] : sets) run_set(name, masks, options);
    }
    if (options.groups)
        for (const auto& [name, masks] : sets) run_groups(name, masks, options);
    if (options.histogram)
        for (const auto& [name, masks] : sets) print_histogram(name, masks);
}

}  // namespace

void add_pack(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("pack", "Texels used and time of packing chart masks");
    command->add_option("files", options->files, ".msk; none: charts made here")->check(CLI::ExistingFile);
    command->add_option("--width", options->width, "Of the page (0: about square)")
        ->check(CLI::Range(0u, FreeMap::kMaxWidth));
    command->add_option("--orientations", options->orientations, "auto, 1, 8")
        ->check(CLI::IsMember({"auto", "1", "8"}));
    command->add_option("--charts", options->made_charts, "Of the charts made here")->check(CLI::Range(1u, 4000000u));
    command->add_option("--seed", options->seed, "Of the charts made here");
    command->add_option("--threads", options->threads, "Of Lumel's packer")->check(CLI::Range(1u, 256u));
    command->add_option("--repeats", options->repeats, "The least time of so many is printed")
        ->check(CLI::Range(1, 100));
    command->add_flag("!--no-published", options->published, "Without the published packer");
    command->add_flag("--by-mesh", options->by_mesh, "Also 16 charts at a time, then their rectangles");
    command->add_flag("--groups", options->groups, "Instead: groups of some 106 x 106 texels, each with its own atlas");
    command->add_flag("--histogram", options->histogram, "Also how large the charts are");
    command->callback([options] { run(*options); });
}

}  // namespace lumel::bench
