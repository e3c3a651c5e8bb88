// The .glb chunks, required extensions, buffers and buffer views. glTF 2.0, sections 3.6.1 and 4.
#include "io/gltf_container.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

#include "base/try.h"
#include "io/data_uri.h"
#include "io/image_codecs.h"
#include "io/image_io.h"
#include "io/little_endian.h"
#include "io/page_files.h"

namespace lumel {
namespace {

constexpr std::uint64_t kMaxBufferFile = std::uint64_t{8} << 30;
constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

// What may stand in extensionsRequired: read, harmless to a diffuse bake, or with a fallback that is used instead.
constexpr std::array<std::string_view, 30> kKnownExtensions{"KHR_lights_punctual",
                                                            "KHR_texture_transform",
                                                            "KHR_materials_emissive_strength",
                                                            "KHR_mesh_quantization",
                                                            "EXT_mesh_gpu_instancing",
                                                            "EXT_meshopt_compression",
                                                            "KHR_materials_pbrSpecularGlossiness",
                                                            "KHR_materials_unlit",
                                                            "KHR_materials_specular",
                                                            "KHR_materials_ior",
                                                            "KHR_materials_clearcoat",
                                                            "KHR_materials_sheen",
                                                            "KHR_materials_transmission",
                                                            "KHR_materials_volume",
                                                            "KHR_materials_iridescence",
                                                            "KHR_materials_anisotropy",
                                                            "KHR_materials_dispersion",
                                                            "KHR_materials_diffuse_transmission",
                                                            "KHR_materials_variants",
                                                            "KHR_xmp_json_ld",
                                                            "KHR_xmp",
                                                            "KHR_animation_pointer",
                                                            "KHR_texture_basisu",
                                                            "EXT_texture_webp",
                                                            "EXT_texture_avif",
                                                            "MSFT_texture_dds",
                                                            "EXT_lights_image_based",
                                                            "MSFT_lod",
                                                            "MOZ_lightmap",
                                                            kLightmapExtension};

// What was meant can often be told from what it is.
Error not_a_scene(std::span<const std::byte> bytes, const std::string& where) {
    const ImageFormat format = image_format(bytes);
    if (format == ImageFormat::hdr || format == ImageFormat::exr)
        return unsupported(where, "is a picture, not a scene", "a sky map is given with --sky, after the scene");
    if (format != ImageFormat::unknown) return unsupported(where, "is a picture, not a scene", "give a glTF 2.0 scene");
    return unsupported(where, "is neither a .glb nor a .gltf", "give a glTF 2.0 scene");
}

struct Chunks {
    std::string_view json;
    std::span<const std::byte> binary;
    bool has_binary = false;
};

// Header of 12 bytes, then chunks of length, type and data; the first is the JSON, the second may be the buffer.
Result<Chunks> split_glb(std::span<const std::byte> bytes, const std::string& where) {
    if (bytes.size() < 20) return invalid(where, "ends within its header", "the file is truncated");
    if (const std::uint32_t version = read_u32(bytes, 4); version != 2)
        return unsupported(where, "is version " + std::to_string(version) + " of the .glb format",
                           "export it as glTF 2.0");
    const std::size_t length = read_u32(bytes, 8);
    if (length > bytes.size() || length < 20)
        return invalid(where,
                       "says it has " + std::to_string(length) + " bytes but has " + std::to_string(bytes.size()),
                       "the file is truncated or damaged");
    Chunks chunks;
    std::size_t at = 12;
    for (std::size_t i = 0; length - at >= 8; ++i) {
        const std::size_t size = read_u32(bytes, at);
        const std::uint32_t type = read_u32(bytes, at + 4);
        if (size > length - at - 8)
            return invalid(where, "chunk " + std::to_string(i) + " reaches beyond the end of the file");
        const std::span<const std::byte> data = bytes.subspan(at + 8, size);
        if (i == 0 && type != kJsonChunk) return invalid(where, "its first chunk is not JSON");
        if (i == 0) chunks.json = {reinterpret_cast<const char*>(data.data()), data.size()};
        if (i == 1 && type == kBinaryChunk) {
            chunks.binary = data;
            chunks.has_binary = true;
        }
        at += 8 + size;
    }
    return chunks;
}

Status check_asset(const Json& root, const std::string& where) {
    if (!root.is_object()) return invalid(where, "is JSON but not a glTF document");
    LUMEL_TRY(const Json* asset, optional_object(root, "asset", where));
    if (!asset) return invalid(where, "has no 'asset': it is no glTF 2.0 document");
    for (const char* key : {"version", "minVersion"}) {
        LUMEL_TRY(const std::string version, string_or(*asset, key, "2.0", where));
        if (!version.starts_with("2.")) return unsupported(where, "is glTF " + version, "export it as glTF 2.0");
    }
    return success();
}

std::string remedy_for(std::string_view names) {
    if (names.find("KHR_draco_mesh_compression") != std::string_view::npos)
        return "decompress it: gltf-transform copy in.glb out.glb";
    return "export the scene without them";
}

Status check_required_extensions(const Json& root, const std::string& where) {
    LUMEL_TRY(const Json* required, optional_array(root, "extensionsRequired", where));
    if (!required) return success();
    std::string unknown;
    for (const Json& entry : *required) {
        if (!entry.is_string()) return invalid(where, "'extensionsRequired' must hold strings");
        const auto& name = entry.get_ref<const std::string&>();
        if (!is_known_extension(name)) unknown += (unknown.empty() ? "" : ", ") + name;
    }
    if (unknown.empty()) return success();
    return unsupported(where, "requires extensions that Lumel does not read: " + unknown, remedy_for(unknown));
}

bool is_meshopt_fallback(const Json& buffer) {
    const Json* extension = find_extension(buffer, "EXT_meshopt_compression");
    const Json* fallback = extension ? find(*extension, "fallback") : nullptr;
    return fallback && fallback->is_boolean() && fallback->get<bool>();
}

// Everything after the JSON is parsed, in the order in which one part needs the other.
class DocumentReader {
public:
    DocumentReader(GltfDocument& document, const Chunks& chunks) : document_(document), chunks_(chunks) {}

