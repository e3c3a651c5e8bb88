#include "io/encoded_output.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/try.h"
#include "encode/units.h"
#include "io/image_io.h"
#include "io/json_write.h"
#include "io/light_json.h"
#include "io/output_folder.h"
#include "io/page_files.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

const char* kind_name(FieldKind kind) {
    switch (kind) {
        case FieldKind::light: return "light";
        case FieldKind::signed_light: return "signed light";
        case FieldKind::ratio: return "ratio";
        case FieldKind::unit: return "unit";
    }
    return "";
}

// What the textures are.
Json textures_json(const Encoding& encoding, const std::vector<StoredTexture>& layout) {
    Json out = Json::array();
    for (const StoredTexture& texture : layout) {
        const TexelFormatInfo& info = format_info(texture.format);
        Json channels = Json::array();
        for (const Field& field : encoding.fields.subspan(texture.first, texture.count)) channels.push_back(field.name);
        Json entry{{"name", texture.name}, {"channels", channels}, {"texels", info.name}};
        if (info.vk_format != 0) {
            entry["vk_format"] = info.vk_format;
            entry["dxgi_format"] = info.dxgi_format;
        }
        entry["bytes_per_texel"] = bytes_per_texel(info);
        out.push_back(std::move(entry));
    }
    return out;
}

Json places_json(const std::vector<TexturePages::Place>& places) {
    Json out = Json::array();
    for (const TexturePages::Place& place : places)
        out.push_back({{"file", place.file}, {"layer", place.layer}, {"scale", json_number(place.scale)}});
    return out;
}

}  // namespace

EncodedOutput::EncodedOutput(FileSet files, const Encoding& encoding, LightRecord record, const EncodedTarget& target)
    : files_(std::move(files)), encoding_(&encoding), record_(std::move(record)), target_(target) {
    if (target.storage) textures_.emplace(files_.partial(), encoding, target);
}

Result<EncodedOutput> EncodedOutput::create(const fs::path& folder, const Encoding& encoding, const LightRecord& record,
                                            const EncodedTarget& target) {
    const auto is_page = [&encoding](const std::string& file) { return is_encoded_page_file(encoding, file); };
    LUMEL_TRY(FileSet files,
              FileSet::create(folder, {"encoding", encoded_stem(encoding.name), "\"encoding\"", is_page}));
    return EncodedOutput(std::move(files), encoding, record, target);
}

Status EncodedOutput::write_exr_page(const EncodedPage& page, Context& context) {
    const std::string name = encoded_page_file(encoding_->name, static_cast<std::uint32_t>(pages_.size()));
    LUMEL_TRY(std::string type, write_encoded_page(partial() / name, *encoding_, page, context));
    pages_.push_back({page.width, page.height, std::move(type)});
    return success();
}

Status EncodedOutput::page(const EncodedPage& page, Context& context) {
    const Status status = textures_ ? textures_->add(page, context) : write_exr_page(page, context);
    if (!status.ok()) return files_.in_place(status.error());
    if (textures_) pages_.push_back({page.width, page.height, {}});
    return success();
}

std::string EncodedOutput::json() const {
    Json out{{"version", 1},
             {"encoding", encoding_->name},
             {"about", encoding_->about},
             {"units", unit_name(LightUnit::e_over_pi)},
             {"frame", encoding_->rotate ? "world" : "tangent"},
             {"input_hash", record_.input_hash},
             {"layers", layer_names(record_.include)},
             {"format", target_.format->name},
             {"channels", Json::array()},
             {"pages", Json::array()}};
    for (const Field& field : encoding_->fields)
        out["channels"].push_back({{"name", field.name}, {"kind", kind_name(field.kind)}});
    if (textures_) {
        out["storage"] = target_.storage->name;
        out["textures"] = textures_json(*encoding_, textures_->layout());
    }
    for (std::size_t p = 0; p < pages_.size(); ++p) {
        Json page = Json::object();
        if (!textures_) page["file"] = encoded_page_file(encoding_->name, static_cast<std::uint32_t>(p));
        page["width"] = pages_[p].width;
        page["height"] = pages_[p].height;
        if (textures_)
            page["textures"] = places_json(textures_->places(p));
        else
            page["type"] = pages_[p].type;
        out["pages"].push_back(std::move(page));
    }
    return out.dump(2) + "\n";
}

EncodedOutput::Files EncodedOutput::files() const {
    Files out{encoded_stem(encoding_->name) + ".json", {}};
    for (std::size_t p = 0; p < pages_.size(); ++p) {
        if (!textures_) {
            out.pages.push_back(encoded_page_file(encoding_->name, static_cast<std::uint32_t>(p)));
            continue;
        }
        for (const TexturePages::Place& place : textures_->places(p))
            if (std::ranges::find(out.pages, place.file) == out.pages.end()) out.pages.push_back(place.file);
    }
    return out;
}

Status EncodedOutput::commit(const MasterList& source) {
    const std::string name = files().description, text = json();
    const Status written = write_file(partial() / name, std::as_bytes(std::span(text)));
    if (!written.ok()) return files_.in_place(written.error());
    return files_.commit([&] { return check_unchanged(source); });
}

}  // namespace lumel
