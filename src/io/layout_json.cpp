#include "io/layout_json.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>

#include "chart/atlas_record.h"
#include "chart/chart_transform.h"
#include "io/image_io.h"
#include "io/json_write.h"
#include "io/node_class.h"

namespace lumel {
namespace {

// Columns, then translation: glTF's order of a matrix without its last row.
Json transform_json(const Affine& m) {
    Json out = Json::array();
    for (const Vec3 v : {m.columns[0], m.columns[1], m.columns[2], m.translation})
        for (std::size_t i = 0; i < 3; ++i) out.push_back(json_number(v[i]));
    return out;
}

std::string hex(std::uint64_t id) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(id));
    return text;
}

std::string text_of(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Json lookups_json(const MaskRule& masks) {
    return {{"filter", masks.filter == LookupFilter::bicubic ? "bicubic" : "bilinear"},
            {"mips", masks.mips},
            {"block", masks.block}};
}

Json instances_json(const Scene& scene, const ChartSet& charts, const Atlas& atlas) {
    Json out = Json::array();
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        out.push_back({{"name", instance.name},
                       {"class", class_name(charts.class_of(scene, i))},
                       {"mesh", instance.mesh},
                       {"transform", transform_json(instance.transform)},
                       {"charts", {atlas.first_placement[i], atlas.first_placement[i + 1]}}});
    }
    return out;
}

Json charts_json(const Scene& scene, const ChartSet& charts, const Atlas& atlas) {
    Json page = Json::array(), scale = Json::array(), offset = Json::array(), box = Json::array();
    for (const ChartPlacement& placement : atlas.placements) {
        const ChartBox& b = placement.box;
        page.push_back(placement.page == kNone ? Json(nullptr) : Json(placement.page));
        scale.push_back(json_array(placement.scale));
        offset.push_back(json_array(placement.offset));
        box.push_back(b.width == 0 ? Json(nullptr) : Json({b.x, b.y, b.width, b.height}));
    }
    Json id = Json::array(), transform = Json::array();
    for (const Vec4& t : chart_transforms(atlas))
        transform.push_back({json_number(t.x), json_number(t.y), json_number(t.z), json_number(t.w)});
    for (const ChartName& name : chart_names(scene, charts)) id.push_back(hex(name.id));
    return {{"id", std::move(id)},         {"page", std::move(page)},           {"scale", std::move(scale)},
            {"offset", std::move(offset)}, {"transform", std::move(transform)}, {"box", std::move(box)}};
}

Status write_json(const std::filesystem::path& path, const Json& json) {
    const std::string text = text_of(json, 1) + "\n";
    return write_file(path, std::as_bytes(std::span(text)));
}

Status write_with_long_arrays(const std::filesystem::path& path, const Json& json,
                              std::initializer_list<std::string_view> long_members) {
    std::string text = "{";
    for (const auto& [key, value] : json.items()) {
        const bool is_long = std::ranges::find(long_members, std::string_view(key)) != long_members.end();
        text += text.size() > 1 ? ",\n" : "\n";
        text += ' ' + Json(key).dump() + ": " + text_of(value, is_long ? -1 : 1);
    }
    text += "\n}\n";
    return write_file(path, std::as_bytes(std::span(text)));
}

}  // namespace lumel