    Status read() {
        LUMEL_TRY_STATUS(check_asset(document_.root, document_.where));
        LUMEL_TRY_STATUS(check_required_extensions(document_.root, document_.where));
        for (std::size_t i = 0; i < array_size(document_.root, "buffers"); ++i) LUMEL_TRY_STATUS(read_buffer(i));
        const std::size_t views = array_size(document_.root, "bufferViews");
        document_.decoded_views.resize(views);
        for (std::size_t i = 0; i < views; ++i) LUMEL_TRY_STATUS(read_view(i));
        return success();
    }

private:
    Status read_buffer(std::size_t index) {
        LUMEL_TRY(const Json* buffer, element(document_.root, "buffers", index, document_.where));
        const std::string where = document_.where + ": " + label("buffer", index, *buffer);
        LUMEL_TRY(const std::uint64_t length, required_count(*buffer, "byteLength", where));
        LUMEL_TRY(std::vector<std::byte> bytes, buffer_data(index, *buffer, where));
        if (bytes.size() < length && !(bytes.empty() && is_meshopt_fallback(*buffer)))
            return invalid(where,
                           "says it has " + std::to_string(length) + " bytes but has " + std::to_string(bytes.size()),
                           "the file is truncated or damaged");
        if (bytes.size() > length) bytes.resize(length);  // the padding of a .glb chunk
        document_.buffers.push_back(std::move(bytes));
        return success();
    }

    Result<std::vector<std::byte>> buffer_data(std::size_t index, const Json& buffer, const std::string& where) {
        if (!find(buffer, "uri")) {
            if (index == 0 && chunks_.has_binary)
                return std::vector<std::byte>(chunks_.binary.begin(), chunks_.binary.end());
            if (is_meshopt_fallback(buffer)) return std::vector<std::byte>{};
            return invalid(where, "has no data: neither a 'uri' nor the binary chunk of a .glb");
        }
        LUMEL_TRY(const std::string uri, string_or(buffer, "uri", {}, where));
        if (is_data_uri(uri)) return decode_data_uri(uri, where);
        LUMEL_TRY(const std::filesystem::path path, resolve_uri(uri, document_.base_directory(), where));
        auto bytes = read_file(path, kMaxBufferFile);
        if (!bytes.ok())
            return Error{bytes.error().code, "its file '" + uri + "' cannot be read: " + bytes.error().message, where,
                         "put the file beside the scene"};
        document_.file_bytes += bytes->size();
        return bytes;
    }

