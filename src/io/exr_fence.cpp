// Based on: "OpenEXR File Layout" (openexr.com): magic, version, headers of attributes, offset table, blocks.
#include "io/exr_fence.h"

#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/try.h"
#include "io/little_endian.h"

namespace lumel {
namespace {

constexpr std::uint32_t kMultiPart = 0x1000;  // flag in the version field

// The library reads attributes of these types by their type, whatever size the file states; everywhere else it reads as
// many bytes as stated. Only where both agree does this walk see the attributes that the library sees.
constexpr struct {
    std::string_view type;
    std::size_t size;
} kFixedSizes[] = {{"box2f", 16},
                   {"box2i", 16},
                   {"chromaticities", 32},
                   {"compression", 1},
                   {"deepImageState", 1},
                   {"double", 8},
                   {"envmap", 1},
                   {"float", 4},
                   {"int", 4},
                   {"keycode", 28},
                   {"m33d", 72},
                   {"m33f", 36},
                   {"m44d", 128},
                   {"m44f", 64},
                   {"lineOrder", 1},
                   {"v2d", 16},
                   {"rational", 8},
                   {"tiledesc", 9},
                   {"timecode", 8},
                   {"v2f", 8},
                   {"v2i", 8},
                   {"v3d", 24},
                   {"v3f", 12},
                   {"v3i", 12}};

// Bytes up to and with the next zero; 0 where there is none.
std::size_t text_length(std::span<const std::byte> data, std::size_t at) {
    const void* end = at >= data.size() ? nullptr : std::memchr(data.data() + at, 0, data.size() - at);
    return end ? static_cast<std::size_t>(static_cast<const std::byte*>(end) - data.data()) + 1 - at : 0;
}

// Channels are a name and 16 bytes each; an empty name ends the list.
bool channel_list_fits(std::span<const std::byte> data) {
    std::size_t at = 0;
    for (;;) {
        const std::size_t name = text_length(data, at);
        if (name <= 1) return name == 1 && at + 1 == data.size();
        at += name + 16;
    }
}

// Each string is its length and that many bytes.
bool strings_fit(std::span<const std::byte> data) {
    std::size_t at = 0;
    while (data.size() - at >= 4) {
        const std::size_t length = read_u32(data, at);
        if (length > data.size() - at - 4) return false;
        at += 4 + length;
    }
    return at == data.size();
}

bool preview_fits(std::span<const std::byte> data) {
    return data.size() >= 8 && std::uint64_t{read_u32(data, 0)} * read_u32(data, 4) * 4 == data.size() - 8;
}

bool size_agrees(std::string_view type, std::span<const std::byte> data) {
    for (const auto& entry : kFixedSizes)
        if (entry.type == type) return data.size() == entry.size;
    if (type == "chlist") return channel_list_fits(data);
    if (type == "stringvector") return strings_fit(data);
    if (type == "preview") return preview_fits(data);
    if (type == "floatvector") return data.size() % 4 == 0;
    return type != "idmanifest";  // unpacks to any size; of no use here
}

class HeaderWalk {
public:
    HeaderWalk(std::span<const std::byte> bytes, const std::string& where) : bytes_(bytes), where_(where) {}

    // A header is attributes up to an empty name; in a file of several parts an empty header ends the list.
    Status check() {
        if (bytes_.size() < 8) return damaged();
        const bool many = (read_u32(bytes_, 4) & kMultiPart) != 0;
        at_ = 8;
        do {
            if (!at_end() && bytes_[at_] == std::byte{0}) return success();
            LUMEL_TRY_STATUS(check_header());
        } while (many);
        return success();
    }

private:
    [[nodiscard]] bool at_end() const { return at_ >= bytes_.size(); }

    Status check_header() {
        while (!at_end() && bytes_[at_] != std::byte{0})
            if (!skip_attribute()) return damaged();
        if (at_end()) return damaged();
        ++at_;
        return success();
    }

    // Name, type, size, data.
    bool skip_attribute() {
        at_ += text_length(bytes_, at_);
        const std::size_t type_length = text_length(bytes_, at_);
        if (type_length == 0 || bytes_.size() - at_ - type_length < 4) return false;
        const std::string_view type(reinterpret_cast<const char*>(bytes_.data()) + at_, type_length - 1);
        at_ += type_length;
        const std::size_t size = read_u32(bytes_, at_);
        at_ += 4;
        if (size > bytes_.size() - at_ || !size_agrees(type, bytes_.subspan(at_, size))) return false;
        at_ += size;
        return true;
    }

    Error damaged() const {
        return {ErrorCode::invalid_input, "an attribute of its header has an impossible size", where_,
                "the file is damaged"};
    }

    std::span<const std::byte> bytes_;
    const std::string& where_;
    std::size_t at_ = 0;
};

}  // namespace

Status check_exr_headers(std::span<const std::byte> exr, const std::string& where) {
    return HeaderWalk(exr, where).check();
}

}  // namespace lumel
