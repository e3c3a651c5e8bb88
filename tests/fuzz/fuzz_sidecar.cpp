// Any text as a sidecar, parsed and applied to a small scene.
#include "fuzz/seed_corpus.h"
#include "io/sidecar.h"

namespace {

lumel::SceneNode node(std::uint32_t index, std::uint32_t parent, const char* name) {
    lumel::SceneNode out;
    out.index = index;
    out.parent = parent;
    out.name = name;
    return out;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    using lumel::fuzz::bytes_of;
    lumel::fuzz::seed_corpus(
        *argc, *argv,
        {bytes_of(
             R"({"version":1,"lights":{"a":{"radius":0.1,"bake":"indirect","indirect_scale":2,"indirect_color":[1,0,0]}}})"),
         bytes_of(
             R"({"lights":{"s":{"angle_degrees":0.5}},"nodes":{"a":{"class":"probe","texel_density":2},"b":{"class":"ignored"}}})"),
         bytes_of(R"({"sky":{"color":[1,2,3],"intensity":2,"rotation_degrees":90}})"),
         bytes_of(R"({"sky":{"map":"a.hdr"}})"),
         bytes_of(
             R"({"area_lights":[{"shape":"rectangle","width":1,"height":2,"position":[0,1,0],"direction":[0,-1,0],"up":[1,0,0],"nits":9}]})"),
         bytes_of(
             R"({"area_lights":[{"name":"x","shape":"disc","radius":1,"node":"b","nits":9,"color":[1,0,1]},{"shape":"sphere","radius":1,"position":[0,0,0],"nits":1}]})")});
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto sidecar = lumel::parse_sidecar({reinterpret_cast<const char*>(data), size}, "fuzz.lumel.json");
    if (!sidecar.ok()) return 0;
    const std::vector<lumel::SceneNode> nodes{node(0, lumel::kNone, "a"), node(1, 0, "b")};
    std::vector<lumel::ReadLight> lights(2);
    lights[0].light.name = "a";
    lights[1].light.name = "s";
    lights[1].light.shape = lumel::LightShape::sun;
    lumel::Sky sky;
    (void)lumel::apply_lights(*sidecar, nodes, lights);
    (void)lumel::apply_sky(*sidecar, {}, sky);
    (void)lumel::node_settings(*sidecar, nodes);
    return 0;
}
