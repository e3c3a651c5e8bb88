// Scratch memory of one thread that traces paths.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "path/hemisphere_guide.h"
#include "path/light_statistics.h"
#include "path/path_integrator.h"
#include "path/texel_sink.h"

namespace lumel {

// A texel whose paths are being traced.
struct PathIntegrator::TexelState {
    explicit TexelState(const PathOptions& options) : sink(options) {}

    std::array<SurfaceStart, kSamplesPerTexel> surfaces, back_surfaces;
    std::size_t points = 0;  // of them in use
    std::array<std::uint32_t, 2> half_keys{};
    bool both_sides = false;
    TexelSink sink;
};

// One lane is one path. Arrays are indexed by lane unless they say otherwise.
class PathIntegrator::Workspace {
public:
    struct Vertex {
        Vec3 position;        // on the surface, lifted towards the side the path is on
        Vec3 normal;          // shading normal on that side
        Vec3 face_normal;     // geometric normal on that side; zero at the start of a path, where it does not limit
        Vec3 reflectance;     // albedo / pi
        float direction_pdf;  // solid-angle density with which `direction` was drawn
        Vec3 direction;
        std::uint32_t triangle;  // that it lies on; its own rays cannot hit it
    };
    // A light sample waiting for its shadow ray.
    struct Pending {
        std::uint32_t lane;
        Layer layer;
        Vec3 direction;
        Vec3 value;           // radiance over density, MIS included; times throughput after a bounce
        std::uint32_t group;  // LightSample::group
    };
    // What became of the sample of a local light at the start of a path.
    struct FirstLight {
        std::uint32_t group;  // that a table chose; kNone: none did
        float value;
    };

    std::array<Vertex, kWavefrontLanes> vertex;
    std::array<Vec3, kWavefrontLanes> throughput;
    std::array<Vec3, kWavefrontLanes> bounced;  // light gathered after the first hit, radiance of the first ray
    std::array<Vec3, kWavefrontLanes> first_direction;
    std::array<float, kWavefrontLanes> first_pdf;
    std::array<HemisphereGuide::Draw, kWavefrontLanes> first_draw;
    std::array<float, kWavefrontLanes> first_radiance;  // luminance along the first ray, MIS included
    std::array<float, kWavefrontLanes>
        first_sampled;  // luminance of irradiance by light samples at the start, MIS included
    std::array<FirstLight, kWavefrontLanes> first_light;
    std::array<std::uint32_t, kWavefrontLanes> lanes;  // of the paths still alive
    std::array<Ray, kWavefrontLanes> rays;             // by position in `lanes`
    std::array<Hit, kWavefrontLanes> hits;
    std::array<AlbedoLookup, kWavefrontLanes> albedo;  // at `hits`

    std::vector<Ray> shadow_rays;
    std::vector<Pending> pending;
    std::vector<std::uint8_t> blocked;

    std::array<PathStart, kWavefrontLanes> starts;
    std::array<SurfaceStart, kSamplesPerTexel> surfaces;  // of a cell
    std::array<std::uint8_t, kSamplesPerTexel> sides;
    TexelPoints points;  // of a texel that some of its usual points are hidden of

    std::vector<TexelState> texels;  // those that are gathered together
    GuideStatistics guide_statistics;
    std::optional<HemisphereGuide> guide;
    LightStatistics light_statistics;  // of the texels
    bool learns_lights = false;
    LightRate light_rate;
    LightRateStatistics light_rate_statistics;

    // From the first `count` paths of a wavefront of a texel, which has been traced.
    void learn_of_lights(std::size_t texel, std::size_t count) {
        for (std::size_t lane = 0; lane < count; ++lane) {
            if (first_light[lane].group != kNone)
                light_statistics.add(texel, first_light[lane].group, first_light[lane].value);
            if (light_rate.paths > 1) continue;
            const float cosine = std::max(0.0f, dot(first_direction[lane], starts[lane].normal));
            light_rate_statistics.add(first_sampled[lane], first_radiance[lane] * cosine / first_pdf[lane]);
        }
        light_rate_statistics.end_texel();
    }

    // What was learned of the texels before.
    void forget() {
        guide.reset();
        guide_statistics.clear();
        learns_lights = false;
        light_rate = {};
        light_rate_statistics = {};
    }
};

// Which of n points a sample starts from. Counts that do not fill a whole round of the points leave out others in each
// texel; blocks of a power of two keep the order's even spread.
inline std::size_t point_of(std::uint32_t sample, std::uint32_t key, std::size_t n) {
    return (n == kSamplesPerTexel ? sample ^ key : sample + key) % n;
}

}  // namespace lumel
