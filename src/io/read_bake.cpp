#include "io/read_bake.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/cancelled.h"
#include "base/try.h"
#include "chart/topology.h"
#include "encode/units.h"
#include "io/gltf_document_internal.h"
#include "io/image_io.h"
#include "io/json_read.h"
#include "io/lit_mesh_plan.h"
#include "io/master.h"
#include "io/page_files.h"

namespace lumel {
namespace {

constexpr const char* kOneBake = "the folder holds files of different bakes: bake again";

Result<CheckedPage> read_page(const MasterFile& master, std::uint32_t index) {
    CheckedPage page;
    page.width = master.width;
    page.height = master.height;
    const std::filesystem::path lightmap = master.file.parent_path() / page_file(PageFile::lightmap, index);
    LUMEL_TRY(page.light, read_image(lightmap));
    if (page.light.width != page.width || page.light.height != page.height || page.light.channels < 3)
        return invalid(lightmap.string(), "is not the page that the manifest describes", kOneBake);
    for (float& v : page.light.data) v = from_file_unit(v, unit_of(PageFile::lightmap));

    const std::array<std::string, 5> names{"coverage", "variance.R", "variance.G", "variance.B", "count"};
    LUMEL_TRY(const NamedChannels channels, read_exr_channels(master.file, names));
    if (channels.width != page.width || channels.height != page.height)
        return invalid(master.file.string(), "is not the page that the manifest describes", kOneBake);
    const std::size_t texels = std::size_t{page.width} * page.height;
    page.state.resize(texels);
    page.variance = Image(page.width, page.height, 3);
    const LightUnit unit = unit_of(PageFile::master);
    for (std::size_t i = 0; i < texels; ++i) {
        const float coverage = channels.planes[0][i];
        if (!(coverage == 0.0f || coverage == 1.0f || coverage == 2.0f || coverage == 3.0f))
            return invalid(master.file.string(), "coverage is none of 0 to 3", "the file is damaged: bake again");
        const bool is_hidden = coverage == 0.0f && channels.planes[4][i] > 0.0f;
        page.state[i] = is_hidden ? TexelState::hidden : static_cast<TexelState>(coverage);
        for (std::size_t c = 0; c < 3; ++c)
            page.variance.data[3 * i + c] = from_file_unit(from_file_unit(channels.planes[c + 1][i], unit), unit);
    }
    return page;
}

// The page that a primitive of scene.glb looks up; kNone: it is not lightmapped.
Result<std::uint32_t> page_of(const GltfDocument& document, std::uint32_t mesh, std::uint32_t primitive,
                              std::size_t pages) {
    const Json* extension = find_extension(gltf_primitive(document, mesh, primitive), kLightmapExtension);
    if (!extension || !find(*extension, "page")) return kNone;
    const std::string where = document.where + ": mesh '" + std::to_string(mesh) + "'";
    LUMEL_TRY(const std::uint64_t page, required_count(*extension, "page", where));
    if (page >= pages) return invalid(where, "looks up a page that the manifest does not describe", kOneBake);
    return static_cast<std::uint32_t>(page);
}

// As runtimes shade it: the vertex normal, or the face's where that points behind the face.
void set_normals(const Mesh& mesh, const Triangle& vertices, const Affine& transform, CheckedTriangle& out) {
    Vec3 face = cross(out.position[1] - out.position[0], out.position[2] - out.position[0]);
    if (determinant(transform) < 0.0f) face = -face;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 normal = transform_normal(transform, mesh.normals[vertices[k]]);
        out.normal[k] = normalize_or(dot(normal, face) < 0.0f ? face : normal, {0, 1, 0});
    }
}

bool has_area(const CheckedTriangle& t) {
    const Vec3 a = t.position[1] - t.position[0], b = t.position[2] - t.position[0], c = b - a;
    const double longest = static_cast<double>(std::max({dot(a, a), dot(b, b), dot(c, c)}));
    return static_cast<double>(length(cross(a, b))) > kZeroAreaRatio * longest;
}

Status add_instance(const LoadedScene& loaded, std::uint32_t index, CheckedBake& bake) {
    const Instance& instance = loaded.scene.instances[index];
    const Mesh& mesh = *loaded.scene.meshes[instance.mesh];
    for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p) {
        LUMEL_TRY(const std::uint32_t page, page_of(*loaded.document, instance.mesh, p, bake.pages.size()));
        if (page == kNone) continue;
        const Primitive& primitive = mesh.primitives[p];
        if (primitive.triangle_count > 0 && mesh.uv1.empty())
            return invalid(loaded.document->where, "'" + instance.name + "' is lightmapped but has no TEXCOORD_1",
                           "bake again");
        for (std::uint32_t t = 0; t < primitive.triangle_count; ++t) {
            const Triangle& vertices = mesh.triangles[primitive.first_triangle + t];
            CheckedTriangle out;
            out.page = page;
            out.instance = index;
            for (std::size_t k = 0; k < 3; ++k) {
                out.position[k] = transform_point(instance.transform, mesh.positions[vertices[k]]);
                out.uv[k] = mesh.uv1[vertices[k]];
                // No bake of ours looks up what lies beyond the rings around its charts.
                const auto is_beyond = [](float u) { return !(u >= -1.0f && u <= 2.0f); };
                if (is_beyond(out.uv[k].x) || is_beyond(out.uv[k].y))
                    return invalid(loaded.document->where,
                                   "'" + instance.name + "' has a lightmap UV that lies beyond its page", "bake again");
            }
            if (!has_area(out)) continue;  // no pixel shows it, and its lightmap UVs mean nothing
            set_normals(mesh, vertices, instance.transform, out);
            bake.triangles.push_back(out);
        }
    }
    return success();
}

}  // namespace

Result<BakeOnDisk> read_bake(const std::filesystem::path& folder, Context& context) {
    BakeOnDisk out;
    CheckedBake& bake = out.bake;
    LUMEL_TRY(const MasterList masters, list_masters(folder));
    for (std::uint32_t p = 0; p < masters.pages.size(); ++p) {
        if (context.cancelled()) return cancelled_error();
        LUMEL_TRY(CheckedPage page, read_page(masters.pages[p], p));
        bake.pages.push_back(std::move(page));
        context.report("load", static_cast<double>(p + 1) / static_cast<double>(masters.pages.size()));
    }
    Context quiet(1);  // that this scene was baked already, and what else its file is warned of, is known
    LUMEL_TRY(LoadedScene loaded, load_scene(folder / kSceneFile, quiet));
    if (!find_extension(loaded.document->root, kLightmapExtension))
        return invalid((folder / kSceneFile).string(), "has no LUMEL_lightmap extension",
                       "give the output folder of lumel bake");
    for (std::uint32_t i = 0; i < loaded.scene.instances.size(); ++i) {
        bake.instances.push_back(loaded.scene.instances[i].name);
        if (context.cancelled()) return cancelled_error();
        const std::size_t before = bake.triangles.size();
        LUMEL_TRY_STATUS(add_instance(loaded, i, bake));
        // A sidecar that the folder does not have may have said so.
        if (bake.triangles.size() > before) loaded.scene.instances[i].node_class = NodeClass::lightmap;
    }
    if (bake.triangles.empty())
        return invalid((folder / kSceneFile).string(), "has no lightmapped surface", "bake again");
    LUMEL_TRY_STATUS(check_unchanged(masters));
    out.scene = std::move(loaded.scene);
    return out;
}

}  // namespace lumel
