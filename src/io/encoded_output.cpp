#include "io/encoded_output.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/try.h"
#include "encode/units.h"
#include "io/atomic_file.h"
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

Status move_file(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) return system_error("moving into place", to, error.value());
    return success();
}

}  // namespace

Result<EncodedOutput> EncodedOutput::create(const fs::path& folder, const Encoding& encoding,
                                            const LightRecord& record) {
    LUMEL_TRY(OutputFolder partial, OutputFolder::create(folder / encoded_stem(encoding.name)));
    return EncodedOutput(folder, std::move(partial), encoding, record);
}

Error EncodedOutput::in_place(Error error) const {
    const std::string unfinished = partial().string();
    if (error.where.starts_with(unfinished)) error.where.replace(0, unfinished.size(), folder_.string());
    return error;
}

Status EncodedOutput::page(const EncodedPage& page, Context& context) {
    const std::string name = encoded_page_file(encoding_->name, static_cast<std::uint32_t>(pages_.size()));
    const Result<std::string> type = write_encoded_page(partial() / name, *encoding_, page, context);
    if (!type.ok()) return in_place(type.error());
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

Status EncodedOutput::remove_older_pages() const {
    std::error_code error;
    std::vector<fs::path> older;
    for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (!is_encoded_page_file(encoding_->name, name)) continue;
        if (std::ranges::none_of(pages_, [&](const Page& page) { return page.file == name; }))
            older.push_back(at->path());
    }
    if (error) return system_error("listing the folder", folder_, error.value());
    for (const fs::path& file : older)
        if (fs::remove(file, error); error) return system_error("removing an older page", file, error.value());
    return success();
}

Status EncodedOutput::commit(const MasterList& source) {
    const std::string name = encoded_stem(encoding_->name) + ".json", text = json();
    const Status written = write_file(partial() / name, std::as_bytes(std::span(text)));
    if (!written.ok()) return in_place(written.error());
    LUMEL_TRY(const FolderLock lock, lock_folder(folder_));
    LUMEL_TRY_STATUS(check_unchanged(source));
    std::error_code error;
    fs::remove(folder_ / name, error);
    if (error) return system_error("replacing the file", folder_ / name, error.value());
    for (const Page& page : pages_) LUMEL_TRY_STATUS(move_file(partial() / page.file, folder_ / page.file));
    LUMEL_TRY_STATUS(remove_older_pages());
    return move_file(partial() / name, folder_ / name);
}

}  // namespace lumel
