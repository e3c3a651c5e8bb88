// How near the bake comes to the speed of its ray tracer: some texels of a scene are gathered with a tracer that keeps
// every batch; then the batches are traced again, alone. One thread, CPU time.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "bench.h"
#include "bench_scene.h"
#include "light/light_set.h"
#include "load.h"
#include "path/gather_page.h"
#include "path/light_cells.h"

namespace lumel::bench {
namespace {

// Passes queries on and keeps their rays. Not thread-safe.
class RecordingTracer final : public Tracer {
public:
    explicit RecordingTracer(const Tracer& tracer) : tracer_(tracer) {}

    void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
        keep(rays, true);
        tracer_.closest(rays, hits);
    }
    void occluded(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const override {
        keep(rays, false);
        tracer_.occluded(rays, blocked);
    }
    [[nodiscard]] TraceStatistics statistics() const override { return tracer_.statistics(); }
    [[nodiscard]] std::string_view description() const override { return tracer_.description(); }

    [[nodiscard]] std::size_t ray_count() const { return rays_.size(); }
    [[nodiscard]] std::size_t batch_count() const { return batches_.size(); }

    void replay() const {
        std::vector<Hit> hits;
        std::vector<std::uint8_t> blocked;
        std::size_t first = 0;
        for (const Batch& batch : batches_) {
            const auto rays = std::span(rays_).subspan(first, batch.count);
            hits.resize(std::max(hits.size(), rays.size()));
            blocked.resize(hits.size());
            if (batch.closest) {
                tracer_.closest(rays, std::span(hits).first(rays.size()));
            } else {
                tracer_.occluded(rays, std::span(blocked).first(rays.size()));
            }
            first += batch.count;
        }
    }

private:
    struct Batch {
        std::size_t count;
        bool closest;
    };
    void keep(std::span<const Ray> rays, bool closest) const {
        rays_.insert(rays_.end(), rays.begin(), rays.end());
        batches_.push_back({rays.size(), closest});
    }

    const Tracer& tracer_;
    mutable std::vector<Ray> rays_;
    mutable std::vector<Batch> batches_;
};

double median(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

struct Options {
    std::string scene;
    std::uint32_t texels = 2000, samples = 256;
    int repeats = 7;
};

struct Shares {
    double rays, batches, bake_seconds, replay_seconds, share;
};

// `gather(tracer)` is the bake. By turns, and the median of the pairs' shares: the machine's other work hits both of a
// pair alike.
template <class Gather>
Shares measure(const Tracer& tracer, int repeats, Gather&& gather) {
    const RecordingTracer recorder(tracer);
    gather(recorder);
    std::vector<double> bakes, replays, shares;
    for (int i = 0; i < repeats; ++i) {
        const CpuStopwatch bake_time;
        gather(tracer);
        bakes.push_back(bake_time.seconds());
        const CpuStopwatch replay_time;
        recorder.replay();
        replays.push_back(replay_time.seconds());
        shares.push_back(replays.back() / bakes.back());
    }
    return {static_cast<double>(recorder.ray_count()), static_cast<double>(recorder.batch_count()), median(bakes),
            median(replays), median(shares)};
}

// As `lumel bake` gathers, to the cells by default and to the end; lighting the cells is not part of it.
void run_replay(const Options& options) {
    Context context(1);
    const BenchScene bench(options.scene, {}, context);
    const LightSet lights(bench.scene, bench.geometry, bench.surfaces);
    const TexelBuffer& texels = bench.texels;
    const TexelBlocks blocks = spread_blocks(make_texel_blocks(texels, 0, texels.size()), options.texels);
    PathOptions path;
    path.samples = options.samples;
    path.ao_distance = bench.ao_distance();
    const Transport to_the_end{bench.scene, bench.geometry, bench.surfaces, lights, *bench.tracer};
    const SurfaceCells cells = need(make_lit_cells(bench.charts, bench.atlas, to_the_end, path, context));
    std::printf(
        "scene,integrator,texels,samples,rays,rays_per_batch,bake_mrays_per_cpu_second,replay_mrays_per_cpu_second,"
        "share\n");
    for (const bool to_cells : {true, false}) {
        path.guided = path.lights_learned = to_cells;
        const Shares s = measure(*bench.tracer, options.repeats, [&](const Tracer& with) {
            const Transport transport{bench.scene, bench.geometry, bench.surfaces,
                                      lights,      with,           to_cells ? &cells : nullptr};
            need(gather_blocks(blocks, texels, bench.charts, bench.atlas, transport, path, context));
        });
        std::printf("%s,%s,%zu,%u,%.0f,%.1f,%.3f,%.3f,%.3f\n", bench.name.c_str(), to_cells ? "cells" : "paths",
                    blocks.texels.size(), options.samples, s.rays, s.rays / s.batches, 1e-6 * s.rays / s.bake_seconds,
                    1e-6 * s.rays / s.replay_seconds, s.share);
    }
}

}  // namespace

void add_replay(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("replay", "The bake's rays per second against a replay of the same rays");
    command->add_option("scene", options->scene, ".glb or .gltf")->required()->check(CLI::ExistingFile);
    command->add_option("--texels", options->texels, "About so many, in blocks from all over page 0")
        ->check(CLI::Range(1u, 1u << 20));
    command->add_option("--samples", options->samples, "Per texel")->check(CLI::Range(1u, 1u << 16));
    command->add_option("--repeats", options->repeats, "The median of so many is printed")->check(CLI::Range(1, 100));
    command->callback([options] { run_replay(*options); });
}

}  // namespace lumel::bench
