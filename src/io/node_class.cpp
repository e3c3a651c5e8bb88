// The rule of docs/sidecar.md, first match wins.
#include "io/node_class.h"

namespace lumel {
namespace {

// Below a thousandth of the scene an object is a few texels at any density that a whole scene is baked with, and
// charts of single texels serve it worse than a probe. The 10 cm keep the furniture of a large level in the lightmap.
constexpr double kSmallShare = 0.001, kSmallMetres = 0.1;

}  // namespace

ClassOfNode classify(const SceneNode& node, const NodeSettings& settings, double diagonal, double scene_diagonal) {
    if (settings.node_class)
        return {*settings.node_class, *settings.node_class == NodeClass::lightmap ? "" : "by the sidecar", true};
    if (node.lightmap) {
        if (*node.lightmap) return {NodeClass::lightmap, "", true};
        return {NodeClass::volume, "extras.lightmap is false", true};
    }
    if (node.skinned) return {NodeClass::probe, "skinned", false};
    if (node.animated) return {NodeClass::probe, "animated", false};
    if (diagonal < kSmallShare * scene_diagonal && diagonal < kSmallMetres) return {NodeClass::probe, "small", false};
    return {};
}

const char* class_name(NodeClass node_class) {
    switch (node_class) {
        case NodeClass::lightmap: return "lightmap";
        case NodeClass::volume: return "volume";
        case NodeClass::probe: return "probe";
        case NodeClass::occluder: return "occluder";
        case NodeClass::ignored: return "ignored";
    }
    return "lightmap";
}

}  // namespace lumel
