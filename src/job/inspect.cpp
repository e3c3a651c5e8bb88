#include "job/inspect.h"

#include <algorithm>
#include <memory>

#include "base/cancelled.h"
#include "base/try.h"
#include "inspect/color_scale.h"
#include "inspect/draw.h"
#include "inspect/gbuffer.h"
#include "io/inspect_writer.h"
#include "io/page_files.h"
#include "job/baked_scene.h"
#include "job/light_layers.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;

// A layer that was asked for: of the g-buffer, or of the files.
struct Wanted {
    TexelLayer layer;
    std::optional<LightLayer> light;
};

Result<Wanted> find_layer(const fs::path& folder, const std::string& name) {
    if (name.find(':') != std::string::npos) {
        LUMEL_TRY(LightLayer light, find_channels(folder, name));
        return Wanted{light.layer, light};
    }
    for (const TexelLayer& layer : gbuffer_layers())
        if (layer.name == name) return Wanted{layer, std::nullopt};
    for (const LightLayer& light : light_layers())
        if (light.layer.name == name) return Wanted{light.layer, light};
    return Error{ErrorCode::usage, "--layer: there is no layer '" + name + "'", {}, "--layer list shows them"};
}

const char* filter_name(ViewFilter filter) {
    switch (filter) {
        case ViewFilter::point: return "point";
        case ViewFilter::bilinear: return "bilinear";
        case ViewFilter::bicubic: return "bicubic";
    }
    return "";
}

class Inspection {
public:
    Inspection(const InspectOptions& options, Context& context) : options_(options), context_(context) {}

    Result<std::vector<std::string>> run(const InspectHooks& hooks) {
        LUMEL_TRY(masters_, list_masters(options_.folder));
        for (const std::string& name : options_.layers) {
            LUMEL_TRY(Wanted wanted, find_layer(options_.folder, name));
            wanted_.push_back(std::move(wanted));
        }
        if (options_.page && *options_.page >= masters_.pages.size())
            return Error{ErrorCode::usage,
                         "--page: there is no page " + std::to_string(*options_.page) + "; the bake has " +
                             std::to_string(masters_.pages.size()),
                         {},
                         "pages count from 0"};
        LUMEL_TRY_STATUS(load());
        LUMEL_TRY(InspectWriter writer, InspectWriter::create(options_.output));
        if (hooks.begun) hooks.begun(writer.cleaner());
        std::vector<InspectedLayer> inspected;
        for (std::size_t i = 0; i < wanted_.size(); ++i) {
            if (context_.cancelled()) return cancelled_error();
            LUMEL_TRY(InspectedLayer layer, draw(wanted_[i], writer));
            inspected.push_back(std::move(layer));
            context_.report("pictures", static_cast<double>(i + 1) / static_cast<double>(wanted_.size()));
        }
        LUMEL_TRY_STATUS(check_unchanged(masters_));
        if (hooks.may_appear && !hooks.may_appear()) return cancelled_error();
        LUMEL_TRY_STATUS(writer.commit(options_.folder, inspected));
        std::vector<std::string> files;
        for (const InspectedLayer& layer : inspected) files.insert(files.end(), layer.files.begin(), layer.files.end());
        return files;
    }

private:
    // What the layers and views need of the scene, and nothing where they need none.
    Status load() {
        for (const MasterFile& master : masters_.pages) {
            LUMEL_TRY(std::vector<Coverage> coverage, read_coverage(master));
            coverage_.push_back(std::move(coverage));
        }
        const bool has_gbuffer = std::ranges::any_of(wanted_, [](const Wanted& w) { return !w.light; });
        if (!has_gbuffer && !options_.cameras) return success();
        LUMEL_TRY(scene_, BakedScene::load(options_.folder, options_.scene, context_));
        if (scene_->atlas().pages.size() != masters_.pages.size())
            return Error{ErrorCode::invalid_input, "describes other pages than charts", masters_.manifest.string(),
                         "bake again"};
        if (has_gbuffer) {
            GBufferNeeds needs;
            for (const Wanted& w : wanted_) {
                if (w.light) continue;
                needs.surface = needs.surface || needs_of(w.layer).surface;
                needs.starts = needs.starts || needs_of(w.layer).starts;
            }
            LUMEL_TRY(gbuffer_, make_gbuffer(layout(), scene_->path_options(), needs, context_));
        }
        if (!options_.cameras) return success();
        const Transport& transport = scene_->transport();
        LUMEL_TRY(const std::vector<Camera> cameras, options_.cameras(transport, context_));
        for (const Camera& camera : cameras) {
            LUMEL_TRY(SeenSurfaces seen, see_surfaces(transport.tracer, transport.geometry, camera, options_.width,
                                                      options_.height, options_.through_backs, context_));
            seen_.push_back(std::move(seen));
        }
        return success();
    }

    [[nodiscard]] BakedLayout layout() const { return {scene_->charts(), scene_->atlas(), scene_->transport()}; }

