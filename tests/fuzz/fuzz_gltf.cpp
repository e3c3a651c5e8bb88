// Any bytes as a .glb: the loader says no or gives a scene that holds what every stage takes for granted.
#include <meshoptimizer.h>

#include "base/check.h"
#include "fuzz/mutate_glb.h"
#include "fuzz/seed_corpus.h"
#include "io/gltf_document.h"
#include "io/image_io.h"
#include "io/info.h"
#include "scene/world_geometry.h"
#include "support/gltf_builder.h"

using lumel::test::GltfBuilder;

namespace {

GltfBuilder plain() {
    GltfBuilder builder;
    builder.triangle_node();
    builder.root["scenes"] = {{{"nodes", {0}}}};
    return builder;
}

GltfBuilder materials() {
    GltfBuilder builder = plain();
    const std::vector<std::uint8_t> pixels(16, 200);
    builder.add("images", {{"bufferView", builder.view(lumel::encode_png(2, 2, 4, pixels))}});
    builder.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    builder.add("textures", {{"source", 0}, {"sampler", 0}});
    GltfBuilder::Json info{{"index", 0}, {"texCoord", 1}};
    info["extensions"]["KHR_texture_transform"] = {{"rotation", 0.5}, {"offset", {0.1, 0.2}}, {"scale", {2, 3}}};
    GltfBuilder::Json material{
        {"name", "m"}, {"alphaMode", "MASK"}, {"doubleSided", true}, {"emissiveFactor", {1, 0.5, 0}}};
    material["pbrMetallicRoughness"] = {{"baseColorTexture", info}, {"baseColorFactor", {0.5, 0.5, 0.5, 1}}};
    material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 4;
    builder.add("materials", material);
    builder.root["meshes"][0]["primitives"][0]["material"] = 0;
    builder.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
        builder.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    return builder;
}

GltfBuilder instances() {
    GltfBuilder builder = plain();
    builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", builder.accessor<float>({0, 0, 0, 10, 0, 0}, "VEC3")},
        {"ROTATION", builder.accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}, "VEC4", true)}};
    builder.node({{"children", {0}},
                  {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}},
                  {"extras", {{"lightmap", false}}}});
    builder.node({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}}};
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}};
    builder.root["scenes"] = {{{"nodes", {1, 2}}}};
    builder.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    return builder;
}

GltfBuilder sparse_strip() {
    GltfBuilder builder;
    GltfBuilder::Json primitive{{"mode", 5}, {"indices", builder.accessor<std::uint8_t>({0, 1, 2, 3}, "SCALAR")}};
    const std::vector<std::uint16_t> quantised{0, 0, 0, 0, 9, 0, 0, 0, 0, 9, 0, 0, 9, 9, 0, 0};
    const std::size_t positions =
        builder.accessor(builder.view(std::as_bytes(std::span(quantised)), 8), 5123, "VEC3", 4);
    const std::vector<std::uint8_t> index{1};
    const std::vector<std::uint16_t> value{5, 5, 5};
    const std::size_t index_view = builder.view(std::as_bytes(std::span(index)));
    builder.root["accessors"][positions]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", index_view}, {"componentType", 5121}}},
        {"values", {{"bufferView", builder.view(std::as_bytes(std::span(value)))}}}};
    builder.node({{"mesh", builder.mesh({{"POSITION", positions}}, primitive)}});
    return builder;
}

GltfBuilder meshopt() {
    GltfBuilder builder;
    const std::vector<float> vertices{0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::vector<unsigned char> data(meshopt_encodeVertexBufferBound(3, 12));
    data.resize(meshopt_encodeVertexBuffer(data.data(), data.size(), vertices.data(), 3, 12));
    const std::size_t view = builder.view(std::as_bytes(std::span(data)));
    builder.root["bufferViews"][view] = {{"buffer", 0}, {"byteLength", 36}};
    builder.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0}, {"byteLength", data.size()}, {"byteStride", 12}, {"count", 3}, {"mode", "ATTRIBUTES"}};
    builder.node({{"mesh", builder.mesh({{"POSITION", builder.accessor(view, 5126, "VEC3", 3)}})}});
    return builder;
}

// Light and emission at the end of single precision.
GltfBuilder too_bright() {
    GltfBuilder builder = materials();
    builder.root["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 3e38;
    builder.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 3e38}}};
    return builder;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    lumel::fuzz::seed_corpus(*argc, *argv,
                             {plain().glb(), materials().glb(), instances().glb(), sparse_strip().glb(),
                              meshopt().glb(), too_bright().glb()});
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    return lumel::fuzz::mutate_glb(data, size, max_size, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    lumel::Context context(1);
    const auto loaded = lumel::load_glb(lumel::fuzz::as_span(data, size), "fuzz.glb", context);
    if (!loaded.ok()) return 0;
    const lumel::Status valid = lumel::validate(loaded->scene);
    LUMEL_CHECK(valid.ok(), valid.error().text());
    (void)lumel::flatten(loaded->scene, context);
    lumel::ChartSet uv1;
    uv1.meshes.resize(loaded->scene.meshes.size());
    (void)lumel::describe_json(loaded->scene, uv1, context.diagnostics);
    (void)lumel::hash_scene(loaded->scene);
    return 0;
}
