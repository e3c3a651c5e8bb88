// Fills one page with as many charts as fit, as densely as can be: the large charts first, then the tiny ones into what
// they left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "lumel/context.h"
#include "pack/mask.h"
#include "pack/page_work.h"

namespace lumel {

enum class Orientations : std::uint8_t {
    automatic,  // all of tiny charts, and of large ones where the charts are so few that it helps
    one,        // none is turned
    eight,      // all of all charts but those that are not worth it: see worth_turning() in page_work.h
};

// Lies on the page and stays there.
struct FixedMask {
    std::uint32_t mask = 0, x = 0, y = 0;  // into the masks; top left corner
};

struct FillOptions {
    std::uint32_t width = 0;   // texels, 1 .. FreeMap::kMaxWidth
    std::uint32_t height = 0;  // most rows; 0: as many as it takes
    Orientations orientations = Orientations::automatic;
    bool all_or_nothing = false;            // stops at the first large chart that has no place
    std::span<const FixedMask> fixed = {};  // what is there already: not counted in PageFill, but for its height
    // Charts placed so far: told often, on the calling thread; not where several strategies are tried at once.
    std::function<void(std::size_t placed)> on_placed;
};

// `mask_of`: the mask of each chart; none is wider than a page without a limit of height. Several strategies are tried
// where the charts are few; the best one's result is returned. The same for any number of threads. Where the context is
// cancelled the result is incomplete.
PageFill fill_page(std::span<const ChartMask> masks, std::span<const std::uint32_t> mask_of, const FillOptions& options,
                   Context& context);

}  // namespace lumel
