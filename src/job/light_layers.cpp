#include "job/light_layers.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/try.h"
#include "io/image_io.h"
#include "io/page_files.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kColor{"R", "G", "B"}, kVector{"X", "Y", "Z"}, kNumber{"Y"};
constexpr const char* kLightUnit = "E/pi";
constexpr const char* kNoiseLayer = "noise";

std::vector<std::string> with_suffixes(const std::string& prefix, const std::vector<std::string>& suffixes) {
    std::vector<std::string> out;
    out.reserve(suffixes.size());
    for (const std::string& suffix : suffixes) out.push_back(prefix + suffix);
    return out;
}

std::string stem_of(PageFile kind) {
    const std::string stem = page_file_name(kind).stem;
    return stem.substr(0, stem.size() - 1);  // without the '_' before the number of the page
}

LightLayer of_file(PageFile kind, const std::string& name, const std::string& what, const std::string& unit,
                   ColorRule rule, const std::vector<std::string>& channels, const std::vector<std::string>& in_file) {
    return {{name, what, unit, rule, channels, {}, true}, stem_of(kind), page_file_name(kind).extension, in_file};
}

LightLayer of_master(const char* layer, const std::string& what) {
    return of_file(PageFile::master, layer, what, kLightUnit, ColorRule::light, kColor,
                   with_suffixes(std::string(layer) + ".I.", kColor));
}

// Standard error over light, as `lumel check` judges it: of luminances.
float relative_error(Vec3 variance, Vec3 light) {
    const Vec3 error{std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)};
    const float mean = luminance(light);
    const float absolute = luminance(error);
    return absolute == 0.0f ? 0.0f : absolute / mean;  // of no light, or of what is no number: painted red
}

// Channel groups of a file: "L1n.R" for L1n.R.X, L1n.R.Y, L1n.R.Z.
std::map<std::string, std::vector<std::string>> channel_groups(const std::vector<std::string>& names) {
    const auto has = [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
    std::map<std::string, std::vector<std::string>> out;
    for (const std::string& name : names) {
        bool grouped = false;
        for (const auto* suffixes : {&kColor, &kVector}) {
            const std::string& last = suffixes->back();
            const bool ends = name == last || name.ends_with("." + last);
            const std::string prefix = ends ? name.substr(0, name.size() - last.size()) : "";
            for (const std::string& suffix : *suffixes)
                grouped = grouped || (name == suffix) || name.ends_with("." + suffix);
            if (!ends) continue;
            const std::vector<std::string> members = with_suffixes(prefix, *suffixes);
            if (!std::ranges::all_of(members, has)) continue;
            out[prefix.empty() ? "RGB" : prefix.substr(0, prefix.size() - 1)] = members;
        }
        if (!grouped) out[name] = {name};
    }
    return out;
}

std::string page_file_of(const LightLayer& light, std::uint32_t page) {
    return light.stem + "_" + std::to_string(page) + light.extension;
}

Error other_page(const fs::path& file) {
    return {ErrorCode::invalid_input, "is not the page that the manifest describes", file.string(),
            "the folder holds files of different bakes: bake again"};
}

// The channels of the file, one after the other, each a number per pixel.
Result<std::vector<std::vector<float>>> read_planes(const LightLayer& light, const MasterFile& master,
                                                    std::uint32_t page) {
    const fs::path file = master.file.parent_path() / page_file_of(light, page);
    if (light.extension == ".png") {
        LUMEL_TRY(const Image image, read_image(file));
        if (image.width != master.width || image.height != master.height) return other_page(file);
        std::vector<std::vector<float>> planes(1);
        for (std::size_t i = 0; i < image.data.size(); i += image.channels) planes[0].push_back(image.data[i]);
        return planes;
    }
    LUMEL_TRY(NamedChannels channels, read_exr_channels(file, light.channels));
    if (channels.width != master.width || channels.height != master.height) return other_page(file);
    return std::move(channels.planes);
}

}  // namespace

std::span<const LightLayer> light_layers() {
    static const std::vector<LightLayer> kLayers{
        of_file(PageFile::lightmap, "light", "the lightmap, without albedo", kLightUnit, ColorRule::light, kColor,
                kColor),
        of_master("direct", "light of lamps and suns"),
        of_master("sky", "light of the sky"),
        of_master("indirect", "light after a bounce"),
        of_file(PageFile::master, kNoiseLayer, "standard error over light, before denoising", "1", ColorRule::heat,
                kNumber, with_suffixes("variance.", kColor)),
        of_file(PageFile::master, "samples", "paths", "", ColorRule::heat, kNumber, {"count"}),
        of_file(PageFile::ao, "ao", "share of directions that are free nearby", "1", ColorRule::share, kNumber, {"Y"}),
        of_file(PageFile::sky_visibility, "sky-visibility", "share of directions that reach the sky", "1",
                ColorRule::share, kNumber, {"Y"}),
        of_file(PageFile::bent_normal, "bent-normal", "mean free direction", "1", ColorRule::direction, kVector,
                kColor)};
    return kLayers;
}

