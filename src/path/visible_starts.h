// Which sample points of a texel lookups show: not those inside or below a solid, nor those beyond a wall. Points are
// parted into components that see each other along short rays, and the texel takes the light of one of them, however
// thin the wall between. A texel without any is moved out of what it is in.
// Based on: O'Donnell 2018 (validity of sub-texel samples by back faces); the article "Baking artifact-free lightmaps on
// the GPU" (2018), "shadow leaks" (tangential rays, half a texel long, that push a sample out of back faces).
// Different here: components, which need no back faces; rays along the texel's true axes, of which the nearest hit
// decides, whatever their order; and only texels without a visible point are moved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "path/path_integrator.h"
#include "trace/tracer.h"

namespace lumel {

// What became of a texel's points.
enum class StartFate : std::uint8_t {
    all,     // every point counts
    some,    // those of one component
    moved,   // none is visible: one start beside what the texel is in
    hidden,  // none, and nothing near to be moved out of: all stay as they are
};

class VisibleStarts {
public:
    // `rays`, `hits`: scratch memory, 256 or more of each. `enclosed`: bit per start, as of enclosed_points().
    VisibleStarts(const Tracer& tracer, const WorldGeometry& geometry, std::span<Ray> rays, std::span<Hit> hits);

    struct Choice {
        StartFate fate;
        std::size_t count;  // of starts, at the front
    };
    // `starts`: of the points of the site, in their order, or of site.whole. The component with most points that are
    // open: neither enclosed nor where a quarter of the component's rays is void. `hidden` is returned where there is
    // none. `key`: of random directions.
    Choice keep_visible(const GatherSite& site, std::span<SurfaceStart> starts, std::uint64_t enclosed,
                        std::uint32_t key) const;

    // Rays from the start nearest to the texel's centre along its axes and diagonals, as far as lookups blend a texel
    // (one texel): behind the nearest back face that is met first, and from where no more than a quarter of the rays is
    // void, lies the new start, starts[0].
    Choice push_out(const GatherSite& site, std::span<SurfaceStart> starts, std::uint32_t key) const;

private:
    [[nodiscard]] std::uint64_t void_rays(std::span<const SurfaceStart> starts, std::size_t first,
                                          std::uint32_t key) const;
    [[nodiscard]] bool is_open(const SurfaceStart& start, std::uint32_t key) const;
    [[nodiscard]] bool blocked(const GatherSite& site, const Hit& hit) const;

    const Tracer& tracer_;
    const WorldGeometry& geometry_;
    std::span<Ray> rays_;
    std::span<Hit> hits_;
};

// Which of the points of a texel with these valid Hammersley points is nearest to its centre; 0 where it has but one.
std::size_t nearest_to_centre(std::uint64_t valid);

}  // namespace lumel
