#include "io/atlas_record_read.h"

#include <array>
#include <charconv>
#include <vector>

#include "base/try.h"
#include "io/image_io.h"
#include "io/json_read.h"
#include "io/page_files.h"

namespace lumel {
namespace {

constexpr const char* kGiveAManifest = "give the manifest.json of a bake, or the atlas.json of lumel atlas";
constexpr std::size_t kIdDigits = 16;

Result<std::vector<AtlasPage>> read_pages(const Json& root, const std::string& where) {
    std::vector<AtlasPage> out;
    for (std::size_t p = 0; p < array_size(root, "pages"); ++p) {
        const std::string here = where + ": page " + std::to_string(p);
        LUMEL_TRY(const Json* page, element(root, "pages", p, where));
        LUMEL_TRY(const std::uint64_t width, required_count(*page, "width", here));
        LUMEL_TRY(const std::uint64_t height, required_count(*page, "height", here));
        if (width == 0 || height == 0 || width > kLargestPage || height > kLargestPage)
            return invalid(here, "is of a size that no layout has", kGiveAManifest);
        out.push_back({static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)});
    }
    if (out.empty()) return invalid(where, "describes no pages", kGiveAManifest);
    return out;
}

// The arrays of `charts`, of one length.
struct ChartArrays {
    const Json *page = nullptr, *id = nullptr, *box = nullptr;
    std::size_t size = 0;
};

Result<ChartArrays> chart_arrays(const Json& root, const std::string& where) {
    LUMEL_TRY(const Json* charts, optional_object(root, "charts", where));
    if (!charts) return invalid(where, "describes no charts", kGiveAManifest);
    const std::string here = where + ": charts";
    ChartArrays out;
    LUMEL_TRY(out.page, optional_array(*charts, "page", here));
    LUMEL_TRY(out.id, optional_array(*charts, "id", here));
    LUMEL_TRY(out.box, optional_array(*charts, "box", here));
    if (!out.page) return invalid(here, "have no pages", kGiveAManifest);
    if (!out.id || !out.box)
        return invalid(where, "is of an older Lumel, which did not name its charts", "bake once more without --atlas");
    out.size = out.page->size();
    if (out.id->size() != out.size || out.box->size() != out.size)
        return invalid(here, "'page', 'id' and 'box' differ in length", kGiveAManifest);
    return out;
}

// Manifests of before lookups could be declared have none: the usual ones.
Result<MaskRule> read_lookups(const Json& root, const std::string& where) {
    LUMEL_TRY(const Json* lookups, optional_object(root, "lookups", where));
    MaskRule out;
    if (!lookups) return out;
    const std::string here = where + ": lookups";
    LUMEL_TRY(const std::string filter, string_or(*lookups, "filter", "bilinear", here));
    LUMEL_TRY(const std::uint64_t mips, count_or(*lookups, "mips", 0, here));
    LUMEL_TRY(const std::uint64_t block, count_or(*lookups, "block", 1, here));
    if ((filter != "bilinear" && filter != "bicubic") || mips > MaskRule::kMaxMips || (block != 1 && block != 4))
        return invalid(here, "are none that charts can be laid out for", kGiveAManifest);
    out.filter = filter == "bicubic" ? LookupFilter::bicubic : LookupFilter::bilinear;
    out.mips = static_cast<std::uint32_t>(mips);
    out.block = static_cast<std::uint32_t>(block);
    return out;
}

Result<std::uint64_t> parse_id(const Json& json, const std::string& where) {
    if (json.is_string()) {
        const std::string& text = json.get_ref<const std::string&>();
        std::uint64_t id = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id, 16);
        if (text.size() == kIdDigits && error == std::errc{} && end == text.data() + text.size()) return id;
    }
    return invalid(where, "has an id that is not 16 hexadecimal digits", kGiveAManifest);
}

Result<ChartBox> parse_box(const Json& json, const AtlasPage& page, const std::string& where) {
    std::array<std::uint32_t, 4> numbers{};
    bool good = json.is_array() && json.size() == numbers.size();
    for (std::size_t i = 0; good && i < numbers.size(); ++i) {
        good = json[i].is_number_unsigned() && json[i].get<std::uint64_t>() <= kLargestPage;
        if (good) numbers[i] = json[i].get<std::uint32_t>();
    }
    const ChartBox box{numbers[0], numbers[1], numbers[2], numbers[3]};
    good =
        good && box.width > 0 && box.height > 0 && box.x + box.width <= page.width && box.y + box.height <= page.height;
    if (!good) return invalid(where, "has a box that does not lie on its page", kGiveAManifest);
    return box;
}

