// What a mistyped word may have been meant to be.
#pragma once

#include <string>
#include <vector>

namespace lumel::cli {

// The known word that the fewest slips make of this one (a letter inserted, left out, replaced or swapped with the
// next), no more than a third of its letters; else the first that begins with it; else empty. The first of equals.
// Based on: Damerau, "A technique for computer detection and correction of spelling errors" (1964).
std::string closest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace lumel::cli
