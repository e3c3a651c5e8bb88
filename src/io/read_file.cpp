// A file into memory, with a ceiling.
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "io/image_io.h"

namespace lumel {

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
    const std::string where = path.string();
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
        return Error{ErrorCode::io, "there is no such file", where, "check the path"};
    if (error) return Error{ErrorCode::io, error.message(), where, "check the path and its permissions"};
    // Devices and pipes have no size to bound; directories no bytes.
    if (status.type() == std::filesystem::file_type::directory)
        return Error{ErrorCode::io, "is a folder", where, "give the name of a file in it"};
    if (status.type() != std::filesystem::file_type::regular)
        return Error{ErrorCode::io, "is not a regular file", where, "copy what it holds into one"};
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) return Error{ErrorCode::io, error.message(), where, "check the path and its permissions"};
    if (size > max_bytes)
        return Error{ErrorCode::unsupported,
                     "has " + std::to_string(size) + " bytes, more than the " + std::to_string(max_bytes) + " allowed",
                     where, "make it smaller"};
    std::ifstream in(path, std::ios::binary);
    if (!in)
        return Error{ErrorCode::io, std::string("cannot be opened: ") + std::strerror(errno), where,
                     "check its permissions"};
    std::vector<std::byte> bytes(size);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(in.gcount()) != size)
        return Error{ErrorCode::io, "ended early while it was read", where, "try again when nothing writes to it"};
    return bytes;
}

}  // namespace lumel
