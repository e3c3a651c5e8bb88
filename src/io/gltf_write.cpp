#include "io/gltf_write.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "base/check.h"
#include "base/try.h"
#include "chart/lift.h"
#include "encode/units.h"
#include "io/accessor_use.h"
#include "io/glb_builder.h"
#include "io/gltf_accessor.h"
#include "io/json_write.h"
#include "io/lit_materials.h"
#include "io/mesh_split.h"
#include "io/page_files.h"

namespace lumel {
namespace {

constexpr const char* kExtension = kLightmapExtension;
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kLights = "KHR_lights_punctual";

// A part and what of the file's own accessors it can keep using.
struct PartPlan {
    MeshPart part;
    bool keeps_vertices = false;  // the part's vertices are the accessors' elements, all and in order
    bool keeps_indices = false;
    std::uint32_t old_uv1 = 1;  // the set that the file's TEXCOORD_1 moves to; 1: it does not
};

// What all instances of a mesh share whose charts are spread over pages in the same way.
struct SharedGeometry {
    std::uint32_t mesh = kNone;  // Scene::meshes
    std::vector<PartPlan> parts;
    std::vector<Json> primitives;  // one per part: everything but TEXCOORD_1, material and page; filled when written
};

struct InstancePlan {
    std::uint32_t display = kNone;
    std::size_t geometry = 0;
    std::vector<std::uint32_t> pages;  // by the parts' group
};

// The page of every chart of a baked instance, and the same renumbered by rank among the pages it uses.
struct ChartPages {
    std::vector<std::uint32_t> group;  // per chart; kNone: not placed
    std::vector<std::uint32_t> pages;  // by group, ascending
};

ChartPages chart_pages(const Atlas& atlas, std::uint32_t instance) {
    ChartPages out;
    const std::uint32_t first = atlas.first_placement[instance], last = atlas.first_placement[instance + 1];
    for (std::uint32_t i = first; i < last; ++i) out.pages.push_back(atlas.placements[i].page);
    out.group = out.pages;
    std::sort(out.pages.begin(), out.pages.end());
    out.pages.erase(std::unique(out.pages.begin(), out.pages.end()), out.pages.end());
    if (!out.pages.empty() && out.pages.back() == kNone) out.pages.pop_back();
    for (std::uint32_t& group : out.group)
        if (group != kNone)
            group = static_cast<std::uint32_t>(std::lower_bound(out.pages.begin(), out.pages.end(), group) -
                                               out.pages.begin());
    return out;
}

// Mesh vertex -> element of its primitive's accessors.
std::vector<std::uint32_t> elements_of(const Mesh& mesh, const MeshSource& source) {
    std::vector<std::uint32_t> out(mesh.positions.size());
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
        for (std::uint32_t v = 0; v < mesh.primitives[p].vertex_count; ++v)
            out[mesh.primitives[p].first_vertex + v] = source.primitives[p].element(v);
    return out;
}

std::uint32_t index_at(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value && value->is_number_unsigned() ? value->get<std::uint32_t>() : kNone;
}

class Writer {
public:
    explicit Writer(const GltfWriteInput& input)
        : in_(input), document_(input.document), glb_(input.document.root), root_(glb_.root()) {}

    Status write(const std::filesystem::path& path) {
        LUMEL_CHECK(in_.textures.size() == in_.atlas.pages.size(), in_.textures.size(), in_.atlas.pages.size());
        LUMEL_TRY_STATUS(plan());
        LUMEL_TRY_STATUS(keep_used_data());
        LUMEL_TRY_STATUS(write_images());
        LitMaterials materials(root_, add_page_textures());
        for (SharedGeometry& geometry : geometries_) LUMEL_TRY_STATUS(write_geometry(geometry));
        write_instances(materials);
        remove_baked_lights();
        write_root_extension();
        return glb_.write(path);
    }

private:
    [[nodiscard]] const Json& gltf_mesh(std::uint32_t scene_mesh) const {
        return document_.root["meshes"][document_.meshes[scene_mesh].gltf_mesh];
    }
    [[nodiscard]] const Json& gltf_primitive(std::uint32_t scene_mesh, std::uint32_t primitive) const {
        return gltf_mesh(scene_mesh)["primitives"][document_.meshes[scene_mesh].primitives[primitive].gltf_primitive];
    }

