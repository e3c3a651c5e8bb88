// One lobe and ambient light (AHD, HHD) as models of a light: by the moments with a given Gram matrix or by true
// clamped cosines, at the optimal linear direction or at what a search finds.
#pragma once

#include "encode/lobe_search.h"
#include "encoding_case.h"

namespace lumel::bench {

enum class LobeDirection { linear, searched };
EncodingModel lobes(AmbientLobe ambient, const ZonalMatrix& gram, LobeDirection direction);
// By the search that was published, and that the expected figures come from.
EncodingModel nested_lobes(AmbientLobe ambient, const ZonalMatrix& gram);
// True clamped cosines instead of three bands; one weight, or one per channel.
enum class LobeWeights { luminance, rgb };
EncodingModel exact_lobes(AmbientLobe ambient, LobeWeights weights);
// HHD of the luminance's moments as it comes, not as texels store it.
Decoded hhd_closed(const EncodingCase& c);

}  // namespace lumel::bench
