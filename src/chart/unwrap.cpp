#include "chart/unwrap.h"

#include <functional>
#include <iterator>
#include <memory>
#include <utility>

#include "base/parallel.h"
#include "chart/join.h"
#include "chart/parameterize.h"
#include "chart/segment.h"
#include "chart/t_junctions.h"

namespace lumel {
namespace {

struct Job {
    std::size_t mesh;
    std::vector<std::uint32_t> cluster;
    Parameterized result;
};

// Clusters of all meshes, those of one mesh consecutive.
bool cut_into_clusters(const std::vector<UnwrapMesh>& meshes, const std::function<bool()>& cancelled, Context& context,
                       std::vector<Job>& jobs) {
    std::vector<std::vector<std::vector<std::uint32_t>>> clusters(meshes.size());
    const bool done = parallel_for(
        context, meshes.size(), 1,
        [&](const ChunkRange& range) {
            const UnwrapMesh& m = meshes[range.begin];
            clusters[range.begin] =
                unite_across_t_junctions(*m.mesh, *m.topology, segment(*m.mesh, *m.topology, {}, cancelled));
        },
        "segment");
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (auto& cluster : clusters[m]) jobs.push_back({m, std::move(cluster), {}});
    return done;
}

bool lay_flat(std::vector<UnwrapMesh>& meshes, const std::function<bool()>& cancelled, Context& context,
              std::vector<Job>& jobs) {
    const bool done = parallel_for(
        context, jobs.size(), 16,
        [&](const ChunkRange& range) {
            for (std::size_t j = range.begin; j < range.end; ++j) {
                const UnwrapMesh& m = meshes[jobs[j].mesh];
                jobs[j].result = parameterize(*m.mesh, *m.topology, jobs[j].cluster, {}, cancelled);
            }
        },
        "unwrap");
    for (Job& job : jobs) {
        UnwrapMesh& m = meshes[job.mesh];
        std::move(job.result.charts.begin(), job.result.charts.end(), std::back_inserter(m.charts));
        m.fallbacks += job.result.fallbacks;
    }
    return done;
}

bool join_neighbours(std::vector<UnwrapMesh>& meshes, const std::function<bool()>& cancelled, Context& context) {
    std::vector<std::unique_ptr<ChartJoiner>> joiners(meshes.size());
    if (!parallel_for(context, meshes.size(), 1, [&](const ChunkRange& range) {
            UnwrapMesh& m = meshes[range.begin];
            joiners[range.begin] =
                std::make_unique<ChartJoiner>(*m.mesh, *m.topology, std::move(m.charts), JoinOptions{});
        }))
        return false;
    std::vector<std::pair<std::size_t, std::size_t>> components;  // mesh, component
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (std::size_t c = 0; c < joiners[m]->component_count(); ++c) components.emplace_back(m, c);
    const bool done = parallel_for(
        context, components.size(), 1,
        [&](const ChunkRange& range) {
            const auto [m, c] = components[range.begin];
            joiners[m]->run(c, cancelled);
        },
        "join charts");
    for (std::size_t m = 0; m < meshes.size(); ++m) meshes[m].charts = joiners[m]->take();
    return done;
}

}  // namespace

bool unwrap_meshes(std::vector<UnwrapMesh>& meshes, Context& context) {
    const std::function<bool()> cancelled = [&context] { return context.cancelled(); };
    std::vector<Job> jobs;
    return cut_into_clusters(meshes, cancelled, context, jobs) && lay_flat(meshes, cancelled, context, jobs) &&
           join_neighbours(meshes, cancelled, context) && !context.cancelled();
}

}  // namespace lumel
