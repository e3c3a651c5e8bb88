#include "io/read_manifest.h"

#include "io/image_io.h"
#include "io/json_read.h"
#include "io/page_files.h"

namespace lumel {

Result<std::vector<std::byte>> read_manifest(const std::filesystem::path& folder) {
    constexpr const char* kMakeOne = "give the folder that `lumel bake SCENE -o DIR` wrote";
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(folder, ignored);
    if (status.type() == std::filesystem::file_type::not_found)
        return Error{ErrorCode::io, "there is no such folder", folder.string(), kMakeOne};
    if (std::filesystem::exists(status) && !std::filesystem::is_directory(status))
        return Error{ErrorCode::io, "is a file, not the folder of a bake", folder.string(), kMakeOne};
    const std::filesystem::path path = folder / kManifestFile;
    if (std::filesystem::status(path, ignored).type() == std::filesystem::file_type::not_found)
        return Error{ErrorCode::io, std::string("is no bake of lumel: it has no ") + kManifestFile, folder.string(),
                     kMakeOne};
    return read_file(path, kMaxManifest);
}

}  // namespace lumel