    Status read_view(std::size_t index) {
        LUMEL_TRY(const Json* view, element(document_.root, "bufferViews", index, document_.where));
        const std::string where = document_.where + ": " + label("bufferView", index, *view);
        LUMEL_TRY(const std::uint64_t stride, count_or(*view, "byteStride", 0, where));
        if (stride > 255) return invalid(where, "'byteStride' is " + std::to_string(stride) + "; glTF allows 4 to 252");
        if (const Json* meshopt = find_extension(*view, "EXT_meshopt_compression")) {
            LUMEL_TRY(MeshoptView decoded, decode_meshopt_view(document_, *meshopt, where));
            decoded_bytes_ += decoded.bytes.size();
            // Views may share their compressed bytes, so that a small file could ask for any amount.
            if (decoded_bytes_ > (std::uint64_t{16} << 20) + 256 * document_.file_bytes)
                return invalid(where, "its compressed views grow beyond what such a file can hold");
            document_.decoded_views[index] = std::move(decoded.bytes);
            document_.views.emplace_back(document_.decoded_views[index]);
            document_.view_strides.push_back(decoded.stride);
            return success();
        }
        LUMEL_TRY(const auto bytes, view_of_buffer(*view, where));
        document_.views.push_back(bytes);
        document_.view_strides.push_back(stride);
        return success();
    }

    Result<std::span<const std::byte>> view_of_buffer(const Json& view, const std::string& where) {
        LUMEL_TRY(const std::uint64_t buffer, required_count(view, "buffer", where));
        LUMEL_TRY(const std::uint64_t offset, count_or(view, "byteOffset", 0, where));
        LUMEL_TRY(const std::uint64_t length, required_count(view, "byteLength", where));
        if (buffer >= document_.buffers.size())
            return invalid(where, "refers to buffers[" + std::to_string(buffer) + "], which does not exist");
        const std::span<const std::byte> bytes = document_.buffers[buffer];
        if (offset > bytes.size() || length > bytes.size() - offset)
            return invalid(where,
                           std::to_string(length) + " bytes at " + std::to_string(offset) + " reach beyond buffer " +
                               std::to_string(buffer) + " (" + std::to_string(bytes.size()) + " bytes)",
                           "the file is truncated or damaged");
        return bytes.subspan(offset, length);
    }

    GltfDocument& document_;
    const Chunks& chunks_;
    std::uint64_t decoded_bytes_ = 0;
};

}  // namespace

bool is_known_extension(const std::string& name) {
    return std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) != kKnownExtensions.end();
}

void GltfDocumentDeleter::operator()(GltfDocument* document) const { delete document; }

Result<GltfDocumentPtr> read_document(std::vector<std::byte> bytes, const std::filesystem::path& path,
                                      const std::string& where) {
    if (bytes.empty()) return invalid(where, "is empty", "export the scene again");
    Chunks chunks{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {}, false};
    if (bytes.size() >= 4 && read_u32(bytes, 0) == kGlbMagic) {
        LUMEL_TRY(chunks, split_glb(bytes, where));
    }
    GltfDocumentPtr document(new GltfDocument);
    document->path = path;
    document->where = where;
    document->file_bytes = bytes.size();
    Result<Json> root = parse_json(chunks.json, where);
    if (!root.ok()) {
        const bool json_like = chunks.json.find('{') != std::string_view::npos;
        return json_like ? root.error() : not_a_scene(bytes, where);
    }
    document->root = std::move(root).value();
    LUMEL_TRY_STATUS(DocumentReader(*document, chunks).read());
    return document;
}

Result<std::vector<std::byte>> GltfDocument::image_bytes(std::uint64_t index) const {
    LUMEL_TRY(const Json* image, element(root, "images", index, where));
    const std::string image_where = where + ": " + label("image", index, *image);
    LUMEL_TRY(const std::optional<std::uint64_t> view, optional_count(*image, "bufferView", image_where));
    if (view) {
        if (*view >= views.size())
            return invalid(image_where, "refers to bufferViews[" + std::to_string(*view) + "], which does not exist");
        return std::vector<std::byte>(views[*view].begin(), views[*view].end());
    }
    LUMEL_TRY(const std::string uri, required_string(*image, "uri", image_where));
    if (is_data_uri(uri)) return decode_data_uri(uri, image_where);
    LUMEL_TRY(const std::filesystem::path file, resolve_uri(uri, base_directory(), image_where));
    auto bytes = read_file(file, kMaxBufferFile);
    if (!bytes.ok())
        return Error{bytes.error().code, "its file '" + uri + "' cannot be read: " + bytes.error().message, image_where,
                     "put the file beside the scene"};
    return bytes;
}

}  // namespace lumel
