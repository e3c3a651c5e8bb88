// Which points of a texel lookups show: not those inside or below a solid, nor those beyond a wall. They are parted
// into components that see each other along short rays, and the texel takes the light of one of them, however thin the
// wall between. Where none is left, PathIntegrator::choose_starts goes on with a wider footprint.
// Based on: O'Donnell 2018 (validity of sub-texel samples by back faces).
// Different here: components, which need no back faces. The article "Baking artifact-free lightmaps on the GPU" (2018)
// pushes points out of the back faces that tangential rays meet; what these find depends on their order and may lie off
// the chart, where no lookup reads the texel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "path/path_integrator.h"
#include "trace/tracer.h"

namespace lumel {

class VisibleStarts {
public:
    // `rays`, `hits`: scratch memory, 256 or more of each.
    VisibleStarts(const Tracer& tracer, const WorldGeometry& geometry, std::span<Ray> rays, std::span<Hit> hits);

    struct Points {
        std::uint64_t valid;                       // TexelPoints::valid
        std::span<const std::uint32_t> triangles;  // TexelPoints::triangles
        float texel_size;                          // metres
        std::uint64_t enclosed = 0;                // bit i: of start i, enclosed_points(); all_open() needs none
    };
    // A quick look: whether all points are open and see each other, as far as a ray from each of 16 of them and one
    // along each row and column of all tell.
    [[nodiscard]] bool all_open(const Points& points, std::span<const SurfaceStart> starts, std::uint32_t key) const;

    struct Found {
        std::uint64_t best = 0;  // bit i: start i is of the component with most open points; none where none has any
        std::uint64_t open = 0;  // all open ones
    };
    // Open are points that are not enclosed, in a component of which less than three in a hundred of the rays (one a
    // point) meet a back within the reach of an enclosure: farther ones are seen from the open. Where there are none, a
    // closer look allows twelve in a hundred. `key`: of random directions.
    [[nodiscard]] Found find(const Points& points, std::span<const SurfaceStart> starts, std::uint32_t key) const;

    // Whether more than half of the rays from these starts meet backs of single-sided surfaces.
    [[nodiscard]] bool is_shut(std::span<const SurfaceStart> starts, std::uint32_t key) const;

private:
    // A ray of each start from `first` on, over its hemisphere, and what it meets: in hits_.
    void look_around(std::span<const SurfaceStart> starts, std::size_t first, std::uint32_t key) const;
    // Whether no ray between the first and last point of a row or column meets anything. `lift`: texels, of the rays.
    [[nodiscard]] bool rows_are_free(const Points& points, std::span<const SurfaceStart> starts, float lift) const;
    class Components;
    [[nodiscard]] Components parted(const Points& points, std::span<const SurfaceStart> starts, float lift) const;
    [[nodiscard]] bool is_single_sided_back(const Hit& hit) const;
    // That, within reach of an enclosure.
    [[nodiscard]] bool is_near_back(const Hit& hit, const Points& points) const;

    const Tracer& tracer_;
    const WorldGeometry& geometry_;
    std::span<Ray> rays_;
    std::span<Hit> hits_;
};

// The part of a footprint around its open points (bits by rank in TexelPoints::valid), where those that were found are
// so few that others should stand for them; nothing where they are many or all around.
std::optional<FootprintPart> part_to_refine(const FootprintPart& part, std::uint64_t valid,
                                            const VisibleStarts::Found& found);

}  // namespace lumel
