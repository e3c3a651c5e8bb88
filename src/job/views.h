// preview_view_<k>.png: camera views of a bake, path-traced beside lit by the files just written.
#pragma once

#include <cstdint>

#include "io/bake_writer.h"
#include "path/path_integrator.h"

namespace lumel {

struct ViewOptions {
    std::uint32_t count = 2, samples = 32;  // views; paths per pixel
    std::uint64_t page_memory = 0;          // bytes for the pages that are looked at together; 0: no ceiling
};

// What the pictures show is what a user gets: they are lit by the files in the writer's folder. Stage "views".
Status write_views(BakeWriter& writer, const Transport& transport, const BakeOptions& options, const ViewOptions& views,
                   Context& context);

}  // namespace lumel
