// make_charts: which UVs each mesh gets, and the charts made of them.
#include "chart/chart_set.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "base/cancelled.h"
#include "base/check.h"
#include "base/parallel.h"
#include "base/try.h"
#include "chart/atlas_record.h"
#include "chart/bad_charts.h"
#include "chart/charts_of_uv1.h"
#include "chart/kept_layout.h"
#include "chart/mesh_charts.h"
#include "chart/topology.h"
#include "chart/unwrap.h"
#include "chart/uv1.h"
#include "chart/where.h"

namespace lumel {
namespace {

// The meshes that some lightmap instance uses, largest first, so that threads share the work evenly.
struct UsedMeshes {
    std::vector<std::uint32_t> meshes;    // indices into Scene::meshes
    std::vector<std::uint32_t> instance;  // per mesh of the scene: the first lightmap instance, for messages
    std::uint32_t repeated = kNone;       // a lightmap instance whose mesh an earlier one has
};

UsedMeshes used_meshes(const Scene& scene) {
    UsedMeshes used;
    used.instance.assign(scene.meshes.size(), kNone);
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
        if (scene.instances[i].node_class != NodeClass::lightmap) continue;
        std::uint32_t& first = used.instance[scene.instances[i].mesh];
        if (first != kNone) {
            if (used.repeated == kNone) used.repeated = i;
        } else {
            first = i;
            used.meshes.push_back(scene.instances[i].mesh);
        }
    }
    std::sort(used.meshes.begin(), used.meshes.end(), [&](std::uint32_t a, std::uint32_t b) {
        const std::size_t na = scene.meshes[a]->triangles.size(), nb = scene.meshes[b]->triangles.size();
        return na != nb ? na > nb : a < b;
    });
    return used;
}

// Some of what a diagnostic counts, in words.
struct Findings {
    std::vector<std::string> examples;
    std::uint64_t count = 0;
};

class ChartMaker {
public:
    ChartMaker(const Scene& scene, const WorldGeometry& geometry, const ChartOptions& options, Context& context)
        : scene_(scene),
          geometry_(geometry),
          options_(options),
          context_(context),
          used_(used_meshes(scene)),
          topology_(scene.meshes.size()) {
        charts_.meshes.resize(scene.meshes.size());
    }

    Result<ChartSet> run() {
        LUMEL_TRY(const std::vector<std::uint32_t> own, keep_uv1());
        if (charts_.scene_wide) return std::move(charts_);
        if (!unwrap(own)) return cancelled_error();
        demote_bad_charts(scene_, options_, charts_, context_.diagnostics);
        return std::move(charts_);
    }

    Result<ChartSet> run_uv1_alone() {
        LUMEL_TRY_STATUS(keep_uv1());
        return std::move(charts_);
    }

private:
    // The meshes that get charts of our own.
    Result<std::vector<std::uint32_t>> keep_uv1() {
        if (!build_topologies()) return cancelled_error();
        LUMEL_TRY(const bool kept, keep_scene_wide());
        std::vector<std::uint32_t> own;
        if (!kept && !keep_mesh_layouts(own)) return cancelled_error();
        return own;
    }

    [[nodiscard]] const Mesh& mesh(std::uint32_t m) const { return *scene_.meshes[m]; }

    bool build_topologies() {
        return parallel_for(context_, used_.meshes.size(), 1, [&](const ChunkRange& range) {
            const std::uint32_t m = used_.meshes[range.begin];
            topology_[m] = build_topology(mesh(m));
        });
    }

    // ---- One layout for the scene -----------------------------------------------------------------------------------

