// EXT_meshopt_compression. Based on: Kapoulkine, meshoptimizer (the codecs) and the extension's specification (which
// mode allows which stride and filter). The codecs are made for untrusted bytes but assert their preconditions, so
// those are checked here.
#include <meshoptimizer.h>

#include "base/try.h"
#include "io/gltf_container.h"

namespace lumel {
namespace {

enum class Mode { attributes, triangles, indices };
enum class Filter { none, octahedral, quaternion, exponential };

struct Description {
    std::span<const std::byte> data;
    std::uint64_t count = 0, stride = 0;
    Mode mode = Mode::attributes;
    Filter filter = Filter::none;
};

Result<Mode> parse_mode(const std::string& name, const std::string& where) {
    if (name == "ATTRIBUTES") return Mode::attributes;
    if (name == "TRIANGLES") return Mode::triangles;
    if (name == "INDICES") return Mode::indices;
    return invalid(where, "'mode' is '" + name + "', which EXT_meshopt_compression does not know");
}

Result<Filter> parse_filter(const std::string& name, const std::string& where) {
    if (name == "NONE") return Filter::none;
    if (name == "OCTAHEDRAL") return Filter::octahedral;
    if (name == "QUATERNION") return Filter::quaternion;
    if (name == "EXPONENTIAL") return Filter::exponential;
    return invalid(where, "'filter' is '" + name + "', which EXT_meshopt_compression does not know");
}

bool stride_allowed(const Description& d) {
    if (d.mode != Mode::attributes) return (d.stride == 2 || d.stride == 4) && d.filter == Filter::none;
    if (d.filter == Filter::octahedral) return d.stride == 4 || d.stride == 8;
    if (d.filter == Filter::quaternion) return d.stride == 8;
    return d.stride >= 4 && d.stride <= 252 && d.stride % 4 == 0;
}

Result<Description> describe(const GltfDocument& document, const Json& extension, const std::string& where) {
    Description d;
    LUMEL_TRY(const std::uint64_t buffer, required_count(extension, "buffer", where));
    LUMEL_TRY(const std::uint64_t offset, count_or(extension, "byteOffset", 0, where));
    LUMEL_TRY(const std::uint64_t length, required_count(extension, "byteLength", where));
    LUMEL_TRY(d.stride, required_count(extension, "byteStride", where));
    LUMEL_TRY(d.count, required_count(extension, "count", where));
    LUMEL_TRY(const std::string mode, required_string(extension, "mode", where));
    LUMEL_TRY(const std::string filter, string_or(extension, "filter", "NONE", where));
    LUMEL_TRY(d.mode, parse_mode(mode, where));
    LUMEL_TRY(d.filter, parse_filter(filter, where));
    if (buffer >= document.buffers.size())
        return invalid(where, "refers to buffers[" + std::to_string(buffer) + "], which does not exist");
    const std::span<const std::byte> bytes = document.buffers[buffer];
    if (offset > bytes.size() || length > bytes.size() - offset)
        return invalid(where, "its compressed data reach beyond buffer " + std::to_string(buffer));
    d.data = bytes.subspan(offset, length);
    return d;
}

Status check(const Description& d, const std::string& where) {
    if (!stride_allowed(d))
        return invalid(where, "'byteStride' " + std::to_string(d.stride) + " is not allowed for its mode and filter");
    if (d.mode == Mode::triangles && d.count % 3 != 0) return invalid(where, "'count' is not a multiple of three");
    // The codecs spend at least two bits on 16 bytes of attributes and a byte on a triangle of three indices.
    if (d.count > (1024 + 64 * std::uint64_t{d.data.size()}) / d.stride)
        return invalid(where, "asks for " + std::to_string(d.count) + " elements, which its " +
                                  std::to_string(d.data.size()) + " bytes cannot hold");
    return success();
}

int decode(const Description& d, std::vector<std::byte>& out) {
    const auto* data = reinterpret_cast<const unsigned char*>(d.data.data());
    switch (d.mode) {
        case Mode::attributes: return meshopt_decodeVertexBuffer(out.data(), d.count, d.stride, data, d.data.size());
        case Mode::triangles: return meshopt_decodeIndexBuffer(out.data(), d.count, d.stride, data, d.data.size());
        case Mode::indices: return meshopt_decodeIndexSequence(out.data(), d.count, d.stride, data, d.data.size());
    }
    return -1;
}

void apply(Filter filter, const Description& d, std::vector<std::byte>& out) {
    switch (filter) {
        case Filter::none: return;
        case Filter::octahedral: return meshopt_decodeFilterOct(out.data(), d.count, d.stride);
        case Filter::quaternion: return meshopt_decodeFilterQuat(out.data(), d.count, d.stride);
        case Filter::exponential: return meshopt_decodeFilterExp(out.data(), d.count, d.stride);
    }
}

}  // namespace

Result<MeshoptView> decode_meshopt_view(const GltfDocument& document, const Json& extension,
                                        const std::string& view_where) {
    const std::string where = view_where + ", EXT_meshopt_compression";
    LUMEL_TRY(const Description d, describe(document, extension, where));
    LUMEL_TRY_STATUS(check(d, where));
    MeshoptView view;
    view.bytes.resize(d.count * d.stride);
    if (const int code = decode(d, view.bytes); code != 0)
        return invalid(where, "its data cannot be decoded (code " + std::to_string(code) + ")", "the file is damaged");
    apply(d.filter, d, view.bytes);
    if (d.mode == Mode::attributes) view.stride = d.stride;
    return view;
}

}  // namespace lumel
