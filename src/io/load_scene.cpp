// The order of reading a scene: document, nodes, meshes, materials, lights, sidecar, classes; then the check.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/try.h"
#include "io/gltf_container.h"
#include "io/gltf_lights.h"
#include "io/gltf_materials.h"
#include "io/gltf_meshes.h"
#include "io/gltf_nodes.h"
#include "io/image_io.h"
#include "io/node_class.h"
#include "io/page_files.h"
#include "io/sidecar.h"
#include "scene/world_geometry.h"

namespace lumel {
namespace {

constexpr std::uint64_t kMaxSceneFile = std::uint64_t{8} << 30;
constexpr std::uint64_t kMaxSidecarFile = std::uint64_t{64} << 20;

struct Bounds {
    Vec3 low{}, high{};
    bool empty = true;

    void include(Vec3 p) {
        low = empty ? p : min(low, p);
        high = empty ? p : max(high, p);
        empty = false;
    }
    [[nodiscard]] double diagonal() const { return empty ? 0.0 : double{length(high - low)}; }
};

Bounds bounds_of(const Mesh& mesh) {
    Bounds bounds;
    for (const Vec3& p : mesh.positions) bounds.include(p);
    return bounds;
}

// The box of the transformed box: a little larger than the mesh, which makes fewer things small.
Bounds transformed(const Bounds& box, const Affine& m) {
    Bounds out;
    for (unsigned corner = 0; corner < 8; ++corner)
        out.include(transform_point(m, {corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                        corner & 4 ? box.high.z : box.low.z}));
    return out;
}

class SceneReader {
public:
    SceneReader(GltfDocument& document, const std::optional<Sidecar>& sidecar, Context& context)
        : document_(document), sidecar_(sidecar.value_or(Sidecar{})), context_(context) {}

    Result<Scene> read() {
        scene_.source = document_.where;
        LUMEL_TRY(nodes_, read_nodes(document_));
        LUMEL_TRY_STATUS(read_meshes());
        LUMEL_TRY_STATUS(read_materials(document_, used_materials(), scene_, context_.diagnostics));
        LUMEL_TRY_STATUS(read_all_lights());
        LUMEL_TRY(scene_.cameras, read_cameras(document_, nodes_, context_.diagnostics));
        LUMEL_TRY_STATUS(apply_sky(sidecar_, document_.base_directory(), scene_.sky));
        LUMEL_TRY_STATUS(place_instances());
        note_unknown_extensions();
        note_baked_light();
        LUMEL_TRY_STATUS(validate(scene_));
        return std::move(scene_);
    }

private:
    // Meshes that the scene uses, in the order of the file.
    Status read_meshes() {
        ExpansionBudget budget(document_.file_bytes);
        std::map<std::uint64_t, bool> used;
        for (const SceneNode& node : nodes_)
            if (node.mesh) used.emplace(*node.mesh, true);
        std::size_t done = 0;
        for (const auto& [index, unused] : used) {
            context_.report("load", 0.5 * static_cast<double>(done++) / static_cast<double>(used.size()));
            LUMEL_TRY(ReadMesh read, read_mesh(document_, index, budget, context_.diagnostics));
            if (!read.mesh) continue;
            mesh_index_.emplace(index, static_cast<std::uint32_t>(scene_.meshes.size()));
            scene_.meshes.push_back(std::move(read.mesh));
            document_.meshes.push_back(std::move(read.source));
        }
        scene_.display.meshes = scene_.meshes;
        return success();
    }

    [[nodiscard]] std::vector<bool> used_materials() const {
        std::vector<bool> used(array_size(document_.root, "materials"));
        for (const auto& mesh : scene_.meshes)
            for (const Primitive& primitive : mesh->primitives)
                if (primitive.material != kNone) used[primitive.material] = true;
        return used;
    }

    Status read_all_lights() {
        LUMEL_TRY(std::vector<ReadLight> lights, read_lights(document_, nodes_));
        LUMEL_TRY_STATUS(apply_lights(sidecar_, nodes_, lights));
        for (ReadLight& read : lights) {
            document_.light_nodes.push_back(read.node);
            scene_.lights.push_back(std::move(read.light));
        }
        return success();
    }

    Status place_instances() {
        LUMEL_TRY(const std::vector<NodeSettings> settings, node_settings(sidecar_, nodes_));
        std::vector<std::size_t> node_of;  // per instance, into nodes_
        for (std::size_t n = 0; n < nodes_.size(); ++n) add_instances_of(n, node_of);
        LUMEL_TRY_STATUS(check_size());
        const std::vector<Bounds> boxes = instance_bounds();
        Bounds all;
        for (const Bounds& box : boxes) {
            all.include(box.low);
            all.include(box.high);
        }
        for (std::size_t i = 0; i < scene_.instances.size(); ++i)
            set_class(i, nodes_[node_of[i]], settings[node_of[i]], boxes[i].diagonal(), all.diagonal());
        return success();
    }

