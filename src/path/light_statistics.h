// Which local lights reach a few neighbouring texels, and how strongly: a table of their groups, learned from the
// texels' own samples, that later samples choose by. A tree knows how bright and how near lights are but not what
// stands in their way; in a building nearly all lights are behind walls.
//
// Based on: Conty Estevez, Kulla 2018 (the tree, which is the prior); Vévoda, Kondapaneni, Křivánek 2018, "Bayesian
// online regression for adaptive direct illumination sampling" (regions of the scene learn from their samples, with the
// tree's estimate as prior; the root of the second moment). Different here: each texel has the tree's estimate for
// itself, and the block learns one factor for each group, most of it visibility; and the prior stays in the mixture, so
// that a light that only some of the texels see is still found. A texel's estimate is for all its points together: a
// light that reaches any of them (the rim of a spot's cone, the end of a range, a curved surface's horizon) has a
// share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/light_set.h"
#include "light/light_table.h"

namespace lumel {

class LightStatistics {
public:
    // Forgets all, and asks the tree what each texel can expect of each group. Without groups there is nothing to
    // learn, and no table.
    void begin(const LightSet& lights, std::span<const ReceiverRegion> texels);

    // How often a texel's samples choose each group; null where the tree knows that no light reaches it.
    [[nodiscard]] const LightTable* table(std::size_t texel) const {
        return texel < tables_.size() && !tables_[texel].ends.empty() ? &tables_[texel] : nullptr;
    }

    // A sample of the texel that chose `group` by its table and brought `value` (what it adds to the estimate; 0:
    // blocked).
    void add(std::size_t texel, std::uint32_t group, float value);

    // Makes all tables anew, by all that is known.
    void learn();

private:
    struct Group {
        double squares = 0.0;      // of what the group brought, by one sample each
        double expected = 0.0;     // squares of what the tree expected of these
        double mean_square = 0.0;  // of what it expects, over the texels
        std::uint32_t guaranteed = 0;
    };
    [[nodiscard]] const float* expected(std::size_t texel) const { return &expected_[texel * groups_.size()]; }
    void make_table(std::size_t texel, std::span<const double> factors);

    std::vector<Group> groups_;
    std::vector<float> expected_;  // by texel, then group: the tree's importance, of all groups together 1
    std::vector<LightTable> tables_;
    double sum_ = 0.0;
    std::uint64_t samples_ = 0;
};

}  // namespace lumel