// Of one instance: its charts from `first` on; returns the end.
Result<std::size_t> read_instance(const Json& instance, const ChartArrays& arrays, std::size_t first,
                                  const std::string& where, AtlasRecord& out) {
    std::array<double, 12> numbers{};
    const Json* transform = find(instance, "transform");
    if (!transform) return invalid(where, "has no transform", kGiveAManifest);
    LUMEL_TRY_STATUS(read_numbers(*transform, "transform", numbers.data(), numbers.size(), where));
    Affine affine;
    Vec3* const vectors[] = {&affine.columns[0], &affine.columns[1], &affine.columns[2], &affine.translation};
    for (std::size_t i = 0; i < numbers.size(); ++i) (*vectors[i / 3])[i % 3] = static_cast<float>(numbers[i]);
    const std::uint64_t place = hash_place(affine);

    const Json* range = find(instance, "charts");
    const bool is_range = range && range->is_array() && range->size() == 2 && (*range)[0].is_number_unsigned() &&
                          (*range)[1].is_number_unsigned() && (*range)[0].get<std::uint64_t>() == first &&
                          (*range)[1].get<std::uint64_t>() >= first && (*range)[1].get<std::uint64_t>() <= arrays.size;
    if (!is_range) return invalid(where, "does not have the charts that follow those before it", kGiveAManifest);
    const auto end = (*range)[1].get<std::size_t>();
    for (std::size_t c = first; c < end; ++c) {
        const std::string here = where + ", chart " + std::to_string(c);
        const Json &page = (*arrays.page)[c], &box = (*arrays.box)[c];
        if (page.is_null() || (box.is_null() && !out.scene_wide)) continue;
        if (!page.is_number_unsigned() || page.get<std::uint64_t>() >= out.pages.size())
            return invalid(here, "lies on a page that is not described", kGiveAManifest);
        AtlasRecord::Chart chart;
        chart.page = page.get<std::uint32_t>();
        if (!box.is_null()) {
            LUMEL_TRY(chart.box, parse_box(box, out.pages[chart.page], here));
        }
        LUMEL_TRY(chart.name.id, parse_id((*arrays.id)[c], here));
        chart.name.place = place;
        out.charts.push_back(chart);
    }
    return end;
}

}  // namespace

Result<AtlasRecord> parse_atlas_record(std::string_view text, const std::string& where) {
    LUMEL_TRY(const Json root, parse_json(text, where));
    AtlasRecord out;
    out.where = where;
    LUMEL_TRY(out.pages, read_pages(root, where));
    LUMEL_TRY(const ChartArrays arrays, chart_arrays(root, where));
    LUMEL_TRY(out.scene_wide, bool_or(root, "scene_wide_uvs", false, where));
    if (out.scene_wide && out.pages.size() != 1)
        return invalid(where, "is of one atlas of the scene, yet has " + std::to_string(out.pages.size()) + " pages",
                       kGiveAManifest);
    LUMEL_TRY(out.masks, read_lookups(root, where));
    LUMEL_TRY(out.density, number_or(root, "density", 0.0, where));
    if (!(out.density >= 0.0 && out.density <= 1e9) || (out.density == 0.0 && !out.scene_wide))
        return invalid(where, "has no density that a layout could have been drawn at", kGiveAManifest);
    std::size_t next = 0;
    for (std::size_t i = 0; i < array_size(root, "instances"); ++i) {
        LUMEL_TRY(const Json* instance, element(root, "instances", i, where));
        LUMEL_TRY(next, read_instance(*instance, arrays, next, where + ": instance " + std::to_string(i), out));
    }
    if (next != arrays.size) return invalid(where, "has charts that no instance has", kGiveAManifest);
    return out;
}

Result<std::shared_ptr<const AtlasRecord>> read_atlas_record(const std::filesystem::path& file) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(file, kMaxManifest));
    LUMEL_TRY(AtlasRecord record,
              parse_atlas_record({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string()));
    return std::make_shared<const AtlasRecord>(std::move(record));
}

}  // namespace lumel