    Result<std::vector<LayerPage>> read_pages(Wanted& wanted) const {
        std::vector<LayerPage> pages;
        for (std::uint32_t p = 0; p < masters_.pages.size(); ++p) {
            if (wanted.light) {
                LUMEL_TRY(LayerPage page, read_light_layer(*wanted.light, masters_.pages[p], p, coverage_[p]));
                pages.push_back(std::move(page));
            } else {
                if (gbuffer_[p].texels.texel_at.size() != coverage_[p].size())
                    return Error{ErrorCode::invalid_input, "is not the page that the charts lie on",
                                 masters_.pages[p].file.string(), "bake again"};
                pages.push_back(gbuffer_layer(wanted.layer, layout(), gbuffer_[p], coverage_[p]));
            }
            if (!options_.dilation) pages.back().drop_dilated();
        }
        if (wanted.light) choose_rule(pages, wanted.layer);
        return pages;
    }

    Result<InspectedLayer> draw(Wanted& wanted, InspectWriter& writer) const {
        LUMEL_TRY(const std::vector<LayerPage> pages, read_pages(wanted));
        const TexelLayer& layer = wanted.layer;
        const ColorScale scale(layer, pages);
        InspectedLayer out{layer.name,
                           layer.what,
                           layer.unit,
                           layer.channels,
                           double{scale.low()},
                           double{scale.high()},
                           double{scale.exposure()},
                           {}};
        const std::string rings = options_.dilation ? "" : ", dilation off";
        for (std::uint32_t p = 0; p < pages.size(); ++p) {
            if (options_.page && *options_.page != p) continue;
            const InspectedPlace place{false, p};
            const std::string about = "page " + std::to_string(p) + rings;
            LUMEL_TRY_STATUS(writer.picture(out, place, draw_page(layer, pages[p], scale, about)));
            if (options_.values) LUMEL_TRY_STATUS(writer.values(out, place, pages[p].values));
        }
        for (std::uint32_t k = 0; k < seen_.size(); ++k) {
            const Transport& transport = scene_->transport();
            const LayerView view = look_up(layer, pages, transport.scene, transport.geometry, scene_->charts(),
                                           scene_->atlas(), seen_[k], options_.filter);
            const InspectedPlace place{true, k};
            const ViewFilter used = layer.blends() ? options_.filter : ViewFilter::point;
            const std::string about = "view " + std::to_string(k) + ", " + filter_name(used) + " lookup" + rings;
            LUMEL_TRY_STATUS(writer.picture(out, place, draw_view(layer, view, scale, about)));
            if (options_.values) LUMEL_TRY_STATUS(writer.values(out, place, view.values));
        }
        return out;
    }

    const InspectOptions& options_;
    Context& context_;
    MasterList masters_;
    std::vector<Wanted> wanted_;
    std::vector<std::vector<Coverage>> coverage_;  // of each page
    std::unique_ptr<BakedScene> scene_;
    std::vector<GBufferPage> gbuffer_;
    std::vector<SeenSurfaces> seen_;
};

const char* scale_name(ColorRule rule) {
    switch (rule) {
        case ColorRule::category: return "a colour per kind";
        case ColorRule::identity: return "a colour each";
        case ColorRule::share: return "heat, 0 to 1";
        case ColorRule::heat: return "heat, from 0";
        case ColorRule::log_heat: return "heat, logarithmic about the median";
        case ColorRule::reflectance: return "as it looks";
        case ColorRule::light: return "exposed, tone-mapped";
        case ColorRule::around_zero: return "grey is 0";
        case ColorRule::direction: return "red X, green Y, blue Z; grey is 0";
        case ColorRule::place: return "red X, green Y, blue Z within the scene";
    }
    return "";
}

LayerText text_of(const TexelLayer& layer) {
    const std::string unit = layer.unit.empty() || layer.unit == "1" ? "" : " [" + layer.unit + "]";
    return {layer.name, layer.what + unit + "; " + scale_name(layer.rule)};
}

}  // namespace

Result<std::vector<LayerText>> list_layers(const fs::path& folder) {
    LUMEL_TRY(const MasterList masters, list_masters(folder));
    std::vector<LayerText> out;
    for (const TexelLayer& layer : gbuffer_layers()) out.push_back(text_of(layer));
    for (const LightLayer& light : light_layers()) out.push_back(text_of(light.layer));
    for (const std::string& name : all_channels(folder)) out.push_back({name, "channels of the files of the pages"});
    return out;
}

std::size_t count_views(const fs::path& folder) {
    std::size_t count = 0;
    std::error_code ignored;
    while (fs::exists(folder / (kViewStem + std::to_string(count) + ".png"), ignored)) ++count;
    return count;
}

Result<std::vector<std::string>> inspect(const InspectOptions& options, const InspectHooks& hooks, Context& context) {
    return Inspection(options, context).run(hooks);
}

}  // namespace lumel