    // Keeps TEXCOORD_1 of the whole scene as one atlas where that was asked or is possible.
    Result<bool> keep_scene_wide() {
        if (options_.uv1 == Uv1Policy::mesh || options_.uv1 == Uv1Policy::ignore || used_.meshes.empty()) return false;
        const bool asked = options_.uv1 == Uv1Policy::scene;
        if (options_.masks != MaskRule{}) {
            if (!asked)
                return no_atlas("unchanged it would not keep charts apart under the --filter, --mips or --block asked");
            return Error{ErrorCode::usage,
                         "--uv1 scene keeps TEXCOORD_1 as it is, and cannot keep charts apart under --filter bicubic, "
                         "--mips or --block",
                         scene_.source, "use --uv1 mesh or ignore, or leave these options out"};
        }
        for (const std::uint32_t m : used_.meshes) {
            const std::string reason = judge_uv1_coordinates(mesh(m), topology_[m].area);
            if (reason.empty()) continue;
            if (!asked) return no_atlas(node_and_mesh(scene_, used_.instance[m]) + ": " + reason);
            return Error{
                ErrorCode::usage, "--uv1 scene: TEXCOORD_1 cannot be kept as one atlas of the scene: " + reason,
                scene_.source + ": " + node_and_mesh(scene_, used_.instance[m]), "use --uv1 mesh or --uv1 ignore"};
        }
        if (used_.repeated != kNone && !asked)  // would overlap itself: no need to search
            return no_atlas(node_and_mesh(scene_, used_.repeated) + " shares its mesh with another node");
        const std::vector<UvOverlap> overlaps = scene_overlaps();
        if (!overlaps.empty() && !asked) {
            const std::vector<UvOverlap> between = between_nodes(overlaps);
            not_an_atlas_ = findings(between.empty() ? overlaps : between);
            return false;
        }
        report_overlaps(
            "pairs of triangles overlap in TEXCOORD_1, which was kept as asked: they share texels, which "
            "hold the light of both; use --uv1 mesh or --uv1 ignore, or lay them out anew",
            overlaps);
        for (const std::uint32_t m : used_.meshes) charts_.meshes[m] = uv1_islands(mesh(m), topology_[m].area, 1.0f);
        charts_.scene_wide = true;
        if (options_.previous) LUMEL_TRY_STATUS(check_record(*options_.previous, charts_, options_));
        const AtlasPage page = kept_page(scene_, geometry_, charts_, options_);
        const std::vector<ChartContact> contacts = find_contacts(scene_, geometry_, charts_, page);
        merge_contacts(scene_, contacts, charts_);
        report_bleeding(scene_, contacts, page, context_.diagnostics);
        return true;
    }

    bool no_atlas(std::string why) {
        not_an_atlas_ = {{std::move(why)}, 1};
        return false;
    }

    // Overlapping pairs over all lightmap instances.
    [[nodiscard]] std::vector<UvOverlap> scene_overlaps() const {
        std::vector<UvTriangle> uv;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> from;  // instance, triangle
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
            if (scene_.instances[i].node_class != NodeClass::lightmap) continue;
            const std::uint32_t m = scene_.instances[i].mesh;
            const std::vector<UvTriangle> triangles = uv1_triangles(mesh(m));
            for (std::uint32_t t = 0; t < triangles.size(); ++t) {
                if (topology_[m].area[t] == 0.0) continue;
                uv.push_back(triangles[t]);
                from.emplace_back(i, t);
            }
        }
        std::vector<UvOverlap> overlaps;
        for (const auto& [a, b] : find_overlaps(uv, uv1_tolerance(), kMaxOverlaps).pairs)
            overlaps.push_back({from[a].first, from[a].second, from[b].first, from[b].second});
        return overlaps;
    }

    [[nodiscard]] static std::vector<UvOverlap> between_nodes(std::vector<UvOverlap> overlaps) {
        std::erase_if(overlaps, [](const UvOverlap& o) { return o.instance_a == o.instance_b; });
        return overlaps;
    }

    // Pairs in words, as many as a report shows: the first pair of each two nodes before all others, to tell of all.
    [[nodiscard]] Findings findings(const std::vector<UvOverlap>& overlaps) const {
        std::set<std::pair<std::uint32_t, std::uint32_t>> met;
        std::vector<const UvOverlap*> firsts, others;
        for (const UvOverlap& o : overlaps) {
            const bool is_first = met.emplace(o.instance_a, o.instance_b).second;
            (is_first ? firsts : others).push_back(&o);
        }
        firsts.insert(firsts.end(), others.begin(), others.end());
        Findings out;
        out.count = firsts.size();
        for (std::size_t k = 0; k < std::min(firsts.size(), Diagnostics::kMaxExamples); ++k)
            out.examples.push_back(overlap_text(*firsts[k]));
        return out;
    }

    [[nodiscard]] std::string overlap_text(const UvOverlap& o) const {
        const auto corners = [&](std::uint32_t instance, std::uint32_t t) {
            const Mesh& m = mesh(scene_.instances[instance].mesh);
            const Triangle& v = m.triangles[t];
            return UvTriangle{m.uv1[v[0]], m.uv1[v[1]], m.uv1[v[2]]};
        };
        const Vec2 where = overlap_centre(corners(o.instance_a, o.triangle_a), corners(o.instance_b, o.triangle_b));
        const std::string a = std::to_string(o.triangle_a), b = std::to_string(o.triangle_b);
        const std::string at = " at UV " + uv_text(where);
        if (o.instance_a == o.instance_b)
            return node_and_mesh(scene_, o.instance_a) + " triangles " + a + " and " + b + at;
        return node_and_mesh(scene_, o.instance_a) + " triangle " + a + " and " + node_and_mesh(scene_, o.instance_b) +
               " triangle " + b + at;
    }

