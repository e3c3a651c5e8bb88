// A bake of test::room() that takes no time.
#pragma once

#include "lumel/bake.h"

namespace lumel::test {

inline BakeOptions small_options() {
    BakeOptions options;
    options.texels_per_metre = 8;
    options.samples = 100;  // not a multiple of the wavefront
    options.bounces = 8;    // from which on cells are used
    return options;
}

}  // namespace lumel::test
