// The node tree, walked without recursion: parents, scene, animation, transforms.
#include "io/gltf_nodes.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/try.h"

namespace lumel {
namespace {

// TRS or matrix of one node, relative to its parent.
Result<AffineD> local_transform(const Json& node, const std::string& where) {
    if (!find(node, "matrix")) {
        LUMEL_TRY(const auto translation, (numbers_or<3>(node, "translation", {0, 0, 0}, where)));
        LUMEL_TRY(const auto rotation, (numbers_or<4>(node, "rotation", {0, 0, 0, 1}, where)));
        LUMEL_TRY(const auto scale, (numbers_or<3>(node, "scale", {1, 1, 1}, where)));
        if (rotation == std::array<double, 4>{}) return invalid(where, "'rotation' is a quaternion of length zero");
        return compose(translation, rotation, scale);
    }
    LUMEL_TRY(const auto m, (numbers_or<16>(node, "matrix", {}, where)));
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) return invalid(where, "'matrix' is not affine");
    AffineD out;
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t r = 0; r < 3; ++r) out.columns[c][r] = m[c * 4 + r];
    return out;
}

bool finite(const Affine& m) {
    return is_finite(m.columns[0]) && is_finite(m.columns[1]) && is_finite(m.columns[2]) && is_finite(m.translation);
}

class NodeReader {
public:
    explicit NodeReader(const GltfDocument& document)
        : document_(document),
          count_(array_size(document.root, "nodes")),
          instances_left_(65536 + document.file_bytes) {}

    Result<std::vector<SceneNode>> read() {
        LUMEL_TRY_STATUS(read_parents());
        LUMEL_TRY(const std::vector<std::uint32_t> order, parents_first());
        LUMEL_TRY(const std::vector<bool> included, in_scene(order));
        LUMEL_TRY_STATUS(read_animated());
        std::vector<SceneNode> all(count_);
        for (const std::uint32_t index : order) {
            LUMEL_TRY(all[index], read_node(index, all));
        }
        std::vector<SceneNode> out;
        for (std::uint32_t i = 0; i < count_; ++i)
            if (included[i]) out.push_back(std::move(all[i]));
        return out;
    }

private:
    [[nodiscard]] std::string where(std::uint64_t index) const {
        return document_.where + ": node " + std::to_string(index);
    }

