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
        out.push_back({{"file", place.file},
                       {"layer", place.layer},
                       {"level", place.level},
                       {"scale", json_number(place.scale)}});
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

Result<std::string> EncodedOutput::write_exr_page(const EncodedPage& page, std::uint32_t mip, Context& context) {
    const std::string name = encoded_page_file(encoding_->name, static_cast<std::uint32_t>(pages_.size()), mip);
    return write_encoded_page(partial() / name, *encoding_, page, context);
}

Status EncodedOutput::page(std::span<const EncodedPage> levels, Context& context) {
    if (textures_) {
        const Status status = textures_->add(levels, context);
        if (!status.ok()) return files_.in_place(status.error());
    }
    std::vector<Level> page;
    for (std::uint32_t mip = 0; mip < levels.size(); ++mip) {
        std::string type;
        if (!textures_) {
            Result<std::string> written = write_exr_page(levels[mip], mip, context);
            if (!written.ok()) return files_.in_place(written.error());
            type = std::move(*written);
        }
        page.push_back({levels[mip].width, levels[mip].height, std::move(type)});
    }
    pages_.push_back(std::move(page));
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
    const auto level_json = [&](std::uint32_t p, std::uint32_t mip) {
        Json level = Json::object();
        if (!textures_) level["file"] = encoded_page_file(encoding_->name, p, mip);
        level["width"] = pages_[p][mip].width;
        level["height"] = pages_[p][mip].height;
        if (textures_)
            level["textures"] = places_json(textures_->places(p, mip));
        else
            level["type"] = pages_[p][mip].type;
        return level;
    };
    for (std::uint32_t p = 0; p < pages_.size(); ++p) {
        Json page = level_json(p, 0);
        page["mips"] = Json::array();
        for (std::uint32_t mip = 1; mip < pages_[p].size(); ++mip) page["mips"].push_back(level_json(p, mip));
        out["pages"].push_back(std::move(page));
    }
    return out.dump(2) + "\n";
}

EncodedOutput::Files EncodedOutput::files() const {
    Files out{encoded_stem(encoding_->name) + ".json", {}};
    for (std::uint32_t p = 0; p < pages_.size(); ++p)
        for (std::uint32_t mip = 0; mip < pages_[p].size(); ++mip) {
            if (!textures_) {
                out.pages.push_back(encoded_page_file(encoding_->name, p, mip));
                continue;
            }
            for (const TexturePages::Place& place : textures_->places(p, mip))
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