    void add_instances_of(std::size_t n, std::vector<std::size_t>& node_of) {
        const SceneNode& node = nodes_[n];
        const auto mesh = node.mesh ? mesh_index_.find(*node.mesh) : mesh_index_.end();
        if (mesh == mesh_index_.end()) return;
        const bool instanced = !node.instances.empty();
        for (std::uint32_t k = 0; k < (instanced ? node.instances.size() : 1); ++k) {
            Instance instance;
            instance.name = instanced ? node.name + "#" + std::to_string(k) : node.name;
            instance.mesh = mesh->second;
            instance.path_hash = node.path_hash;
            instance.transform = (instanced ? node.world * node.instances[k] : node.world).rounded();
            scene_.instances.push_back(std::move(instance));
            DisplayInstance display;
            display.source = {node.index, static_cast<std::uint32_t>(*node.mesh), instanced ? k : kNone};
            display.mesh = mesh->second;
            scene_.display.instances.push_back(display);
            node_of.push_back(n);
        }
    }

    // Instances multiply triangles: a few bytes more in the file may ask for more than any machine holds.
    Status check_size() const {
        std::uint64_t triangles = 0;
        for (const Instance& instance : scene_.instances) triangles += scene_.meshes[instance.mesh]->triangles.size();
        const std::uint64_t most =
            std::min(std::uint64_t{1} << 28, (std::uint64_t{4} << 20) + 512 * document_.file_bytes);
        if (triangles <= most) return success();
        return unsupported(document_.where,
                           "its instances expand to " + std::to_string(triangles) + " triangles; at most " +
                               std::to_string(most) + " are read from a file of this size",
                           "split the scene");
    }

    [[nodiscard]] std::vector<Bounds> instance_bounds() const {
        std::vector<Bounds> of_mesh, out;
        for (const auto& mesh : scene_.meshes) of_mesh.push_back(bounds_of(*mesh));
        for (const Instance& instance : scene_.instances)
            out.push_back(transformed(of_mesh[instance.mesh], instance.transform));
        return out;
    }

    void set_class(std::size_t i, const SceneNode& node, const NodeSettings& settings, double diagonal,
                   double scene_diagonal) {
        Instance& instance = scene_.instances[i];
        const ClassOfNode result = classify(node, settings, diagonal, scene_diagonal);
        instance.node_class = result.node_class;
        instance.class_is_asked = result.is_asked;
        instance.density_scale = settings.texel_density.value_or(1.0f);
        if (result.node_class == NodeClass::lightmap)
            scene_.display.instances[i].baked_instance = static_cast<std::uint32_t>(i);
        else
            context_.diagnostics.add("node-class", "These nodes get no lightmap texels",
                                     instance.name + ": " + class_name(result.node_class) + " (" + result.reason + ")");
    }

    void note_unknown_extensions() {
        const Json* used = find(document_.root, "extensionsUsed");
        if (!used || !used->is_array()) return;
        for (const Json& name : *used)
            if (name.is_string() && !is_known_extension(name.get_ref<const std::string&>()))
                context_.diagnostics.add("ignored-extension", "These extensions were ignored",
                                         name.get_ref<const std::string&>());
    }

    void note_baked_light() {
        if (find_extension(document_.root, kLightmapExtension))
            context_.diagnostics.add("already-baked",
                                     "This is what a bake wrote: its surfaces emit the light that was baked, and would "
                                     "light each other with it again; give the scene that was baked",
                                     document_.where);
    }

    GltfDocument& document_;
    Sidecar sidecar_;
    Context& context_;
    Scene scene_;
    std::vector<SceneNode> nodes_;
    std::map<std::uint64_t, std::uint32_t> mesh_index_;  // glTF mesh -> Scene mesh
};

// Where a message has no better advice: what a document says wrongly is mended where it was written.
Error with_remedy(Error error) {
    if (!error.remedy.empty() || error.code == ErrorCode::cancelled) return error;
    const bool in_sidecar = error.where.find(".lumel.json") != std::string::npos;
    error.remedy = in_sidecar ? "mend the sidecar: docs/sidecar.md says what it may hold"
                              : "export the scene again; if it stays, the exporter writes bad glTF";
    return error;
}

Result<std::optional<Sidecar>> read_sidecar(const std::filesystem::path& scene) {
    const std::filesystem::path path = sidecar_path(scene);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return std::optional<Sidecar>{};
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(path, kMaxSidecarFile));
    Result<Sidecar> sidecar = parse_sidecar({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
    if (!sidecar.ok()) return with_remedy(sidecar.error());
    return std::optional<Sidecar>(std::move(sidecar).value());
}

Result<LoadedScene> load(std::vector<std::byte> bytes, const std::filesystem::path& path, const std::string& where,
                         const std::optional<Sidecar>& sidecar, Context& context) {
    Result<GltfDocumentPtr> document = read_document(std::move(bytes), path, where);
    if (!document.ok()) return with_remedy(document.error());
    Result<Scene> scene = SceneReader(**document, sidecar, context).read();
    if (!scene.ok()) return with_remedy(scene.error());
    context.report("load", 1.0);
    return LoadedScene{std::move(scene).value(), std::move(document).value()};
}

}  // namespace

Result<LoadedScene> load_scene(const std::filesystem::path& path, Context& context) {
    LUMEL_TRY(std::vector<std::byte> bytes, read_file(path, kMaxSceneFile));
    LUMEL_TRY(const std::optional<Sidecar> sidecar, read_sidecar(path));
    return load(std::move(bytes), path, path.string(), sidecar, context);
}

Result<LoadedScene> load_glb(std::span<const std::byte> bytes, const std::string& where, Context& context) {
    return load({bytes.begin(), bytes.end()}, {}, where, std::nullopt, context);
}

}  // namespace lumel