    // ---- What goes where ------------------------------------------------------------------------------------------

    // Cuts the meshes, once for all instances that can share the result.
    Status plan() {
        std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, std::size_t> known;
        for (std::uint32_t d = 0; d < in_.scene.display.instances.size(); ++d) {
            const DisplayInstance& display = in_.scene.display.instances[d];
            if (display.baked_instance == kNone) continue;
            ChartPages pages = chart_pages(in_.atlas, display.baked_instance);
            if (pages.pages.empty()) continue;
            const auto [at, added] = known.try_emplace({display.mesh, pages.group}, geometries_.size());
            if (added) {
                LUMEL_TRY(SharedGeometry geometry, plan_geometry(display, pages.group));
                geometries_.push_back(std::move(geometry));
            }
            instances_.push_back({d, at->second, std::move(pages.pages)});
        }
        return success();
    }

    Result<SharedGeometry> plan_geometry(const DisplayInstance& display, const std::vector<std::uint32_t>& group) {
        const Mesh& mesh = *in_.scene.display.meshes[display.mesh];
        const std::uint32_t baked_mesh = in_.scene.instances[display.baked_instance].mesh;
        SharedGeometry out;
        out.mesh = display.mesh;
        for (MeshPart& part : split_mesh(mesh, in_.charts.meshes[baked_mesh], group,
                                         elements_of(mesh, document_.meshes[display.mesh]))) {
            PartPlan plan;
            plan.part = std::move(part);
            const Json& primitive = gltf_primitive(display.mesh, plan.part.primitive);
            LUMEL_TRY(plan.keeps_vertices, is_identity(primitive, plan.part.element));
            if (plan.keeps_vertices) {
                LUMEL_TRY(plan.keeps_indices, has_indices(primitive, plan.part.indices));
            }
            plan.old_uv1 = free_uv_set(primitive, baked_mesh);
            out.parts.push_back(std::move(plan));
        }
        return out;
    }

    Result<bool> is_identity(const Json& primitive, const std::vector<std::uint32_t>& elements) const {
        LUMEL_TRY(const AccessorView positions,
                  open_accessor(document_, index_at(primitive["attributes"], "POSITION")));
        if (positions.count != elements.size()) return false;
        for (std::uint32_t i = 0; i < elements.size(); ++i)
            if (elements[i] != i) return false;
        return true;
    }

    Result<bool> has_indices(const Json& primitive, const std::vector<std::uint32_t>& indices) const {
        const std::uint32_t accessor = index_at(primitive, "indices");
        const Json* mode = find(primitive, "mode");
        if (accessor == kNone || (mode && *mode != 4)) return false;
        LUMEL_TRY(const AccessorView view, open_accessor(document_, accessor));
        if (view.count != indices.size()) return false;
        for (std::size_t i = 0; i < indices.size(); ++i)
            if (view.index(i) != indices[i]) return false;
        return true;
    }

    // TEXCOORD_1 becomes the lightmap's. Where the material looks something up by the file's own, that moves to the
    // next free set; a layout that is kept as it was needs no second copy.
    [[nodiscard]] std::uint32_t free_uv_set(const Json& primitive, std::uint32_t baked_mesh) {
        const Json& attributes = primitive["attributes"];
        const bool kept = in_.charts.scene_wide && in_.charts.meshes[baked_mesh].from_uv1;
        const LitMaterials materials(root_, {});
        if (kept || !find(attributes, "TEXCOORD_1") || !materials.uses_uv1(index_at(primitive, "material"))) return 1;
        std::uint32_t set = 2;
        while (find(attributes, ("TEXCOORD_" + std::to_string(set)).c_str())) ++set;
        return set;
    }

    // ---- What stays of the file's data ----------------------------------------------------------------------------

