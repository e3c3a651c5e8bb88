#include "io/bake_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/try.h"
#include "io/atlas_record_read.h"
#include "io/image_io.h"
#include "io/json_read.h"
#include "io/page_files.h"
#include "io/read_manifest.h"
#include "io/relative_path.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBakeAgain = "give the output folder of lumel bake; bake again if an older one wrote it";

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<Vec2> read_pair(const Json& json, const char* key, const std::string& where) {
    std::array<double, 2> numbers{};
    LUMEL_TRY_STATUS(read_numbers(json, key, numbers.data(), numbers.size(), where));
    constexpr double kLargest = 1e9;  // texels per unit, or texels: no layout of ours has more
    for (const double number : numbers)
        if (!(std::abs(number) <= kLargest))
            return invalid(where, std::string("'") + key + "' is beyond any layout", kBakeAgain);
    return Vec2{static_cast<float>(numbers[0]), static_cast<float>(numbers[1])};
}

// `record` is of the same text, so that its pages, boxes and ranges are known to be sound.
Result<Atlas> read_layout(const Json& manifest, const AtlasRecord& record, const std::string& where) {
    Atlas out;
    out.pages = record.pages;
    out.masks = record.masks;
    out.density = record.density;
    LUMEL_TRY(const Json* charts, optional_object(manifest, "charts", where));
    const std::string here = where + ": charts";
    if (!charts) return invalid(where, "describes no charts", kBakeAgain);
    LUMEL_TRY(const Json* pages, optional_array(*charts, "page", here));
    LUMEL_TRY(const Json* scales, optional_array(*charts, "scale", here));
    LUMEL_TRY(const Json* offsets, optional_array(*charts, "offset", here));
    if (!pages || !scales || !offsets || scales->size() != pages->size() || offsets->size() != pages->size())
        return invalid(here, "'page', 'scale' and 'offset' are missing or differ in length", kBakeAgain);
    auto placed = record.charts.begin();
    for (std::size_t i = 0; i < pages->size(); ++i) {
        ChartPlacement placement;
        LUMEL_TRY(placement.scale, read_pair((*scales)[i], "scale", here));
        LUMEL_TRY(placement.offset, read_pair((*offsets)[i], "offset", here));
        if (!(*pages)[i].is_null()) {
            if (placed == record.charts.end()) return invalid(here, "lie on pages without a place there", kBakeAgain);
            placement.page = placed->page;
            placement.box = placed->box;
            ++placed;
        }
        out.placements.push_back(placement);
    }
    if (placed != record.charts.end()) return invalid(here, "have more places than pages", kBakeAgain);
    out.first_placement.push_back(0);
    for (std::size_t i = 0; i < array_size(manifest, "instances"); ++i)
        out.first_placement.push_back(manifest["instances"][i]["charts"][1].get<std::uint32_t>());
    return out;
}

Result<Uv1Choice> uv1_choice(const std::string& name, const std::string& where) {
    constexpr std::array<std::pair<const char*, Uv1Choice>, 4> kChoices{{{"automatic", Uv1Choice::automatic},
                                                                         {"scene", Uv1Choice::scene},
                                                                         {"mesh", Uv1Choice::mesh},
                                                                         {"ignore", Uv1Choice::ignore}}};
    for (const auto& [known, choice] : kChoices)
        if (name == known) return choice;
    return invalid(where, "'uv1' is no choice of lumel's: '" + name + "'", kBakeAgain);
}

// From report.json: what the manifest, which tells of results, leaves out.
Status read_options(const Json& report, const std::string& where, BakeOptions& out) {
    LUMEL_TRY(const Json* options, optional_object(report, "options", where));
    if (!options) return invalid(where, "does not say how the bake was asked for", kBakeAgain);
    const std::string here = where + ": options";
    LUMEL_TRY(const std::string uv1, required_string(*options, "uv1", here));
    LUMEL_TRY(out.uv1, uv1_choice(uv1, here));
    LUMEL_TRY(out.seed, required_count(*options, "seed", here));
    LUMEL_TRY(out.two_sided, bool_or(*options, "two_sided", false, here));
    LUMEL_TRY(const std::uint64_t samples, required_count(report, "samples_per_texel", where));
    constexpr std::uint64_t kMostSamples = 1u << 24;
    if (samples == 0 || samples > kMostSamples)
        return invalid(where, "'samples_per_texel' is no number of samples", kBakeAgain);
    out.samples = static_cast<std::uint32_t>(samples);
    return success();
}

}  // namespace

Result<BakeRecord> parse_bake_record(std::string_view text, const fs::path& folder, const std::string& where) {
    BakeRecord out;
    out.folder = folder;
    LUMEL_TRY(AtlasRecord record, parse_atlas_record(text, where));
    LUMEL_TRY(const Json manifest, parse_json(text, where));
    LUMEL_TRY(out.geometry_hash, required_string(manifest, "geometry_hash", where));
    LUMEL_TRY(out.input_hash, required_string(manifest, "input_hash", where));
    LUMEL_TRY(const std::string source, string_or(manifest, "source_path", "", where));
    if (!source.empty()) out.source = found_from_here(folder, source);
    LUMEL_TRY(out.layout, read_layout(manifest, record, where));
    for (const AtlasPage& page : record.pages)
        out.options.max_page = std::max({out.options.max_page, page.width, page.height});
    out.options.atlas = std::make_shared<const AtlasRecord>(std::move(record));
    return out;
}

Result<BakeRecord> read_bake_record(const fs::path& folder) {
    LUMEL_TRY(const std::vector<std::byte> manifest, read_manifest(folder));
    LUMEL_TRY(BakeRecord out, parse_bake_record(text_of(manifest), folder, (folder / kManifestFile).string()));
    const std::string where = (folder / kReportFile).string();
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(folder / kReportFile, kMaxManifest));
    LUMEL_TRY(const Json report, parse_json(text_of(bytes), where));
    LUMEL_TRY(const std::string reported, required_string(report, "input_hash", where));
    if (reported != out.input_hash) return invalid(where, "is of another bake than manifest.json", "bake again");
    LUMEL_TRY_STATUS(read_options(report, where, out.options));
    return out;
}

Status check_charts(const BakeRecord& record, const Scene& scene, const ChartSet& charts) {
    const std::vector<ChartName> names = chart_names(scene, charts);
    const Atlas& layout = record.layout;
    const std::vector<std::uint32_t>& first = layout.first_placement;
    bool same = first.size() == scene.instances.size() + 1 && names.size() == layout.placements.size();
    for (std::size_t i = 0; same && i < scene.instances.size(); ++i) {
        const std::size_t count = charts.meshes[scene.instances[i].mesh].charts.size();
        same = first[i + 1] - first[i] == (charts.gets_texels(scene, i) ? count : 0);
    }
    auto placed = record.options.atlas->charts.begin();
    for (std::size_t i = 0; same && i < names.size(); ++i)
        if (layout.placements[i].page != kNone) same = (placed++)->name.id == names[i].id;
    if (same) return success();
    return invalid((record.folder / kManifestFile).string(),
                   "its charts are not those that this lumel makes of the scene", "bake again with this version");
}

}  // namespace lumel