std::vector<std::string> all_channels(const fs::path& folder) {
    std::vector<std::string> out;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        constexpr std::string_view kFirstPage = "_0.exr";
        if (!name.ends_with(kFirstPage)) continue;
        const Result<std::vector<std::string>> names = read_exr_channel_names(at->path());
        if (!names.ok()) continue;
        for (const auto& [group, members] : channel_groups(names.value()))
            out.push_back(name.substr(0, name.size() - kFirstPage.size()) + ":" + group);
    }
    std::ranges::sort(out);
    return out;
}

Result<LightLayer> find_channels(const fs::path& folder, const std::string& name) {
    const std::size_t colon = name.find(':');
    LightLayer out;
    out.stem = name.substr(0, colon);
    out.extension = ".exr";
    const std::string group = name.substr(std::min(name.size(), colon + 1));
    const std::string see_list = "--layer list shows what there is";
    if (out.stem.empty() || fs::path(out.stem).filename() != out.stem)
        return Error{ErrorCode::usage, "--layer: '" + name + "' names no file of the folder", {}, see_list};
    const fs::path file = folder / page_file_of(out, 0);
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        return Error{ErrorCode::usage, "--layer: '" + name + "' is of a file that is not there", file.string(),
                     see_list};
    LUMEL_TRY(const std::vector<std::string> names, read_exr_channel_names(file));
    const auto groups = channel_groups(names);
    const auto found = groups.find(group);
    if (found == groups.end())
        return Error{ErrorCode::usage, "--layer: has no channels '" + group + "'", file.string(), see_list};
    out.channels = found->second;
    const bool is_vector = out.channels.size() == 3 && out.channels[0].ends_with('X');
    const bool is_color = out.channels.size() == 3 && !is_vector;
    out.layer = {name,
                 "channels of " + page_file_of(out, 0) + " and so on",
                 "",
                 is_vector  ? ColorRule::direction
                 : is_color ? ColorRule::light
                            : ColorRule::heat,
                 is_vector  ? kVector
                 : is_color ? kColor
                            : kNumber,
                 {},
                 true};
    return out;
}

Result<std::vector<Coverage>> read_coverage(const MasterFile& master) {
    const std::vector<std::string> names{"coverage"};
    LUMEL_TRY(const NamedChannels channels, read_exr_channels(master.file, names));
    if (channels.width != master.width || channels.height != master.height) return other_page(master.file);
    std::vector<Coverage> out;
    out.reserve(channels.planes[0].size());
    for (const float v : channels.planes[0]) {
        if (!(v == 0.0f || v == 1.0f || v == 2.0f || v == 3.0f))
            return Error{ErrorCode::invalid_input, "coverage is none of 0 to 3", master.file.string(),
                         "the file is damaged: bake again"};
        out.push_back(static_cast<Coverage>(v));
    }
    return out;
}

Result<LayerPage> read_light_layer(const LightLayer& light, const MasterFile& master, std::uint32_t page,
                                   std::span<const Coverage> coverage) {
    LUMEL_TRY(const auto planes, read_planes(light, master, page));
    std::vector<std::vector<float>> mean;
    const bool is_noise = light.layer.name == kNoiseLayer;
    if (is_noise) {
        LUMEL_TRY(mean, read_planes(light_layers().front(), master, page));
    }
    LayerPage out(master.width, master.height, light.layer);
    const std::size_t channels = light.layer.channels.size();
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        if (coverage[i] == Coverage::none) continue;
        out.presence[i] = coverage[i] == Coverage::dilated ? Presence::dilated : Presence::covered;
        if (is_noise) {
            out.values.data[i] =
                relative_error({planes[0][i], planes[1][i], planes[2][i]}, {mean[0][i], mean[1][i], mean[2][i]});
            continue;
        }
        for (std::size_t c = 0; c < channels; ++c) out.values.data[i * channels + c] = planes[c][i];
    }
    return out;
}

void choose_rule(std::span<const LayerPage> pages, TexelLayer& layer) {
    if (layer.rule != ColorRule::light && layer.rule != ColorRule::heat) return;
    for (const LayerPage& page : pages)
        // A few may be what rounding left.
        if (20 * std::ranges::count_if(page.values.data, [](float v) { return v < 0.0f; }) >
            std::ssize(page.values.data)) {
            layer.rule = ColorRule::around_zero;
            return;
        }
}

}  // namespace lumel
