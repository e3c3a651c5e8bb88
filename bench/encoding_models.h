// The models of a light that the tables of `lumel_bench encodings` compare, by name.
#pragma once

#include <vector>

#include "encoding_case.h"

namespace lumel::bench {

struct EncodingRow {
    const char* name;
    EncodingModel model;
};

std::vector<EncodingRow> texel_rows();
// A probe sees the whole sphere; the texel's surface hides the lower half.
std::vector<EncodingRow> probe_rows();
// The slides' own experiment: SH of the whole sphere, no occlusion, errors over the upper hemisphere.
std::vector<EncodingRow> sphere_rows();

}  // namespace lumel::bench
