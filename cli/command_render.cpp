// lumel render: a picture of a scene, path-traced, or of the same view lit by a bake.
#include <cstdio>
#include <filesystem>
#include <optional>

#include "base/try.h"
#include "camera.h"
#include "command.h"
#include "image/tonemap.h"
#include "interrupt.h"
#include "io/atomic_file.h"
#include "io/baked.h"
#include "io/image_io.h"
#include "io/light_record.h"
#include "job/baked_light.h"
#include "lumel/load.h"
#include "path/path_integrator.h"
#include "render/picture.h"

namespace lumel::cli {
namespace {

struct Options {
    std::string scene, output, camera, baked, resolution = "640x360", progress;
    double exposure = 0.0;
    LightOptions light;
};

constexpr std::uint32_t kUsualSamples = 64;

// Before the work, not after it.
Status check_output(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension != ".png" && extension != ".exr" && extension != ".hdr" && extension != ".pfm")
        return Error{ErrorCode::usage, "-o: unknown picture format '" + extension + "'", path.string(),
                     "use .png, .exr, .hdr or .pfm"};
    std::error_code ignored;
    if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path(), ignored))
        return Error{ErrorCode::io, "its folder does not exist", path.string(), "create it, or choose another with -o"};
    if (std::filesystem::is_directory(path, ignored))
        return Error{ErrorCode::io, "is a folder", path.string(), "give the name of a picture with -o"};
    return success();
}

Status write_picture(const std::string& path, const Image& image, double exposure) {
    const std::string extension = std::filesystem::path(path).extension().string();
    if (extension == ".exr") return write_exr(path, image, ExrType::full);
    if (extension == ".hdr") return write_hdr(path, image);
    if (extension == ".pfm") return write_pfm(path, image);
    const float factor = exposure > 0.0 ? static_cast<float>(exposure) : auto_exposure(image);
    return write_png(path, image.width, image.height, 3, tonemap(image, factor));
}

// The light that lit the bake, where the command line has no other. Returns what was taken, as it would be given.
Result<std::string> take_light_of_bake(const Options& options, const LightRecord& bake, BakeOptions& light) {
    const bool own_sky = !light.sky.file.empty();
    std::string taken = options.light.take_over(bake, light);
    std::error_code ignored;
    if (!own_sky && !light.sky.file.empty() && !std::filesystem::exists(light.sky.file, ignored))
        return Error{ErrorCode::io, "the sky map that lit the bake is not there any more", light.sky.file,
                     "say where it is with --sky FILE and the bake's other options of light, which its manifest.json "
                     "has, or go without by --sky 0,0,0"};
    return taken;
}

// What is seen of the sky, and what has no texels, is not lit by the bake's files.
void warn_of_other_light(const LightRecord& bake, const LoadedScene& loaded, const BakeOptions& light,
                         Diagnostics& diagnostics) {
    const auto warn = [&](const std::string& where) {
        diagnostics.add("other-light",
                        "These are not as they were when the scene was baked: the sky, and surfaces without texels, "
                        "show another light than the baked ones; give the bake's options of light, or bake again",
                        where);
    };
    if (!bake.sky_hash.empty() && !loaded.sky_hash.empty() && loaded.sky_hash != bake.sky_hash)
        warn("sky map " + light.sky.file);
    else if (hash_scene(loaded.scene).hex() != bake.input_hash)
        warn("lights, sky or materials of " + loaded.scene.source);
}

Status run(const Options& options) {
    BakeOptions light;
    LUMEL_TRY_STATUS(options.light.read(light));
    LUMEL_TRY(const Size size, parse_size(options.resolution, "--resolution"));
    LUMEL_TRY_STATUS(check_output(options.output));
    std::optional<LightRecord> bake;
    std::string taken;
    if (!options.baked.empty()) {
        LUMEL_TRY(bake, read_light_record(options.baked));
        LUMEL_TRY(taken, take_light_of_bake(options, *bake, light));
    }
    RunContext run_context(light.threads, options.progress);
    Context& context = run_context.get();
    run_context.interrupt().set_cleaner([&options] { remove_temporaries(options.output); });
    LUMEL_TRY(const LoadedScene loaded, load_lit_scene(options.scene, light, context));
    const Scene& scene = loaded.scene;
    LUMEL_TRY(const WorldGeometry geometry, flatten(scene, context));
    std::optional<BakedLighting> baked;
    if (bake) {
        // Of another scene nothing more is to be said of its light.
        LUMEL_TRY(baked, read_baked(options.baked, scene, geometry));
        if (!taken.empty()) std::fprintf(stderr, "lumel: lit as the bake was: %s\n", taken.c_str());
        warn_of_other_light(*bake, loaded, light, context.diagnostics);
    }
    const SurfaceReader surfaces(scene, geometry);
    const LightSet lights(scene, geometry, surfaces);
    if (lights.empty() && !baked)
        return Error{ErrorCode::invalid_input, "the scene has no light, no emissive surface and no sky", scene.source,
                     "give it a sky, for example --sky 1,1,1, or a sun with --sun-direction"};
    LUMEL_TRY(const std::unique_ptr<Tracer> tracer, make_embree_tracer(geometry, surfaces, context));
    const Transport transport{scene, geometry, surfaces, lights, *tracer};
    LUMEL_TRY(const Camera camera, find_camera(options.camera, transport, context));

    const PathOptions path = transport_options(light);
    PictureOptions picture;
    picture.width = size.width;
    picture.height = size.height;
    picture.samples = light.samples ? light.samples : kUsualSamples;
    std::optional<BakedLight> baked_light;
    if (baked) baked_light = light_of(*baked);
    LUMEL_TRY(const Image image,
              render_picture(transport, path, camera, picture, baked_light ? &*baked_light : nullptr, context));
    LUMEL_TRY_STATUS(write_picture(options.output, image, options.exposure));
    run_context.finish();
    std::printf("%s\n", options.output.c_str());
    return success();
}

}  // namespace

Run add_render(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("SCENE", options->scene, "glTF scene: .glb or .gltf")->required();
    app.add_option("-o,--output", options->output, "Picture: .png (tone-mapped), .exr, .hdr or .pfm (radiance)")
        ->required();
    app.add_option("--camera", options->camera,
                   "Name of a camera, 'view K' of the bake's pictures, or eye;target;vfov_degrees (default: view 0, "
                   "the scene's "
                   "first camera where it has one)")
        ->check(not_empty());
    app.add_option("--baked", options->baked,
                   "Output folder of a bake of this scene: light the view by it (default: path-traced)")
        ->check(not_empty());
    app.add_option("--resolution", options->resolution, "Width x height in pixels")->check(not_empty());
    app.add_option("--exposure", options->exposure, "Factor for .png; 0: automatic")->check(not_negative());
    options->light.declare(app, std::to_string(kUsualSamples));
    declare_progress(app, options->progress);
    return [options] {
        const Status status = run(*options);
        return status.ok() ? static_cast<int>(kDone) : fail(status.error(), "render");
    };
}

}  // namespace lumel::cli
