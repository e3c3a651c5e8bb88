// lumel pack FILE.msk: where raw chart masks go in an atlas.
#include <algorithm>
#include <cstdio>
#include <ctime>

#include "base/cancelled.h"
#include "base/try.h"
#include "command.h"
#include "io/mask_file.h"
#include "io/mask_groups.h"
#include "pack/pack_groups.h"
#include "pack/pack_pages.h"

namespace lumel::cli {
namespace {

struct Options {
    std::string file, groups, orientations = "auto", progress = "auto";
    std::uint32_t width = 0, max_page = 0;
    unsigned threads = 0;
    bool json = false;
};

struct Figures {
    std::uint32_t height = 0;  // of the highest page
    std::uint64_t used = 0;
    double efficiency = 0.0, cpu_seconds = 0.0;
};

Orientations orientations_of(const std::string& text) {
    return text == "1" ? Orientations::one : text == "8" ? Orientations::eight : Orientations::automatic;
}

// A chart that no page can hold.
Status check_sizes(const std::vector<ChartMask>& masks, const Options& options) {
    for (std::size_t i = 0; i < masks.size(); ++i) {
        const ChartMask& m = masks[i];
        const std::uint32_t page = options.max_page != 0 ? options.max_page : FreeMap::kMaxWidth;
        const std::uint32_t width = options.width != 0 ? options.width : page;
        const bool too_high = options.max_page != 0 && m.height > options.max_page;
        if (m.width <= width && !too_high) continue;
        const std::string size = std::to_string(m.width) + "x" + std::to_string(m.height);
        return Error{ErrorCode::usage, "chart " + std::to_string(i) + " has " + size + " texels, more than a page",
                     options.file,
                     too_high || options.width == 0 ? "give a larger --max-page" : "give a larger --width"};
    }
    return success();
}

// Before the machine is out of it.
Status check_memory(const std::vector<ChartMask>& masks, const PackOptions& how, const Options& options) {
    constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30;
    const std::uint64_t bytes = page_bytes(masks, how);
    if (bytes <= kMostBytes) return success();
    return Error{ErrorCode::out_of_memory,
                 "a page for these charts would take about " + std::to_string(bytes >> 20) +
                     " MiB of memory, more than " + std::to_string(kMostBytes >> 20),
                 options.file, "give a larger --width, or a --max-page"};
}

Figures figures_of(const PagePacking& packing, double cpu_seconds) {
    Figures out;
    double area = 0.0;
    for (const PackedPage& page : packing.pages) {
        out.height = std::max(out.height, page.height);
        out.used += page.used;
        area += static_cast<double>(packing.width) * page.height;
    }
    out.efficiency = area > 0.0 ? static_cast<double>(out.used) / area : 0.0;
    out.cpu_seconds = cpu_seconds;
    return out;
}

std::string charts_json(const std::vector<PackedChart>& charts) {
    std::string out = " \"charts\": [";
    char line[160];
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const PackedChart& c = charts[i];
        std::snprintf(line, sizeof line, "%s\n  {\"page\": %u, \"x\": %u, \"y\": %u, \"orientation\": %u}",
                      i == 0 ? "" : ",", c.page, c.x, c.y, unsigned{c.orientation});
        out += line;
    }
    return out + "]}\n";
}

// Text of our own: a million charts are no tree of objects.
std::string to_json(const PagePacking& packing, const Figures& figures) {
    char line[160];
    std::snprintf(line, sizeof line,
                  "{\"width\": %u, \"height\": %u, \"used\": %llu, \"efficiency\": %.6f, \"cpu_seconds\": %.3f,\n",
                  packing.width, figures.height, static_cast<unsigned long long>(figures.used), figures.efficiency,
                  figures.cpu_seconds);
    std::string out = line;
    out += " \"pages\": [";
    for (std::size_t i = 0; i < packing.pages.size(); ++i) {
        std::snprintf(line, sizeof line, "%s{\"height\": %u, \"used\": %llu}", i == 0 ? "" : ", ",
                      packing.pages[i].height, static_cast<unsigned long long>(packing.pages[i].used));
        out += line;
    }
    return out + "],\n" + charts_json(packing.charts);
}

std::string to_json(const GroupPacking& packing, const Figures& figures) {
    char line[160];
    std::snprintf(line, sizeof line, "{\"used\": %llu, \"efficiency\": %.6f, \"cpu_seconds\": %.3f,\n \"pages\": [",
                  static_cast<unsigned long long>(figures.used), figures.efficiency, figures.cpu_seconds);
    std::string out = line;
    for (std::size_t g = 0; g < packing.groups.size(); ++g) {
        const GroupPage& page = packing.groups[g];
        std::snprintf(line, sizeof line, "%s{\"width\": %u, \"height\": %u, \"used\": %llu}", g == 0 ? "" : ", ",
                      page.width, page.height, static_cast<unsigned long long>(page.used));
        out += line;
    }
    return out + "],\n" + charts_json(packing.charts);
}

// Each group on a page of its own.
Result<std::string> run_groups(const std::vector<ChartMask>& masks, const Options& options) {
    if (options.width != 0)
        return Error{ErrorCode::usage, "--width does not go with --groups", {}, "pages of groups are about square"};
    LUMEL_TRY(const MaskGroups groups, read_mask_groups(options.groups, masks.size()));
    RunContext context(options.threads, options.progress);
    GroupOptions how;
    how.max_page = options.max_page;
    how.orientations = orientations_of(options.orientations);
    const std::clock_t start = std::clock();
    const GroupPacking packing = pack_groups(masks, groups.group_of, groups.groups, how, context.get());
    Figures figures;
    figures.cpu_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    context.finish();
    if (!packing.complete) return cancelled_error();
    if (!packing.too_large.empty())
        return Error{ErrorCode::usage,
                     "group " + std::to_string(packing.too_large.front()) + " does not fit a page of " +
                         std::to_string(options.max_page) + " texels",
                     options.groups, "give a larger --max-page"};
    double area = 0.0;
    std::size_t pages = 0;
    for (const GroupPage& page : packing.groups) {
        figures.used += page.used;
        area += static_cast<double>(page.area());
        pages += page.used > 0 ? 1 : 0;
    }
    figures.efficiency = area > 0.0 ? static_cast<double>(figures.used) / area : 0.0;
    if (options.json) return to_json(packing, figures);
    char text[200];
    std::snprintf(
        text, sizeof text, "%zu charts, %llu texels: %zu page(s) of %.0f texels on average, %.2f %% used, %.2f CPU s\n",
        masks.size(), static_cast<unsigned long long>(figures.used), pages,
        area / static_cast<double>(std::max<std::size_t>(1, pages)), 100.0 * figures.efficiency, figures.cpu_seconds);
    return std::string(text);
}

Result<std::string> run(const Options& options) {
    LUMEL_TRY(const std::vector<ChartMask> masks, read_masks(options.file));
    constexpr std::uint32_t kLeastWidth = 64;
    for (const std::uint32_t edge : {options.width, options.max_page})
        if (edge != 0 && edge < kLeastWidth)
            return Error{ErrorCode::usage, "--width and --max-page are 64 or more, or 0", {}, {}};
    if (options.max_page != 0 && options.width > options.max_page)
        return Error{ErrorCode::usage, "--width is larger than --max-page", {}, {}};
    LUMEL_TRY_STATUS(check_sizes(masks, options));
    if (!options.groups.empty()) return run_groups(masks, options);
    const PackOptions how{options.width, options.max_page, orientations_of(options.orientations)};
    LUMEL_TRY_STATUS(check_memory(masks, how, options));
    RunContext context(options.threads, options.progress);
    const std::clock_t start = std::clock();
    const PagePacking packing = pack_pages(masks, how, context.get());
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    context.finish();
    if (!packing.complete) return cancelled_error();
    const Figures figures = figures_of(packing, seconds);
    if (options.json) return to_json(packing, figures);
    char text[200];
    std::snprintf(text, sizeof text, "%zu charts, %llu texels: %zu page(s) of %u x %u, %.2f %% used, %.2f CPU s\n",
                  packing.charts.size(), static_cast<unsigned long long>(figures.used), packing.pages.size(),
                  packing.width, figures.height, 100.0 * figures.efficiency, figures.cpu_seconds);
    return std::string(text);
}

}  // namespace

Run add_pack(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("FILE", options->file, "Chart masks: .msk")->required();
    app.add_option("--width", options->width, "Of the pages, texels (0: about square)")
        ->check(CLI::Range(0u, FreeMap::kMaxWidth));
    app.add_option("--max-page", options->max_page, "Longest edge of a page (0: one page of any height)")
        ->check(CLI::Range(0u, FreeMap::kMaxWidth));
    app.add_option("--groups", options->groups, "JSON array with the group of each chart: a page for each group")
        ->check(not_empty());
    app.add_option("--orientations", options->orientations, "How charts may be turned: auto, 1 (not at all), 8")
        ->check(CLI::IsMember({"auto", "1", "8"}));
    app.add_option("--threads", options->threads, "0: one per core")->check(CLI::Range(0u, 1024u));
    app.add_flag("--json", options->json, "Placements and figures as JSON on standard output");
    declare_progress(app, options->progress);
    return [options] {
        const Result<std::string> text = run(*options);
        if (!text.ok()) return fail(text.error(), "pack");
        std::fputs(text->c_str(), stdout);
        return static_cast<int>(kDone);
    };
}

}  // namespace lumel::cli
