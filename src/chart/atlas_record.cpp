#include "chart/atlas_record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "base/hash.h"

namespace lumel {
namespace {

// -0 and 0 are one number.
Hasher& add(Hasher& hash, float value) { return hash.pod(value + 0.0f); }

// Of each chart of a mesh, whatever the order of its triangles.
std::vector<std::uint64_t> shape_hashes(const Mesh& mesh, const MeshCharts& charts) {
    std::vector<std::uint64_t> out;
    for (const Chart& chart : charts.charts) {
        std::uint64_t sum = chart.count;
        for (std::uint32_t k = chart.first; k < chart.first + chart.count; ++k) {
            const std::uint32_t t = charts.order[k];
            Hasher hash;
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3 p = mesh.positions[mesh.triangles[t][c]];
                const Vec2 uv = charts.uv[t][c];
                for (const float value : {p.x, p.y, p.z, uv.x, uv.y}) add(hash, value);
            }
            sum += hash.finish().low;
        }
        out.push_back(mix64(sum));
    }
    return out;
}

Error not_kept(const AtlasRecord& record, const std::string& what, std::string remedy) {
    return {ErrorCode::usage, "its layout cannot be kept: " + what, record.where, std::move(remedy)};
}

std::string size_text(std::uint32_t width, std::uint32_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

std::string density_text(double density) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", density);
    return text;
}

// As it would be asked for.
std::string rule_text(const MaskRule& rule) {
    return std::string("--filter ") + (rule.filter == LookupFilter::bicubic ? "bicubic" : "bilinear") + " --mips " +
           std::to_string(rule.mips) + " --block " + std::to_string(rule.block);
}

Status check_pages(const AtlasRecord& record, const ChartOptions& options) {
    const std::uint32_t cell = options.masks.cell();
    if (options.resolution_width != 0) {
        const AtlasPage page = record.pages.front();
        if (record.pages.size() == 1 && page.width == options.resolution_width &&
            page.height == options.resolution_height)
            return success();
        return not_kept(record,
                        "it has " + std::to_string(record.pages.size()) + " page(s), the first of " +
                            size_text(page.width, page.height) + " texels, and --resolution asks for one of " +
                            size_text(options.resolution_width, options.resolution_height),
                        "leave out --resolution, or --atlas");
    }
    for (std::size_t p = 0; p < record.pages.size(); ++p) {
        const AtlasPage page = record.pages[p];
        const std::string name = "its page " + std::to_string(p) + " has " + size_text(page.width, page.height);
        if (page.width > options.max_page || page.height > options.max_page)
            return not_kept(record, name + " texels, more than --max-page " + std::to_string(options.max_page),
                            "raise --max-page, or leave out --atlas");
        if (page.width % cell != 0 || page.height % cell != 0)
            return not_kept(record, name + " texels, no whole number of cells of " + std::to_string(cell),
                            "pack anew, without --atlas");
    }
    for (const AtlasRecord::Chart& chart : record.charts)
        if (chart.box.x % cell != 0 || chart.box.y % cell != 0)
            return not_kept(record, "its charts do not lie on whole cells of " + std::to_string(cell) + " texels",
                            "pack anew, without --atlas");
    return success();
}

}  // namespace

std::uint64_t hash_place(const Affine& transform) {
    Hasher hash;
    for (const Vec3& v : {transform.columns[0], transform.columns[1], transform.columns[2], transform.translation})
        for (std::size_t c = 0; c < 3; ++c) add(hash, v[c]);
    return hash.finish().low;
}

std::vector<ChartName> chart_names(const Scene& scene, const ChartSet& charts) {
    std::vector<std::vector<std::uint64_t>> shapes(scene.meshes.size());
    std::vector<ChartName> out;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (!charts.gets_texels(scene, i)) continue;
        std::vector<std::uint64_t>& shape = shapes[instance.mesh];
        if (shape.empty()) shape = shape_hashes(*scene.meshes[instance.mesh], charts.meshes[instance.mesh]);
        const std::uint64_t place = hash_place(instance.transform);
        for (const std::uint64_t hash : shape) out.push_back({mix64(hash ^ mix64(instance.path_hash)), place});
    }
    return out;
}

std::vector<std::uint32_t> find_in_record(const AtlasRecord& record, const std::vector<ChartName>& names) {
    std::vector<std::uint32_t> out(names.size(), kNone);
    std::vector<bool> given(record.charts.size());
    // Ids of charts in one place first, then wherever they are: 0 stands for anywhere.
    for (const bool anywhere : {false, true}) {
        const auto key = [&](const ChartName& name) { return std::pair(name.id, anywhere ? 0 : name.place); };
        std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<std::uint32_t>> left;  // the next one is the last
        for (std::uint32_t k = static_cast<std::uint32_t>(record.charts.size()); k-- > 0;)
            if (!given[k]) left[key(record.charts[k].name)].push_back(k);
        for (std::size_t n = 0; n < names.size(); ++n) {
            if (out[n] != kNone) continue;
            const auto at = left.find(key(names[n]));
            if (at == left.end() || at->second.empty()) continue;
            out[n] = at->second.back();
            given[out[n]] = true;
            at->second.pop_back();
        }
    }
    return out;
}

Status check_record(const AtlasRecord& record, const ChartSet& charts, const ChartOptions& options) {
    if (record.masks != options.masks)
        return not_kept(record,
                        "its charts are kept apart under " + rule_text(record.masks) + ", and " +
                            rule_text(options.masks) + " is asked for",
                        "leave out --filter, --mips and --block, or --atlas");
    if (record.scene_wide != charts.scene_wide)
        return not_kept(record,
                        charts.scene_wide ? "TEXCOORD_1 is one atlas of the scene now, and was not then"
                                          : "TEXCOORD_1 was one atlas of the scene then, and is not now",
                        charts.scene_wide ? "ask for --uv1 mesh or ignore, or leave out --atlas"
                                          : "leave out --atlas, or mend TEXCOORD_1");
    constexpr double kSame = 1e-6;  // of the density: as it is printed and typed again
    const double asked = options.texels_per_metre;
    if (asked > 0.0 && !(std::abs(asked - record.density) <= kSame * asked))
        return not_kept(record,
                        record.scene_wide
                            ? "a kept TEXCOORD_1 has no density to compare --texels-per-metre with"
                            : "it was drawn at " + density_text(record.density) +
                                  " texels per metre, and --texels-per-metre asks for " + density_text(asked),
                        "leave out --texels-per-metre, or --atlas");
    return check_pages(record, options);
}

}  // namespace lumel
