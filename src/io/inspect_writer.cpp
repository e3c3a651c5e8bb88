#include "io/inspect_writer.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/try.h"
#include "io/image_io.h"
#include "io/json_write.h"
#include "io/layout_json.h"
#include "io/page_files.h"
#include "io/relative_path.h"

namespace lumel {
namespace {

constexpr const char* kPageMark = "_page";
constexpr const char* kViewMark = "_view";

// <something>_page<finite_or_null> or <something>_view<finite_or_null>, of either kind.
bool is_inspected_file(const std::string& name) {
    for (const char* mark : {kPageMark, kViewMark}) {
        const std::size_t at = name.rfind(mark);
        if (at == std::string::npos || at == 0) continue;
        const std::string_view rest = std::string_view(name).substr(at);
        if (is_numbered(rest, mark, ".png") || is_numbered(rest, mark, ".exr")) return true;
    }
    return false;
}

std::string file_stem(const std::string& layer, InspectedPlace place) {
    std::string out = layer;
    for (char& c : out)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    return out + (place.is_view ? kViewMark : kPageMark) + std::to_string(place.index);
}

// JSON has no infinity.

}  // namespace

Result<InspectWriter> InspectWriter::create(const std::filesystem::path& folder) {
    LUMEL_TRY(FileSet files, FileSet::create(folder, {"inspect", "inspect", "\"Lumel\"", is_inspected_file}));
    return InspectWriter(std::move(files), folder);
}

Status InspectWriter::picture(InspectedLayer& layer, InspectedPlace place, const Image& rgb) {
    std::vector<std::uint8_t> bytes(rgb.data.size());
    std::ranges::transform(rgb.data, bytes.begin(), [](float v) {
        return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f);
    });
    layer.files.push_back(file_stem(layer.name, place) + ".png");
    const Status status = write_png(files_.partial() / layer.files.back(), rgb.width, rgb.height, 3, bytes);
    return status.ok() ? status : files_.in_place(status.error());
}

Status InspectWriter::values(InspectedLayer& layer, InspectedPlace place, const Image& numbers) {
    std::vector<ExrChannelSource> channels;
    for (const std::string& name : layer.channels) channels.push_back({name, ExrType::full});
    const auto row = [&](std::uint32_t y, std::span<float> out) {
        for (std::uint32_t x = 0; x < numbers.width; ++x)
            for (std::uint32_t c = 0; c < numbers.channels; ++c)
                out[std::size_t{c} * numbers.width + x] = numbers.at(x, y)[c];
        return true;
    };
    layer.files.push_back(file_stem(layer.name, place) + ".exr");
    const Status status =
        write_exr(files_.partial() / layer.files.back(), numbers.width, numbers.height, channels, row);
    return status.ok() ? status : files_.in_place(status.error());
}

Status InspectWriter::commit(const std::filesystem::path& bake, std::span<const InspectedLayer> layers) {
    Json list = Json::array();
    for (const InspectedLayer& layer : layers)
        list.push_back({{"name", layer.name},
                        {"what", layer.what},
                        {"unit", layer.unit},
                        {"channels", layer.channels},
                        {"low", finite_or_null(layer.low)},
                        {"high", finite_or_null(layer.high)},
                        {"exposure", finite_or_null(layer.exposure)},
                        {"files", layer.files}});
    const Json json{
        {"version", 1}, {"generator", "Lumel"}, {"bake", relative_to(folder_, bake)}, {"layers", std::move(list)}};
    const Status status = write_json(files_.partial() / kInspectFile, json);
    if (!status.ok()) return files_.in_place(status.error());
    return files_.commit();
}

}  // namespace lumel
