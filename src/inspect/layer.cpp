#include "inspect/layer.h"

#include <algorithm>

namespace lumel {

void LayerPage::drop_dilated() {
    for (std::size_t i = 0; i < presence.size(); ++i) {
        if (presence[i] != Presence::dilated) continue;
        presence[i] = Presence::none;
        std::fill_n(&values.data[i * values.channels], values.channels, 0.0f);
    }
}

}  // namespace lumel
