#include "io/baked.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/try.h"
#include "io/gltf_accessor.h"
#include "io/gltf_container.h"
#include "io/image_io.h"
#include "io/json_read.h"
#include "io/page_files.h"

namespace lumel {
namespace {

constexpr const char* kExtension = kLightmapExtension;
constexpr std::uint64_t kMaxLitSceneFile = std::uint64_t{4} << 30;
constexpr const char* kOtherScene = "give the scene that was baked, with the same sidecar";

Result<GltfDocumentPtr> read_lit_document(const std::filesystem::path& path) {
    LUMEL_TRY(std::vector<std::byte> bytes, read_file(path, kMaxLitSceneFile));
    LUMEL_TRY(GltfDocumentPtr document, read_document(std::move(bytes), path, path.string()));
    if (!find_extension(document->root, kExtension))
        return invalid(path.string(), "has no LUMEL_lightmap extension", "give the output folder of lumel bake");
    return document;
}

// Fills the triangles of one baked instance from the parts of its mesh.
class InstanceReader {
public:
    InstanceReader(const GltfDocument& document, const Json& node, std::string where,
                   std::span<BakedTriangle> triangles)
        : document_(document), node_(node), where_(std::move(where)), triangles_(triangles) {}

    Status read() {
        LUMEL_TRY(const std::uint64_t index, required_count(node_, "mesh", where_));
        LUMEL_TRY(const Json* mesh, element(document_.root, "meshes", index, where_));
        for (std::size_t p = 0; p < array_size(*mesh, "primitives"); ++p) {
            LUMEL_TRY(const Json* primitive, element(*mesh, "primitives", p, where_));
            LUMEL_TRY_STATUS(read_part(*primitive));
        }
        return success();
    }

private:
    Status read_part(const Json& primitive) {
        const Json* extension = find_extension(primitive, kExtension);
        if (!extension || !find(*extension, "page")) return success();  // not lightmapped
        LUMEL_TRY(const std::uint64_t page, required_count(*extension, "page", where_));
        LUMEL_TRY(const Json* attributes, optional_object(primitive, "attributes", where_));
        if (!attributes) return invalid(where_, "has a primitive without attributes");
        LUMEL_TRY(const AccessorView uvs, open(*attributes, "TEXCOORD_1"));
        LUMEL_TRY(const AccessorView indices, open_unsigned(primitive, "indices"));
        LUMEL_TRY(const std::vector<std::uint32_t> triangles, part_triangles(*extension, indices.count / 3));
        if (uvs.components != 2) return invalid(where_, "TEXCOORD_1 has not two components");
        for (std::size_t k = 0; k < triangles.size(); ++k) {
            BakedTriangle& out = triangles_[triangles[k]];
            out.page = static_cast<std::uint32_t>(std::min<std::uint64_t>(page, kNone));
            for (std::size_t c = 0; c < 3; ++c) {
                const std::uint32_t vertex = indices.index(3 * k + c);
                if (vertex >= uvs.count) return invalid(where_, "has an index beyond its vertices");
                out.uv[c] = {uvs.number(vertex, 0), uvs.number(vertex, 1)};
                if (!std::isfinite(out.uv[c].x) || !std::isfinite(out.uv[c].y))
                    return invalid(where_, "has a lightmap UV that is not finite");
            }
        }
        return success();
    }

    Result<AccessorView> open(const Json& object, const char* key) const {
        LUMEL_TRY(const std::uint64_t accessor, required_count(object, key, where_));
        return open_accessor(document_, accessor);
    }

    Result<AccessorView> open_unsigned(const Json& object, const char* key) const {
        LUMEL_TRY(AccessorView view, open(object, key));
        const bool whole = view.component == Component::uint8 || view.component == Component::uint16 ||
                           view.component == Component::uint32;
        if (!whole || view.components != 1) return invalid(where_, std::string(key) + " are not unsigned integers");
        return view;
    }

