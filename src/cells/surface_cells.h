// Surface cells: a radiance cache on the charts. The texels of a coarse atlas of the same charts are the cells, front
// and back of double-sided surfaces apart; each knows the irradiance that it receives, all bounces included. Paths that
// reach one end there.
//
// A cell belongs to a chart and a side, never to a place alone: a wall 0.3 m thick would pass light through cells keyed
// by position. Inside a cell all points see each other, and it lends its light to a neighbour only where the two see
// each other; what does not (a cell that a wall stands on) is no cell, and paths go on there.
// Based on: Martin and Einarsson 2010, "A Real-Time Radiosity Architecture for Video Games" (bounces by iterating links
// that were traced once); Jensen 1996, "Global Illumination using Photon Maps" (a final gather of one ray into a coarse
// solution). Different here: the solution is a coarse bake of the same charts, and its grain follows the samples.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "chart/chart_set.h"
#include "lumel/context.h"
#include "lumel/result.h"
#include "texel/texel_buffer.h"
#include "trace/tracer.h"

namespace lumel {

// Of what arrives at a cell, the share `weight` of the irradiance of another.
struct CellLink {
    static constexpr float kOne = 32768.0f;  // of `weight`
    std::uint32_t from = kNone;              // kNone: no link
    std::array<std::uint16_t, 3> weight{};   // up to 2
};

// The paths of a cell in groups, each evenly spread for itself: what they differ by tells the noise of all.
inline constexpr std::size_t kCellGroups = 8;
inline std::size_t cell_group(std::size_t path, std::size_t paths) { return path * kCellGroups / paths; }

// What a cell gathered by paths of its own, apart from its links: light that reached it without another cell.
struct CellGather {
    Vec3 direct{};           // mean over the paths traced
    std::uint32_t open = 0;  // paths that meet no back of a single-sided surface first
    std::uint32_t traced = 0;
    std::array<Vec3, kCellGroups> direct_of_group{};  // as `direct`, over the paths of each group
};

class SurfaceCells {
public:
    // Lays out the cells and tests who sees whom. `texels_per_cell`: edge of a cell in texels of `atlas`, that of
    // the bake. Progress: stage "cells". Error: cancelled.
    static Result<SurfaceCells> make(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                                     const Atlas& atlas, const Tracer& tracer, double texels_per_cell,
                                     Context& context);

    // Fronts first, then the backs of double-sided ones.
    [[nodiscard]] std::size_t size() const { return usable_.size(); }

    // Where a point lies among the cells.
    struct Place {
        std::uint32_t home = kNone;  // the cell around it; kNone: nothing is known there
        std::uint32_t page = 0, placement = kNone;
        std::int32_t x = 0, y = 0;  // of the cell, in texels of the page
        Vec2 offset{};              // from the cell's middle, in cells: -0.5 .. 0.5
        bool back = false;
    };
    [[nodiscard]] Place find(std::uint32_t triangle, float b1, float b2, bool back_face) const;
    // Light there, by the four nearest cells, of those that home sees, with the shares of bilinear interpolation. As
    // irradiance(cell); `place.home` is not kNone.
    [[nodiscard]] Vec3 irradiance(const Place& place) const;
    // One of them; with `jitter` even in [0, 1)^2 in those shares.
    [[nodiscard]] std::uint32_t pick(const Place& place, Vec2 jitter) const;

    // Metres across a cell.
    [[nodiscard]] float edge(std::uint32_t cell) const { return site(cell).edge; }
    // I = E/pi about the vertex normal, W/(m^2 sr), all light that the bounces carry.
    [[nodiscard]] Vec3 irradiance(std::uint32_t cell) const { return irradiance_[cell]; }

    // Of what a surface at that place gathers from cells: the variance of I that their own noise puts there, the same
    // into all that gather around it. At least what it is on average, in proportion to the light. `place.home` is not
    // kNone.
    [[nodiscard]] Vec3 noise(const Place& place) const;
    // That average: variance over the square of what is gathered from cells.
    [[nodiscard]] Vec3 relative_noise() const { return relative_noise_; }

    // Where a cell gathers: its sample points; nothing of cells that are not usable. Returns how many.
    std::uint32_t sample_points(std::uint32_t cell, const Scene& scene, const WorldGeometry& geometry,
                                const ChartSet& charts, std::span<SamplePoint, kSamplesPerTexel> out) const;
    [[nodiscard]] bool is_back(std::uint32_t cell) const { return cell >= sites_.size(); }
    [[nodiscard]] bool usable(std::uint32_t cell) const { return usable_[cell] != 0; }

    // Sets the irradiance from what all cells gathered: `gathers` of each, `links` as many for each. Bounces are
    // iterations over the links, at no ray, until no cell changes by more than 1e-5. Cells most of whose paths met the
    // backs of surfaces become unusable. Then the noise, by what each group of paths alone would change.
    // Progress: stage "cells". Error: cancelled.
    Status solve(std::span<const CellGather> gathers, std::span<const CellLink> links, std::uint32_t bounces,
                 Context& context);

    // Lets go of what only gathering needs. No sample_points() after it.
    void drop_sites();

private:
    struct Site {
        std::uint32_t page = 0, texel = 0;
        float edge = 0.0f;
        std::uint32_t back = kNone;  // cell of the back
    };
    struct Corners {
        std::array<Vec2, 3> uv{};  // in texels of the cells' page
        std::uint32_t page = kNone;
        std::uint32_t placement = kNone;
    };

    [[nodiscard]] const Site& site(std::uint32_t cell) const {
        return sites_[is_back(cell) ? front_of_[cell - sites_.size()] : cell];
    }
    // Of all four cells around a place, in the shares of bilinear interpolation.
    [[nodiscard]] Vec3 interpolate(std::span<const Vec3> values, const Place& place) const;
    bool find_noise(std::span<const CellGather> gathers, std::span<const CellLink> links, std::uint32_t bounces,
                    Context& context);
    // The front cell at a texel of a page, if it belongs to that chart; else kNone.
    [[nodiscard]] std::uint32_t front_at(std::uint32_t page, std::int32_t x, std::int32_t y,
                                         std::uint32_t placement) const;
    // The cell so many steps from home; home where they do not see each other.
    [[nodiscard]] std::uint32_t seen_from(const Place& place, std::int32_t dx, std::int32_t dy) const;
    void lay_out(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts);
    Status rasterize(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts, Context& context);
    // Metres from the surface to where a cell is looked at from.
    [[nodiscard]] float lift_of(std::uint32_t cell) const;
    // The points that look at each other, one per cell. False, as below: cancelled.
    bool find_middles(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                      std::vector<Vec3>& middles, Context& context) const;
    bool find_visibility(const Scene& scene, const WorldGeometry& geometry, const ChartSet& charts,
                         const Tracer& tracer, std::span<const Vec3> middles, Context& context);

    Atlas atlas_;
    std::vector<TexelBuffer> pages_;
    std::vector<std::uint32_t> first_cell_;  // per page
    std::vector<Site> sites_;                // of fronts
    std::vector<std::uint32_t> front_of_;    // of backs
    std::vector<Corners> triangles_;         // per world triangle
    std::vector<std::uint8_t> usable_;
    std::vector<std::uint8_t> open_;  // bit per neighbour: the two see each other
    std::vector<Vec3> irradiance_, noise_;
    Vec3 relative_noise_{};
};

}  // namespace lumel
