// The scene of a finished bake as it was when it was baked: lit, charted and laid out the same, ready for rays.
#pragma once

#include <memory>
#include <optional>

#include "chart/chart_set.h"
#include "io/bake_record.h"
#include "light/light_set.h"
#include "lumel/load.h"
#include "path/path_integrator.h"
#include "trace/tracer.h"

namespace lumel {

class BakedScene {
public:
    // From the file that the manifest names, or `source` where that is not empty; lit as the manifest says. Errors: io,
    // where the scene or its sky map is not there any more; invalid_input where they are not those that were baked, and
    // those of load_scene. What the scene itself is warned of, the bake has said.
    static Result<std::unique_ptr<BakedScene>> load(const std::filesystem::path& folder,
                                                    const std::filesystem::path& source, Context& context);
    BakedScene(const BakedScene&) = delete;  // its members point at each other
    BakedScene& operator=(const BakedScene&) = delete;

    [[nodiscard]] const Transport& transport() const { return *transport_; }
    [[nodiscard]] const ChartSet& charts() const { return charts_; }
    [[nodiscard]] const Atlas& atlas() const { return record_.layout; }
    // Of the bake's paths: what decides where they start.
    [[nodiscard]] PathOptions path_options() const;

private:
    BakedScene(BakeRecord record, LoadedScene loaded, WorldGeometry geometry);

    BakeRecord record_;
    LoadedScene loaded_;
    WorldGeometry geometry_;
    SurfaceReader surfaces_{loaded_.scene, geometry_};
    LightSet lights_{loaded_.scene, geometry_, surfaces_};
    std::unique_ptr<Tracer> tracer_;
    ChartSet charts_;
    std::optional<Transport> transport_;
};

}  // namespace lumel