    // Data that only replaced meshes used is dropped; the rest is written again under its number.
    Status keep_used_data() {
        const std::size_t accessors = array_size(root_, "accessors"), views = array_size(root_, "bufferViews");
        AccessorUse before(accessors), after(accessors);
        note_accessor_use(root_, before);
        find_replaced_meshes();
        note_accessor_use_without(root_, meshes_to_drop_, nodes_to_expand_, after);
        for (const SharedGeometry& geometry : geometries_) note_kept_accessors(geometry, after);
        std::vector<bool> keep(accessors), views_of_accessors(views);
        for (std::size_t i = 0; i < accessors; ++i) keep[i] = after.used(i) || !before.used(i);
        // A view that no accessor or image uses belongs to an extension that we do not know.
        std::vector<bool> unknown(views, true);
        for (std::size_t i = 0; i < accessors; ++i) note_views(root_["accessors"][i], unknown);
        for (std::size_t i = 0; i < array_size(root_, "images"); ++i) note_views(root_["images"][i], unknown);
        const Json old_accessors = root_.value("accessors", Json::array());
        const Json old_views = root_.value("bufferViews", Json::array());
        glb_.set_kept(keep, unknown);
        for (std::uint32_t i = 0; i < views; ++i)
            if (unknown[i] && !document_.views[i].empty())
                glb_.put_view(i, document_.views[i], ViewTarget::none, document_.view_strides[i]);
        for (std::uint32_t i = 0; i < accessors; ++i)
            if (keep[i]) LUMEL_TRY_STATUS(rewrite_accessor(i, old_accessors[i], after));
        for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) drop_extension(extension);
        return success();
    }

    static void note_views(const Json& json, std::vector<bool>& unknown) {
        if (const std::uint32_t view = index_at(json, "bufferView"); view < unknown.size()) unknown[view] = false;
        if (const Json* sparse = find(json, "sparse"))
            for (const char* part : {"indices", "values"})
                if (const Json* object = find(*sparse, part)) note_views(*object, unknown);
    }

    void note_kept_accessors(const SharedGeometry& geometry, AccessorUse& use) const {
        for (const PartPlan& plan : geometry.parts) {
            const Json& primitive = gltf_primitive(geometry.mesh, plan.part.primitive);
            if (plan.keeps_vertices) note_vertex_accessors(primitive, use);
            if (plan.keeps_indices) use.note_indices(index_at(primitive, "indices"));
        }
        for (const std::uint32_t p : skipped_primitives(geometry.mesh)) {
            const Json& primitive = gltf_mesh(geometry.mesh)["primitives"][p];
            note_vertex_accessors(primitive, use);
            use.note_indices(index_at(primitive, "indices"));
        }
    }

    // Points, lines and whatever else the bake does not know of a mesh: they stay as they are.
    [[nodiscard]] std::vector<std::uint32_t> skipped_primitives(std::uint32_t mesh) const {
        std::vector<bool> read(gltf_mesh(mesh)["primitives"].size());
        for (const PrimitiveSource& source : document_.meshes[mesh].primitives) read[source.gltf_primitive] = true;
        std::vector<std::uint32_t> out;
        for (std::uint32_t p = 0; p < read.size(); ++p)
            if (!read[p]) out.push_back(p);
        return out;
    }

    // A mesh whose every node gets meshes of its own gives its place to the first of them.
    void find_replaced_meshes() {
        std::set<std::uint32_t> replaced, needed;
        std::set<std::pair<std::uint32_t, std::uint32_t>> lit;  // display source: node, instancing index
        for (const InstancePlan& plan : instances_) {
            const DisplaySource& source = in_.scene.display.instances[plan.display].source;
            replaced.insert(source.gltf_mesh);
            if (source.instancing_index != kNone) nodes_to_expand_.insert(source.gltf_node);
            lit.insert({source.gltf_node, source.instancing_index});
        }
        std::set<std::uint32_t> displayed;
        for (const DisplayInstance& instance : in_.scene.display.instances) {
            displayed.insert(instance.source.gltf_node);
            if (!lit.count({instance.source.gltf_node, instance.source.instancing_index}))
                needed.insert(instance.source.gltf_mesh);
        }
        // Nodes of other scenes are not ours.
        for (std::uint32_t n = 0; n < array_size(root_, "nodes"); ++n)
            if (const std::uint32_t mesh = index_at(root_["nodes"][n], "mesh"); mesh != kNone && !displayed.count(n))
                needed.insert(mesh);
        for (const std::uint32_t mesh : replaced)
            if (!needed.count(mesh)) meshes_to_drop_.insert(mesh);
    }