    // Reads the index array `key` of `holder`, all of them nodes.
    Result<std::vector<std::uint32_t>> node_list(const Json& holder, const char* key, const std::string& where) const {
        std::vector<std::uint32_t> out;
        LUMEL_TRY(const Json* array, optional_array(holder, key, where));
        for (std::size_t i = 0; array && i < array->size(); ++i) {
            const Json& value = (*array)[i];
            if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= count_)
                return invalid(where, std::string("'") + key + "' refers to a node that does not exist");
            out.push_back(value.get<std::uint32_t>());
        }
        return out;
    }

    Status read_parents() {
        parents_.assign(count_, kNone);
        children_.resize(count_);
        for (std::uint32_t i = 0; i < count_; ++i) {
            LUMEL_TRY(const Json* node, element(document_.root, "nodes", i, document_.where));
            LUMEL_TRY(children_[i], node_list(*node, "children", where(i)));
            for (const std::uint32_t child : children_[i]) {
                if (parents_[child] != kNone || child == i)
                    return invalid(where(child), "has more than one parent, or is its own", "nodes must form a tree");
                parents_[child] = i;
            }
        }
        return success();
    }

    // With one parent each, what cannot be reached from a root lies on a cycle or below one.
    Result<std::vector<std::uint32_t>> parents_first() const {
        std::vector<std::uint32_t> order;
        order.reserve(count_);
        for (std::uint32_t i = 0; i < count_; ++i)
            if (parents_[i] == kNone) order.push_back(i);
        for (std::size_t next = 0; next < order.size(); ++next)
            for (const std::uint32_t child : children_[order[next]]) order.push_back(child);
        if (order.size() == count_) return order;
        std::vector<bool> reached(count_);
        for (const std::uint32_t index : order) reached[index] = true;
        const auto lost = std::find(reached.begin(), reached.end(), false) - reached.begin();
        return invalid(where(static_cast<std::uint64_t>(lost)), "is its own ancestor: the node graph has a cycle",
                       "nodes must form a tree");
    }

    Result<std::vector<bool>> in_scene(const std::vector<std::uint32_t>& order) const {
        LUMEL_TRY(const std::uint64_t scene, count_or(document_.root, "scene", 0, document_.where));
        if (array_size(document_.root, "scenes") == 0) return std::vector<bool>(count_, true);
        LUMEL_TRY(const Json* json, element(document_.root, "scenes", scene, document_.where));
        LUMEL_TRY(const auto roots, node_list(*json, "nodes", document_.where + ": scene " + std::to_string(scene)));
        std::vector<bool> included(count_);
        for (const std::uint32_t root : roots) included[root] = true;
        for (const std::uint32_t index : order)
            if (parents_[index] != kNone && included[parents_[index]]) included[index] = true;
        return included;
    }

    Status read_animated() {
        animated_.assign(count_, false);
        for (std::size_t a = 0; a < array_size(document_.root, "animations"); ++a) {
            const std::string animation_where = document_.where + ": animation " + std::to_string(a);
            LUMEL_TRY(const Json* animation, element(document_.root, "animations", a, document_.where));
            for (std::size_t c = 0; c < array_size(*animation, "channels"); ++c) {
                LUMEL_TRY(const Json* channel, element(*animation, "channels", c, animation_where));
                LUMEL_TRY(const Json* target, optional_object(*channel, "target", animation_where));
                if (!target) continue;
                LUMEL_TRY(const std::optional<std::uint64_t> node, optional_count(*target, "node", animation_where));
                if (!node) continue;
                if (*node >= count_) return invalid(animation_where, "moves a node that does not exist");
                animated_[*node] = true;
            }
        }
        return success();
    }

    Result<SceneNode> read_node(std::uint32_t index, const std::vector<SceneNode>& all) {
        LUMEL_TRY(const Json* json, element(document_.root, "nodes", index, document_.where));
        SceneNode node;
        node.index = index;
        node.parent = parents_[index];
        LUMEL_TRY(node.name, string_or(*json, "name", "", where(index)));
        node.named = !node.name.empty();
        const std::uint64_t above = node.parent == kNone ? 0 : all[node.parent].path_hash;
        node.path_hash = Hasher().pod(above).text(node.name).finish().low;
        if (!node.named) node.name = "node " + std::to_string(index);
        LUMEL_TRY_STATUS(read_parts(*json, node));
        LUMEL_TRY(const AffineD local, local_transform(*json, where(index)));
        const SceneNode* parent = node.parent == kNone ? nullptr : &all[node.parent];
        node.world = parent ? parent->world * local : local;
        if (!finite(node.world.rounded())) return invalid(where(index), "its transform is not finite");
        node.animated = animated_[index] || (parent && parent->animated);
        if (!node.lightmap && parent) node.lightmap = parent->lightmap;
        return node;
    }

    Status read_parts(const Json& json, SceneNode& node) {
        const std::string at = where(node.index);
        LUMEL_TRY(node.mesh, optional_count(json, "mesh", at));
        if (node.mesh) LUMEL_TRY_STATUS(element_exists(document_.root, "meshes", *node.mesh, at));
        LUMEL_TRY(node.camera, optional_count(json, "camera", at));
        node.skinned = find(json, "skin") != nullptr;
        if (const Json* light = find_extension(json, "KHR_lights_punctual")) {
            LUMEL_TRY(node.light, required_count(*light, "light", at));
        }
        if (const Json* instancing = find_extension(json, "EXT_mesh_gpu_instancing")) {
            LUMEL_TRY(node.instances,
                      read_instancing(document_, *instancing, instances_left_, at + ", EXT_mesh_gpu_instancing"));
            instances_left_ -= node.instances.size();
        }
        // extras belong to their authors: anything but a boolean says nothing to us.
        const Json* extras = find(json, "extras");
        const Json* lightmap = extras ? find(*extras, "lightmap") : nullptr;
        if (lightmap && lightmap->is_boolean()) node.lightmap = lightmap->get<bool>();
        return success();
    }

    const GltfDocument& document_;
    std::size_t count_;
    // Nodes may share the accessors of their instances, so that a small file could ask for any number.
    std::uint64_t instances_left_;
    std::vector<std::uint32_t> parents_;
    std::vector<std::vector<std::uint32_t>> children_;
    std::vector<bool> animated_;
};

}  // namespace

Affine AffineD::rounded() const {
    const auto column = [&](std::size_t i) {
        return Vec3{static_cast<float>(columns[i][0]), static_cast<float>(columns[i][1]),
                    static_cast<float>(columns[i][2])};
    };
    return {{column(0), column(1), column(2)}, column(3)};
}

AffineD operator*(const AffineD& a, const AffineD& b) {
    AffineD out;
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t r = 0; r < 3; ++r)
            out.columns[c][r] = a.columns[0][r] * b.columns[c][0] + a.columns[1][r] * b.columns[c][1] +
                                a.columns[2][r] * b.columns[c][2] + (c == 3 ? a.columns[3][r] : 0.0);
    return out;
}

AffineD compose(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
                const std::array<double, 3>& scale) {
    const double length = std::sqrt(rotation[0] * rotation[0] + rotation[1] * rotation[1] + rotation[2] * rotation[2] +
                                    rotation[3] * rotation[3]);
    const double x = rotation[0] / length, y = rotation[1] / length, z = rotation[2] / length, w = rotation[3] / length;
    AffineD out;
    out.columns[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
    out.columns[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
    out.columns[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    for (std::size_t c = 0; c < 3; ++c)
        for (double& value : out.columns[c]) value *= scale[c];
    out.columns[3] = translation;
    return out;
}

Result<std::vector<SceneNode>> read_nodes(const GltfDocument& document) { return NodeReader(document).read(); }

}  // namespace lumel
