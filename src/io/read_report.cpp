#include "io/read_report.h"

#include "io/image_io.h"
#include "io/json_read.h"
#include "io/page_files.h"

namespace lumel {
namespace {

Result<Diagnostic> read_warning(const Json& json, const std::string& where) {
    Diagnostic out;
    LUMEL_TRY(out.code, required_string(json, "code", where));
    LUMEL_TRY(out.message, required_string(json, "message", where));
    LUMEL_TRY(out.count, required_count(json, "count", where));
    LUMEL_TRY(const Json* examples, optional_array(json, "examples", where));
    if (!examples) return out;
    for (const Json& example : *examples) {
        if (!example.is_string()) return invalid(where, "has an example that is no text");
        if (out.examples.size() < Diagnostics::kMaxExamples) out.examples.push_back(example.get<std::string>());
    }
    return out;
}

Result<BakeRemarks> read_all(const Json& report, const std::string& where) {
    BakeRemarks out;
    LUMEL_TRY(const Json* options, optional_object(report, "options", where));
    if (options) {
        LUMEL_TRY(out.seams_solved, bool_or(*options, "seams", false, where + ": options"));
    }
    LUMEL_TRY(const Json* warnings, optional_array(report, "warnings", where));
    if (!warnings) return out;
    for (const Json& json : *warnings) {
        LUMEL_TRY(Diagnostic warning, read_warning(json, where + ": warnings"));
        out.warnings.push_back(std::move(warning));
    }
    return out;
}

}  // namespace

Result<BakeRemarks> parse_remarks(std::string_view report, const std::string& where) {
    LUMEL_TRY(const Json json, parse_json(report, where));
    Result<BakeRemarks> remarks = read_all(json, where);
    if (remarks.ok()) return remarks;
    Error error = remarks.error();
    error.remedy = "the file is damaged: bake again";
    return error;
}

Result<BakeRemarks> read_remarks(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / kReportFile;
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return BakeRemarks{};
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(file, kMaxManifest));
    return parse_remarks({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string());
}

}  // namespace lumel
