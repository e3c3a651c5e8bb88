#include "io/encoded_output.h"

#include <span>
#include <utility>

#include "base/try.h"
#include "encode/units.h"
#include "io/image_io.h"
#include "io/light_json.h"
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

}  // namespace

Result<EncodedOutput> EncodedOutput::create(const fs::path& folder, const Encoding& encoding,
                                            const LightRecord& record) {
    LUMEL_TRY(FileSet files, FileSet::create(folder, encoded_stem(encoding.name)));
    return EncodedOutput(std::move(files), encoding, record);
}

Status EncodedOutput::page(const EncodedPage& page, Context& context) {
    const std::string name = encoded_page_file(encoding_->name, static_cast<std::uint32_t>(pages_.size()));
    const Result<std::string> type = write_encoded_page(partial() / name, *encoding_, page, context);
    if (!type.ok()) return files_.in_place(type.error());
    pages_.push_back({name, *type, page.width, page.height});
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
             {"channels", Json::array()},
             {"pages", Json::array()}};
    for (const Field& field : encoding_->fields)
        out["channels"].push_back({{"name", field.name}, {"kind", kind_name(field.kind)}});
    for (const Page& page : pages_)
        out["pages"].push_back(
            {{"file", page.file}, {"width", page.width}, {"height", page.height}, {"type", page.type}});
    return out.dump(2) + "\n";
}

Status EncodedOutput::commit(const MasterList& source) {
    const std::string name = encoded_stem(encoding_->name) + ".json", text = json();
    const Status written = write_file(partial() / name, std::as_bytes(std::span(text)));
    if (!written.ok()) return files_.in_place(written.error());
    std::vector<std::string> pages;
    for (const Page& page : pages_) pages.push_back(page.file);
    const auto is_page = [&](const std::string& file) { return is_encoded_page_file(encoding_->name, file); };
    return files_.commit(name, pages, is_page, [&] { return check_unchanged(source); });
}

}  // namespace lumel
