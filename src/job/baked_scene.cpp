#include "job/baked_scene.h"

#include "bake/chart_options.h"
#include "base/try.h"
#include "io/baked.h"
#include "io/light_record.h"
#include "io/page_files.h"
#include "scene/world_geometry.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSayWhere = "say where the scene that was baked is with --scene FILE";

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

Result<fs::path> find_source(const BakeRecord& record, const fs::path& given) {
    const std::string manifest = (record.folder / kManifestFile).string();
    const fs::path source = given.empty() ? record.source : given;
    if (source.empty())
        return Error{ErrorCode::io, "does not say where the scene is: an older lumel wrote it", manifest, kSayWhere};
    if (!is_there(source))
        return Error{ErrorCode::io, "the scene that was baked is not there any more", source.string(), kSayWhere};
    return source;
}

// What of the options lit the bake.
BakeOptions light_of(const LightRecord& light) {
    BakeOptions out;
    out.sky = light.sky;
    out.sun = light.sun;
    out.include = light.include;
    out.direct_scale = light.direct_scale;
    out.indirect_scale = light.indirect_scale;
    return out;
}

// Of the scene itself the bake has warned already.
class Unwarned {
public:
    explicit Unwarned(Diagnostics& diagnostics) : diagnostics_(diagnostics), before_(diagnostics) {}
    ~Unwarned() { diagnostics_ = before_; }
    Unwarned(const Unwarned&) = delete;
    Unwarned& operator=(const Unwarned&) = delete;

private:
    Diagnostics& diagnostics_;
    Diagnostics before_;
};

// Which nodes are of class volume because their charts were bad depends on the density that was asked for: the layout
// tells, for they have no place in it.
std::vector<bool> demoted_in(const BakeRecord& record, const Scene& scene, const ChartSet& charts) {
    const std::vector<std::uint32_t>& first = record.layout.first_placement;
    std::vector<bool> out(scene.instances.size());
    if (first.size() != scene.instances.size() + 1) return out;  // of another scene, as check_charts() will say
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const bool has_charts = !charts.meshes[scene.instances[i].mesh].charts.empty();
        out[i] = scene.instances[i].node_class == NodeClass::lightmap && has_charts && first[i] == first[i + 1];
    }
    return out;
}

}  // namespace

BakedScene::BakedScene(BakeRecord record, LoadedScene loaded, WorldGeometry geometry)
    : record_(std::move(record)), loaded_(std::move(loaded)), geometry_(std::move(geometry)) {}

PathOptions BakedScene::path_options() const {
    PathOptions out = transport_options(record_.options);
    out.samples = record_.options.samples;
    out.two_sided = record_.options.two_sided;
    return out;
}

Result<std::unique_ptr<BakedScene>> BakedScene::load(const fs::path& folder, const fs::path& source, Context& context) {
    const Unwarned unwarned(context.diagnostics);
    LUMEL_TRY(BakeRecord record, read_bake_record(folder));
    LUMEL_TRY(const LightRecord light, read_light_record(folder));
    LUMEL_TRY(const fs::path file, find_source(record, source));
    if (!light.sky.file.empty() && !is_there(light.sky.file))
        return Error{ErrorCode::io, "the sky map that lit the bake is not there any more", light.sky.file,
                     "put it back, or bake again"};
    LUMEL_TRY(LoadedScene loaded, load_lit_scene(file, light_of(light), context));
    LUMEL_TRY(WorldGeometry geometry, flatten(loaded.scene, context));
    const std::string remedy = "give the scene that was baked, with the same sidecar, by --scene FILE, or bake again";
    if (hash_geometry(geometry) != record.geometry_hash)
        return Error{ErrorCode::invalid_input, "its geometry is not what " + folder.string() + " was baked from",
                     file.string(), remedy};
    if (hash_scene(loaded.scene).hex() != light.input_hash)
        return Error{ErrorCode::invalid_input,
                     "its materials, lights or sky are not what " + folder.string() + " was baked from", file.string(),
                     remedy};
    std::unique_ptr<BakedScene> out(new BakedScene(std::move(record), std::move(loaded), std::move(geometry)));
    const Scene& scene = out->loaded_.scene;
    LUMEL_TRY(out->charts_, make_charts(scene, out->geometry_, chart_options(out->record_.options), context));
    out->charts_.demoted = demoted_in(out->record_, scene, out->charts_);
    LUMEL_TRY_STATUS(check_charts(out->record_, scene, out->charts_));
    LUMEL_TRY(out->tracer_, make_embree_tracer(out->geometry_, out->surfaces_, context));
    out->transport_.emplace(Transport{scene, out->geometry_, out->surfaces_, out->lights_, *out->tracer_});
    return out;
}

}  // namespace lumel
