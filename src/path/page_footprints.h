// Where the texels of a page gather.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "path/path_integrator.h"
#include "texel/texel_buffer.h"

namespace lumel {

// Borrows all of it.
class PageFootprints : public FootprintSource {
public:
    PageFootprints(const TexelBuffer& texels, const Transport& transport, const ChartSet& charts, const Atlas& atlas)
        : texels_(texels), scene_(transport.scene), geometry_(transport.geometry), charts_(charts), atlas_(atlas) {}
    void read(std::size_t texel, Footprint footprint, const FootprintPart& part, TexelPoints& out) const override {
        texel_points(texels_, texel, scene_, geometry_, charts_, atlas_, footprint, part, out);
    }
    // Where it gathers if nothing is in its way.
    [[nodiscard]] GatherSite site(std::uint32_t i, std::array<SamplePoint, kSamplesPerTexel>& points) const {
        const std::uint32_t n = sample_points(texels_, i, scene_, geometry_, charts_, atlas_, points);
        const std::uint64_t id =
            (std::uint64_t{texels_.page} << 32) | (std::uint64_t{texels_.y[i]} << 16) | texels_.x[i];
        const std::uint32_t first = texels_.first_triangle[i], end = texels_.first_triangle[i + 1];
        return {std::span(points).first(n),
                id,
                texels_.world_size[i],
                texels_.valid[i],
                std::span(&texels_.triangles[first], end - first),
                this,
                i};
    }

private:
    const TexelBuffer& texels_;
    const Scene& scene_;
    const WorldGeometry& geometry_;
    const ChartSet& charts_;
    const Atlas& atlas_;
};

}  // namespace lumel