    Status rewrite_accessor(std::uint32_t index, Json json, const AccessorUse& use) {
        if (!find(json, "bufferView") && !find(json, "sparse")) {
            glb_.put_accessor(index, std::move(json));  // all zeros by definition
            return success();
        }
        LUMEL_TRY(const AccessorBytes data, document_.accessor_bytes(index));
        json.erase("sparse");
        json.erase("byteOffset");
        const bool vertices = use.is_vertices(index);
        const ViewTarget target =
            vertices ? ViewTarget::vertices : (use.is_indices(index) ? ViewTarget::indices : ViewTarget::none);
        json["bufferView"] = add_elements(data.bytes, data.components, component_size(data.component), json, target);
        glb_.put_accessor(index, std::move(json));
        return success();
    }

    // Packed elements as a view of their own, padded as glTF wants it for vertex attributes and matrix columns.
    std::uint32_t add_elements(std::span<const std::byte> packed, std::uint32_t components, std::size_t component_bytes,
                               const Json& accessor, ViewTarget target) {
        const auto aligned = [](std::size_t size) { return (size + 3) / 4 * 4; };
        const Json* type = find(accessor, "type");
        const std::size_t columns = !type ? 1 : *type == "MAT2" ? 2 : *type == "MAT3" ? 3 : *type == "MAT4" ? 4 : 1;
        const std::size_t column = components / columns * component_bytes;
        if (columns > 1 && column % 4 != 0) return glb_.add_view(pad_elements(packed, column, aligned(column)), target);
        const std::size_t element = components * component_bytes;
        if (target != ViewTarget::vertices) return glb_.add_view(packed, target);
        if (element % 4 == 0) return glb_.add_view(packed, target, element);
        return glb_.add_view(pad_elements(packed, element, aligned(element)), target, aligned(element));
    }

    // Images move into the file; it is read in another folder than the one it came from.
    Status write_images() {
        for (std::uint32_t i = 0; i < array_size(root_, "images"); ++i) {
            LUMEL_TRY(const std::vector<std::byte> bytes, document_.image_bytes(i));
            if (bytes.empty()) continue;
            Json& image = root_["images"][i];
            image.erase("uri");
            image["bufferView"] = glb_.add_view(bytes, ViewTarget::none);
            if (const char* mime = mime_type(bytes)) image["mimeType"] = mime;
        }
        return success();
    }

    static const char* mime_type(std::span<const std::byte> bytes) {
        const auto starts_with = [&](std::string_view magic, std::size_t at = 0) {
            return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
        };
        if (starts_with("\x89PNG")) return "image/png";
        if (starts_with("\xff\xd8\xff")) return "image/jpeg";
        if (starts_with("RIFF") && starts_with("WEBP", 8)) return "image/webp";
        if (starts_with("\xabKTX 20")) return "image/ktx2";
        return nullptr;
    }

