// Bakes one square metre of white floor under a sky of radiance 1: every texel's irradiance over pi is 1.
#include <lumel/lumel.h>

#include <cmath>
#include <cstdio>
#include <memory>

namespace {

std::shared_ptr<const lumel::Mesh> square() {
    auto mesh = std::make_shared<lumel::Mesh>();
    mesh->name = "floor";
    mesh->positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
    mesh->normals.assign(4, lumel::Vec3{0, 1, 0});
    mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh->primitives = {{0, 4, 0, 2, lumel::kNone}};
    return mesh;
}

lumel::Scene floor_under_sky() {
    lumel::Scene scene;
    scene.source = "consumer";
    scene.materials.push_back({});
    scene.meshes.push_back(square());
    lumel::Instance floor;
    floor.name = "floor";
    floor.mesh = 0;
    scene.instances.push_back(floor);
    scene.sky.color = {1, 1, 1};
    return scene;
}

}  // namespace

int main() {
    lumel::BakeOptions options;
    options.texels_per_metre = 8;
    options.samples = 64;
    lumel::Context context;
    int pages = 0;
    lumel::BakeSink sink;
    sink.page = [&pages](const lumel::Lightmap&) {
        ++pages;
        return lumel::success();
    };
    const lumel::Result<lumel::BakeReport> report = lumel::bake(floor_under_sky(), options, sink, context);
    if (!report) {
        std::fprintf(stderr, "consumer: %s\n", report.error().text().c_str());
        return 1;
    }
    const double mean = report->mean_irradiance[1];
    std::printf("consumer: %d page, %llu texels, mean E/pi %.4f\n", pages,
                static_cast<unsigned long long>(report->texels), mean);
    // The paths of 64 stratified samples see nothing but sky: no noise but rounding.
    return pages == 1 && report->texels > 0 && std::abs(mean - 1.0) < 1e-3 ? 0 : 1;
}