    // Which triangles of the mesh these are.
    Result<std::vector<std::uint32_t>> part_triangles(const Json& extension, std::uint64_t count) const {
        std::vector<std::uint32_t> out;
        if (find(extension, "triangles")) {
            LUMEL_TRY(const AccessorView view, open_unsigned(extension, "triangles"));
            for (std::uint64_t i = 0; i < view.count; ++i) out.push_back(view.index(i));
        } else {
            LUMEL_TRY(const std::uint64_t first, required_count(extension, "firstTriangle", where_));
            if (first > triangles_.size()) return other_scene();
            for (std::uint64_t i = 0; i < count; ++i) out.push_back(static_cast<std::uint32_t>(first + i));
        }
        if (out.size() != count) return invalid(where_, "its triangles and indices differ in number");
        for (const std::uint32_t triangle : out)
            if (triangle >= triangles_.size()) return other_scene();
        return out;
    }

    [[nodiscard]] Error other_scene() const {
        return invalid(where_, "has triangles that the scene does not have", kOtherScene);
    }

    const GltfDocument& document_;
    const Json& node_;
    std::string where_;
    std::span<BakedTriangle> triangles_;
};

Result<std::vector<BakedTriangle>> read_uvs(const GltfDocument& document, const Scene& scene,
                                            const WorldGeometry& geometry) {
    std::vector<BakedTriangle> out(geometry.triangle_count());
    LUMEL_TRY(const std::string hash,
              string_or(*find_extension(document.root, kExtension), "geometry", "", document.where));
    if (hash != hash_geometry(geometry))
        return invalid(document.where, "was baked from another scene than " + scene.source, kOtherScene);
    for (std::size_t n = 0; n < array_size(document.root, "nodes"); ++n) {
        const std::string where = document.where + ": node " + std::to_string(n);
        LUMEL_TRY(const Json* node, element(document.root, "nodes", n, document.where));
        const Json* extension = find_extension(*node, kExtension);
        if (!extension) continue;
        LUMEL_TRY(const std::uint64_t instance, required_count(*extension, "instance", where));
        if (instance >= scene.instances.size())
            return invalid(where,
                           "is instance " + std::to_string(instance) + " but the scene has " +
                               std::to_string(scene.instances.size()),
                           kOtherScene);
        const std::uint32_t first = geometry.first_triangle[instance], end = geometry.first_triangle[instance + 1];
        LUMEL_TRY_STATUS(InstanceReader(document, *node, where, std::span(out).subspan(first, end - first)).read());
    }
    return out;
}

struct PageEntry {
    std::string file;
    std::uint64_t width = 0, height = 0;
};

// What scene.glb says of its pages.
Result<std::vector<PageEntry>> read_page_entries(const GltfDocument& document) {
    std::vector<PageEntry> out;
    const Json& extension = *find_extension(document.root, kExtension);
    for (std::size_t p = 0; p < array_size(extension, "pages"); ++p) {
        LUMEL_TRY(const Json* page, element(extension, "pages", p, document.where));
        PageEntry entry;
        LUMEL_TRY(entry.file, required_string(*page, "lightmap", document.where));
        LUMEL_TRY(entry.width, required_count(*page, "width", document.where));
        LUMEL_TRY(entry.height, required_count(*page, "height", document.where));
        if (std::filesystem::path(entry.file).filename() != entry.file)
            return invalid(document.where, "names a lightmap outside its folder: " + entry.file);
        if (entry.width > kLargestPage || entry.height > kLargestPage)
            return invalid(document.where, "describes a page larger than any bake writes");
        out.push_back(std::move(entry));
    }
    return out;
}

}  // namespace

Result<std::vector<BakedTriangle>> read_baked_uvs(const std::filesystem::path& scene_glb, const Scene& scene,
                                                  const WorldGeometry& geometry) {
    LUMEL_TRY(const GltfDocumentPtr document, read_lit_document(scene_glb));
    return read_uvs(*document, scene, geometry);
}

Result<BakedLighting> read_baked(const std::filesystem::path& folder, const Scene& scene, const WorldGeometry& geometry,
                                 std::uint64_t max_bytes) {
    BakedLighting out;
    {
        LUMEL_TRY(const GltfDocumentPtr document, read_lit_document(folder / kSceneFile));
        LUMEL_TRY(out.triangles_, read_uvs(*document, scene, geometry));
        LUMEL_TRY(const std::vector<PageEntry> entries, read_page_entries(*document));
        for (const PageEntry& entry : entries)
            out.pages_.push_back({folder / entry.file,
                                  static_cast<std::uint32_t>(entry.width),
                                  static_cast<std::uint32_t>(entry.height),
                                  {}});
        for (const BakedTriangle& triangle : out.triangles_)
            if (triangle.page != kNone && triangle.page >= out.pages_.size())
                return invalid(document->where, "refers to a page that it does not describe");
    }
    out.cut_into_parts(max_bytes);
    LUMEL_TRY_STATUS(out.load(0));
    return out;
}

// As many pages each as fit, in order. The page that is being read takes its room twice.
void BakedLighting::cut_into_parts(std::uint64_t max_bytes) {
    first_page_ = {0};
    std::uint64_t sum = 0, largest = 0;
    for (std::uint32_t p = 0; p < pages_.size(); ++p) {
        const std::uint64_t bytes = loaded_page_bytes(std::uint64_t{pages_[p].width} * pages_[p].height);
        sum += bytes;
        largest = std::max(largest, bytes);
        if (max_bytes == 0 || sum + largest <= max_bytes || first_page_.back() == p) continue;
        first_page_.push_back(p);
        sum = largest = bytes;
    }
    first_page_.push_back(static_cast<std::uint32_t>(pages_.size()));
}

Status BakedLighting::load(std::uint32_t part) {
    if (part == loaded_) return success();
    for (Page& page : pages_) page.image = {};
    loaded_ = kNone;
    for (std::uint32_t p = first_page_[part]; p < first_page_[part + 1]; ++p) {
        Page& page = pages_[p];
        LUMEL_TRY(page.image, read_image(page.file));
        if (page.image.width != page.width || page.image.height != page.height || page.image.channels < 3)
            return invalid(page.file.string(), "is not the page that scene.glb describes",
                           "the folder holds files of different bakes");
    }
    loaded_ = part;
    return success();
}

std::string hash_geometry(const WorldGeometry& geometry) {
    Hasher hasher;
    hasher.array(std::span<const Vec3>(geometry.positions));
    hasher.array(std::span<const std::uint32_t>(geometry.first_triangle));
    for (const WorldTriangle& triangle : geometry.triangles)
        for (const std::uint32_t vertex : triangle.vertices) hasher.pod(vertex);
    return hasher.finish().hex();
}

Vec3 sample_bilinear(const Image& image, Vec2 uv) {
    const auto place = [](float coordinate, std::uint32_t size) {
        const float texel = coordinate * static_cast<float>(size) - 0.5f;
        return std::clamp(texel, 0.0f, static_cast<float>(size - 1));
    };
    const float x = place(uv.x, image.width), y = place(uv.y, image.height);
    const auto x0 = static_cast<std::uint32_t>(x), y0 = static_cast<std::uint32_t>(y);
    const std::uint32_t x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const auto texel = [&](std::uint32_t i, std::uint32_t j) {
        const float* v = image.at(i, j);
        return Vec3{v[0], v[1], v[2]};
    };
    return (texel(x0, y0) * (1.0f - fx) + texel(x1, y0) * fx) * (1.0f - fy) +
           (texel(x0, y1) * (1.0f - fx) + texel(x1, y1) * fx) * fy;
}

std::optional<Vec3> BakedLighting::irradiance(std::uint32_t triangle, float b1, float b2) const {
    const BakedTriangle& t = triangles_[triangle];
    if (t.page == kNone) return std::nullopt;
    if (pages_[t.page].image.data.empty()) return Vec3{};
    const Vec2 uv = t.uv[0] * (1.0f - b1 - b2) + t.uv[1] * b1 + t.uv[2] * b2;
    return from_file_unit(sample_bilinear(pages_[t.page].image, uv), unit_of(PageFile::lightmap));
}

}  // namespace lumel