    std::vector<PageTexture> add_page_textures() {
        const auto append = [&](const char* list, Json json) {
            Json& array = root_[list];
            if (!array.is_array()) array = Json::array();
            array.push_back(std::move(json));
            return static_cast<std::uint32_t>(array.size() - 1);
        };
        constexpr unsigned kLinear = 9729, kClamp = 33071;
        const std::uint32_t sampler =
            append("samplers", {{"magFilter", kLinear}, {"minFilter", kLinear}, {"wrapS", kClamp}, {"wrapT", kClamp}});
        for (std::size_t page = 0; page < in_.textures.size(); ++page) {
            const std::string name = "lightmap " + std::to_string(page) + " times albedo";
            const std::uint32_t view = glb_.add_view(in_.textures[page].png, ViewTarget::none);
            const std::uint32_t image =
                append("images", {{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
            const std::uint32_t texture = append("textures", {{"name", name}, {"sampler", sampler}, {"source", image}});
            page_textures_.push_back({texture, in_.textures[page].strength});
        }
        return page_textures_;
    }

    // ---- Shared geometry ------------------------------------------------------------------------------------------

    Status write_geometry(SharedGeometry& geometry) {
        for (const PartPlan& plan : geometry.parts) {
            LUMEL_TRY(Json primitive, write_part(geometry.mesh, plan));
            geometry.primitives.push_back(std::move(primitive));
        }
        return success();
    }

    Result<Json> write_part(std::uint32_t mesh, const PartPlan& plan) {
        Json primitive = gltf_primitive(mesh, plan.part.primitive);
        if (plan.part.group != kNone) make_room_for_uv1(primitive["attributes"], plan.old_uv1);
        LUMEL_TRY_STATUS(gather_attributes(primitive["attributes"], plan));
        if (const auto targets = primitive.find("targets"); targets != primitive.end())
            for (Json& target : *targets) LUMEL_TRY_STATUS(gather_attributes(target, plan));
        primitive.erase("mode");
        if (!plan.keeps_indices) primitive["indices"] = glb_.add_unsigned(plan.part.indices, ViewTarget::indices);
        primitive["extensions"][kExtension] = compact_form(mesh, plan.part);
        return primitive;
    }

    static void make_room_for_uv1(Json& attributes, std::uint32_t old_uv1) {
        const auto uv1 = attributes.find("TEXCOORD_1");
        if (uv1 == attributes.end()) return;
        const Json accessor = *uv1;
        attributes.erase("TEXCOORD_1");
        if (old_uv1 != 1) attributes["TEXCOORD_" + std::to_string(old_uv1)] = accessor;
    }

    Status gather_attributes(Json& attributes, const PartPlan& plan) {
        if (plan.keeps_vertices) return success();
        for (const auto& [name, value] : attributes.items()) {
            if (!value.is_number_unsigned()) continue;
            LUMEL_TRY(const std::uint32_t gathered, gather(value.get<std::uint32_t>(), plan.part.element, name));
            value = gathered;
        }
        return success();
    }

    // The elements of a vertex accessor that a part uses, in its order; components stay as the file stores them.
    Result<std::uint32_t> gather(std::uint32_t accessor, const std::vector<std::uint32_t>& elements,
                                 const std::string& name) {
        LUMEL_TRY(const AccessorView view, open_accessor(document_, accessor));
        std::vector<std::byte> packed(elements.size() * view.packed_size());
        for (std::size_t i = 0; i < elements.size(); ++i) {
            LUMEL_CHECK(elements[i] < view.count, elements[i], view.count, name);
            view.copy_element(elements[i], &packed[i * view.packed_size()]);
        }
        Json json = document_.root["accessors"][accessor];
        for (const char* key : {"sparse", "byteOffset", "min", "max"}) json.erase(key);
        json["count"] = elements.size();
        json["bufferView"] =
            add_elements(packed, view.components, component_size(view.component), json, ViewTarget::vertices);
        if (name == "POSITION") set_bounds(json, packed, view);
        return glb_.add_accessor(std::move(json));
    }

    // min and max of the stored numbers, which POSITION must have.
    static void set_bounds(Json& json, std::span<const std::byte> packed, const AccessorView& view) {
        const std::size_t size = component_size(view.component);
        std::vector<float> low(view.components), high(view.components);
        for (std::size_t i = 0; i < packed.size() / size; ++i) {
            const float v = component_number(&packed[i * size], view.component, false);
            const std::size_t c = i % view.components;
            low[c] = i < view.components ? v : std::min(low[c], v);
            high[c] = i < view.components ? v : std::max(high[c], v);
        }
        json["min"] = Json::array();
        json["max"] = Json::array();
        for (std::size_t c = 0; c < view.components; ++c) {
            json["min"].push_back(json_number(low[c]));
            json["max"].push_back(json_number(high[c]));
        }
    }

    // Chart and chart UV per vertex, and which triangles of the mesh these are.
    Json compact_form(std::uint32_t mesh, const MeshPart& part) {
        Json out;
        out["primitive"] = document_.meshes[mesh].primitives[part.primitive].gltf_primitive;
        const std::uint32_t first = part.triangles.front();
        const bool consecutive = part.triangles.back() - first + 1 == part.triangles.size();
        if (consecutive)
            out["firstTriangle"] = first;
        else
            out["triangles"] = glb_.add_unsigned(part.triangles, ViewTarget::none);
        if (part.group == kNone) return out;
        std::vector<std::uint32_t> charts = part.chart;
        for (std::uint32_t& chart : charts)
            if (chart == kNone) chart = 0;  // of zero-area triangles: never seen
        out["charts"] = glb_.add_unsigned(charts, ViewTarget::none);
        out["chartUvs"] = glb_.add_array(std::span<const Vec2>(part.chart_uv), Component::float32, "VEC2",
                                         part.chart_uv.size(), ViewTarget::none);
        return out;
    }

    // ---- Instances ------------------------------------------------------------------------------------------------

    void write_instances(LitMaterials& materials) {
        if (instances_.empty()) return;
        uv_view_ = glb_.reserve_view();
        transform_view_ = glb_.reserve_view();
        const std::map<std::uint32_t, std::vector<std::uint32_t>> expanded = expand_instancing();
        for (const InstancePlan& plan : instances_) {
            const DisplayInstance& display = in_.scene.display.instances[plan.display];
            const DisplaySource& source = display.source;
            const std::uint32_t node = source.instancing_index == kNone
                                           ? source.gltf_node
                                           : expanded.at(source.gltf_node).at(source.instancing_index);
            const std::uint32_t mesh = place_mesh(source.gltf_mesh, instance_mesh(plan, materials));
            root_["nodes"][node]["mesh"] = mesh;
            root_["nodes"][node]["extensions"][kExtension] = node_extension(display.baked_instance);
        }
        glb_.put_view(uv_view_, std::as_bytes(std::span(uvs_)), ViewTarget::vertices, sizeof(Vec2));
        glb_.put_view(transform_view_, std::as_bytes(std::span(transforms_)), ViewTarget::none);
        for (const char* name : {kExtension, "KHR_materials_emissive_strength", "KHR_materials_specular"})
            add_to_list(root_, "extensionsUsed", name);
    }

    // A slot that a replaced mesh left, or a new one.
    std::uint32_t place_mesh(std::uint32_t gltf_mesh, Json mesh) {
        if (meshes_to_drop_.erase(gltf_mesh) > 0) {
            root_["meshes"][gltf_mesh] = std::move(mesh);
            return gltf_mesh;
        }
        root_["meshes"].push_back(std::move(mesh));
        return static_cast<std::uint32_t>(root_["meshes"].size() - 1);
    }

    Json instance_mesh(const InstancePlan& plan, LitMaterials& materials) {
        const SharedGeometry& geometry = geometries_[plan.geometry];
        const std::vector<Atlas::TriangleUv> uvs = lift(in_.scene, in_.charts, in_.atlas, plan.display);
        Json mesh = gltf_mesh(geometry.mesh);
        Json primitives = Json::array();
        for (std::size_t p = 0; p < geometry.parts.size(); ++p) {
            const PartPlan& part = geometry.parts[p];
            const std::uint32_t page = part.part.group == kNone ? kNone : plan.pages[part.part.group];
            primitives.push_back(instance_primitive(geometry, p, page, uvs, materials));
        }
        for (const std::uint32_t p : skipped_primitives(geometry.mesh)) primitives.push_back(mesh["primitives"][p]);
        mesh["primitives"] = std::move(primitives);
        return mesh;
    }

    Json instance_primitive(const SharedGeometry& geometry, std::size_t p, std::uint32_t page,
                            const std::vector<Atlas::TriangleUv>& uvs, LitMaterials& materials) {
        const PartPlan& plan = geometry.parts[p];
        Json primitive = geometry.primitives[p];
        if (page == kNone) return primitive;
        Json& attributes = primitive["attributes"];
        attributes["TEXCOORD_1"] = add_lightmap_uvs(plan.part, page, uvs);
        // glTF counts UV sets from 0 without gaps: a file without UVs gets the lightmap's under both numbers.
        if (!find(attributes, "TEXCOORD_0")) attributes["TEXCOORD_0"] = attributes["TEXCOORD_1"];
        primitive["material"] = materials.lit(index_at(primitive, "material"), page, plan.old_uv1);
        primitive["extensions"][kExtension]["page"] = page;
        return primitive;
    }

    // TEXCOORD_1: texels over the size of the page.
    std::uint32_t add_lightmap_uvs(const MeshPart& part, std::uint32_t page,
                                   const std::vector<Atlas::TriangleUv>& uvs) {
        const AtlasPage& size = in_.atlas.pages[page];
        const std::size_t offset = uvs_.size() * sizeof(Vec2);
        for (std::size_t v = 0; v < part.element.size(); ++v) {
            const Atlas::TriangleUv& triangle = uvs[part.triangles[part.corner[v] / 3]];
            const Vec2 texels = triangle.texels[part.corner[v] % 3];
            const Vec2 uv{texels.x / static_cast<float>(size.width), texels.y / static_cast<float>(size.height)};
            // A kept layout is kept to the bit.
            uvs_.push_back(part.chart[v] == kNone ? Vec2{} : (in_.charts.scene_wide ? part.chart_uv[v] : uv));
        }
        return glb_.add_accessor(
            GlbBuilder::accessor_json(uv_view_, offset, Component::float32, "VEC2", part.element.size()));
    }

    // Which baked instance this is, and where its charts lie: TEXCOORD_1 = chartUv * (x, y) + (z, w).
    Json node_extension(std::uint32_t instance) {
        const std::uint32_t first = in_.atlas.first_placement[instance], last = in_.atlas.first_placement[instance + 1];
        const std::size_t offset = transforms_.size() * sizeof(Vec4);
        for (std::uint32_t i = first; i < last; ++i) {
            const ChartPlacement& place = in_.atlas.placements[i];
            const AtlasPage size = place.page == kNone ? AtlasPage{1, 1} : in_.atlas.pages[place.page];
            const float w = static_cast<float>(size.width), h = static_cast<float>(size.height);
            transforms_.push_back({place.scale.x / w, place.scale.y / h, place.offset.x / w, place.offset.y / h});
        }
        const std::uint32_t accessor = glb_.add_accessor(
            GlbBuilder::accessor_json(transform_view_, offset, Component::float32, "VEC4", last - first));
        return {{"instance", instance}, {"transforms", accessor}};
    }

    // Nodes with EXT_mesh_gpu_instancing that have a lightmapped instance: each instance becomes a child node. Returns
    // the children by node.
    std::map<std::uint32_t, std::vector<std::uint32_t>> expand_instancing() {
        std::map<std::uint32_t, std::vector<std::uint32_t>> out;
        for (const std::uint32_t node : nodes_to_expand_) out[node] = expand(node);
        if (!out.empty() && !uses_extension(kInstancing)) drop_extension(kInstancing);
        return out;
    }

    std::vector<std::uint32_t> expand(std::uint32_t node) {
        const Json extension = root_["nodes"][node]["extensions"][kInstancing];
        const Json mesh = root_["nodes"][node]["mesh"];
        std::vector<std::uint32_t> children;
        for (Json& child : instance_nodes(extension)) {
            const Json* name = find(root_["nodes"][node], "name");
            const std::string stem =
                name && name->is_string() ? name->get<std::string>() : "node " + std::to_string(node);
            Json named = {{"name", stem + "#" + std::to_string(children.size())}};
            named.update(child);
            named["mesh"] = mesh;
            children.push_back(static_cast<std::uint32_t>(root_["nodes"].size()));
            root_["nodes"].push_back(std::move(named));
        }
        Json& parent = root_["nodes"][node];
        parent.erase("mesh");
        erase_extension(parent, kInstancing);
        for (const std::uint32_t child : children) parent["children"].push_back(child);
        return children;
    }

    // Translation, rotation and scale of every instance. The reader has checked the accessors.
    std::vector<Json> instance_nodes(const Json& extension) const {
        static constexpr std::array<std::pair<const char*, const char*>, 3> kParts{
            {{"TRANSLATION", "translation"}, {"ROTATION", "rotation"}, {"SCALE", "scale"}}};
        std::vector<Json> out;
        for (const auto& [attribute, key] : kParts) {
            const std::uint32_t accessor = index_at(extension["attributes"], attribute);
            if (accessor == kNone) continue;
            const auto view = open_accessor(document_, accessor);
            LUMEL_CHECK(view.ok(), accessor);
            if (out.empty()) out.assign(view->count, Json::object());
            for (std::size_t i = 0; i < out.size(); ++i)
                for (std::uint32_t c = 0; c < view->components; ++c)
                    out[i][key].push_back(json_number(view->number(i, c)));
        }
        return out;
    }

    // ---- Extensions and lights ------------------------------------------------------------------------------------

    static void erase_extension(Json& object, const char* name) {
        const auto extensions = object.find("extensions");
        if (extensions == object.end() || !extensions->is_object()) return;
        extensions->erase(name);
        if (extensions->empty()) object.erase("extensions");
    }

    [[nodiscard]] bool uses_extension(const char* name) const {
        for (const Json& node : root_["nodes"])
            if (find_extension(node, name)) return true;
        return false;
    }

    void drop_extension(const char* name) {
        for (const char* list : {"extensionsUsed", "extensionsRequired"}) remove_from_list(root_, list, name);
    }

    // Lights whose direct light the bake holds would light the scene twice.
    void remove_baked_lights() {
        if (!in_.include.direct || array_size(root_, "nodes") == 0) return;
        std::set<std::uint32_t> realtime;
        for (std::size_t i = 0; i < document_.light_nodes.size(); ++i)
            if (in_.scene.lights[i].bake != LightBake::all) realtime.insert(document_.light_nodes[i]);
        const Json lights = lights_of(root_);
        for (std::uint32_t n = 0; n < root_["nodes"].size(); ++n)
            if (!realtime.count(n)) remove_light(root_["nodes"][n], lights);
        if (uses_extension(kLights)) return;
        erase_extension(root_, kLights);
        drop_extension(kLights);
    }

    static Json lights_of(const Json& root) {
        const Json* extension = find_extension(root, kLights);
        const Json* lights = extension ? find(*extension, "lights") : nullptr;
        return lights ? *lights : Json::array();
    }

    static void remove_light(Json& node, const Json& lights) {
        const Json* extension = find_extension(node, kLights);
        if (!extension) return;
        const std::uint32_t light = index_at(*extension, "light");
        erase_extension(node, kLights);
        Json& extras = node["extras"];
        if (!extras.is_null() && !extras.is_object()) extras = {{"value", extras}};
        if (light < lights.size()) extras["lumel"]["light"] = lights[light];
    }

    void write_root_extension() {
        Json pages = Json::array();
        for (std::uint32_t p = 0; p < in_.atlas.pages.size(); ++p)
            pages.push_back({{"width", in_.atlas.pages[p].width},
                             {"height", in_.atlas.pages[p].height},
                             {"lightmap", page_file(PageFile::lightmap, p)},
                             {"irradiance", page_file(PageFile::irradiance, p)},
                             {"l1", page_file(PageFile::l1, p)},
                             {"texture", page_textures_[p].texture},
                             {"strength", json_number(page_textures_[p].strength)}});
        root_["extensions"][kExtension] = {{"version", 1},
                                           {"units",
                                            {{"lightmap", unit_name(unit_of(PageFile::lightmap))},
                                             {"irradiance", unit_name(unit_of(PageFile::irradiance))},
                                             {"l1", unit_name(unit_of(PageFile::l1))},
                                             {"texture", "albedo x E/pi"}}},
                                           {"manifest", kManifestFile},
                                           {"geometry", in_.geometry_hash},
                                           {"pages", std::move(pages)}};
        add_to_list(root_, "extensionsUsed", kExtension);
        root_["asset"]["generator"] = "Lumel";
    }

    const GltfWriteInput& in_;
    const GltfDocument& document_;
    GlbBuilder glb_;
    Json& root_;
    std::vector<SharedGeometry> geometries_;
    std::vector<InstancePlan> instances_;
    std::set<std::uint32_t> meshes_to_drop_, nodes_to_expand_;
    std::vector<PageTexture> page_textures_;
    std::vector<Vec2> uvs_;         // of all instances
    std::vector<Vec4> transforms_;  // of all instances
    std::uint32_t uv_view_ = 0, transform_view_ = 0;
};

}  // namespace

Status write_lit_gltf(const std::filesystem::path& path, const GltfWriteInput& input) {
    try {
        return Writer(input).write(path);
    } catch (const Json::exception& e) {
        return Error{ErrorCode::invalid_input, std::string("cannot be written back: ") + e.what(), input.document.where,
                     "check the file with the glTF validator"};
    }
}

}  // namespace lumel