    void report_overlaps(const char* message, const std::vector<UvOverlap>& overlaps) {
        report("uv-overlap", message, findings(overlaps));
    }

    void report(const char* code, const char* message, const Findings& findings) {
        for (const std::string& example : findings.examples) context_.diagnostics.add(code, message, example);
        const std::uint64_t more = findings.count - findings.examples.size();
        if (more > 0) context_.diagnostics.add(code, message, "", more);
    }

    // ---- One layout per mesh ----------------------------------------------------------------------------------------

    // Meshes whose TEXCOORD_1 is fit keep its islands; the others are listed in `own`. Where that was asked, overlaps
    // are no reason: islands on top of each other are packed apart. False: cancelled.
    bool keep_mesh_layouts(std::vector<std::uint32_t>& own) {
        if (options_.uv1 == Uv1Policy::ignore) {
            own = used_.meshes;
            return true;
        }
        const bool asked = options_.uv1 == Uv1Policy::mesh;
        std::vector<Uv1Verdict> verdicts(scene_.meshes.size());
        const bool done = parallel_for(context_, used_.meshes.size(), 1, [&](const ChunkRange& range) {
            const std::uint32_t m = used_.meshes[range.begin];
            const std::vector<double>& areas = topology_[m].area;
            verdicts[m] = judge_uv1(mesh(m), areas);
            if (verdicts[m].fit() || (asked && !verdicts[m].overlaps.empty()))
                charts_.meshes[m] = uv1_islands(mesh(m), areas, static_cast<float>(uv1_scale(mesh(m), areas)));
        });
        if (!done) return false;
        std::vector<UvOverlap> rejected, kept;
        bool any_kept = false;
        for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m) {
            const std::uint32_t i = used_.instance[m];
            if (i == kNone) continue;
            const bool keeps = charts_.meshes[m].from_uv1;
            any_kept |= keeps;
            for (const auto& [a, b] : verdicts[m].overlaps) (keeps ? kept : rejected).push_back({i, a, i, b});
            if (!keeps && !mesh(m).uv1.empty())
                context_.diagnostics.add("uv1-rejected",
                                         "TEXCOORD_1 is not fit for a lightmap; charts were made instead",
                                         node_and_mesh(scene_, i) + ": " + verdicts[m].reason);
        }
        for (const std::uint32_t m : used_.meshes)
            if (!charts_.meshes[m].from_uv1) own.push_back(m);
        report_overlaps("pairs of triangles overlap in TEXCOORD_1; charts were made for these meshes", rejected);
        report_overlaps(
            "pairs of triangles overlap in TEXCOORD_1, which was kept as asked: charts were packed apart, "
            "but triangles of one chart share texels, which hold the light of both",
            kept);
        if (any_kept)
            report("uv1-repacked",
                   "TEXCOORD_1 was not kept as one atlas of the scene; where it is fit the charts of a mesh were kept, "
                   "and all were packed anew",
                   not_an_atlas_);
        return true;
    }

    // ---- Charts of our own ------------------------------------------------------------------------------------------

    bool unwrap(const std::vector<std::uint32_t>& own) {
        std::vector<UnwrapMesh> meshes;
        meshes.reserve(own.size());
        for (const std::uint32_t m : own) meshes.push_back({&mesh(m), &topology_[m], {}, 0});
        if (!unwrap_meshes(meshes, context_)) return false;
        for (std::size_t k = 0; k < own.size(); ++k) {
            charts_.meshes[own[k]] = assemble_charts(mesh(own[k]).triangles.size(), std::move(meshes[k].charts));
            if (meshes[k].fallbacks > 0)
                context_.diagnostics.add("unwrap-fallback", "clusters were cut by the sides of a box, as no map fitted",
                                         node_and_mesh(scene_, used_.instance[own[k]]), meshes[k].fallbacks);
        }
        return true;
    }

    const Scene& scene_;
    const WorldGeometry& geometry_;
    const ChartOptions& options_;
    Context& context_;
    UsedMeshes used_;
    std::vector<MeshTopology> topology_;
    ChartSet charts_;
    Findings not_an_atlas_;  // why TEXCOORD_1 was not kept as one atlas of the scene
};

}  // namespace

Result<ChartSet> make_charts(const Scene& scene, const WorldGeometry& geometry, const ChartOptions& options,
                             Context& context) {
    return ChartMaker(scene, geometry, options, context).run();
}

Result<ChartSet> charts_of_uv1(const Scene& scene, const WorldGeometry& geometry, const ChartOptions& options,
                               Context& context) {
    return ChartMaker(scene, geometry, options, context).run_uv1_alone();
}

}  // namespace lumel
