// A layout that was written once, and how its charts are known again in an edited scene: what keeps its shape, its
// object and its size keeps its place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chart/chart_set.h"

namespace lumel {

// What a chart of an instance is called, whatever the numbers of its mesh, triangles and node are.
struct ChartName {
    std::uint64_t id = 0;     // hash of its triangles in mesh space, their chart UVs and the path of its node
    std::uint64_t place = 0;  // hash of the instance's transform: tells copies apart whose id is the same
};

// Of every placement, in their order: charts of each instance that gets texels.
std::vector<ChartName> chart_names(const Scene& scene, const ChartSet& charts);
std::uint64_t hash_place(const Affine& transform);

struct AtlasRecord {
    struct Chart {
        ChartName name;
        std::uint32_t page = 0;
        ChartBox box;  // on the page; empty in a scene-wide layout, else not
    };
    std::string where;  // the file, for messages
    bool scene_wide = false;
    MaskRule masks;                // Atlas::masks
    double density = 0.0;          // Atlas::density: above 0 but for a kept layout
    std::vector<AtlasPage> pages;  // one of a scene-wide layout
    std::vector<Chart> charts;     // those that lie on a page
};

// Of each name the chart of the record that it is, or kNone. Where several charts have one id, those in the same place
// find each other first, the others by their order. A chart of the record is given to one name at most.
std::vector<std::uint32_t> find_in_record(const AtlasRecord& record, const std::vector<ChartName>& names);

// Whether a layout of these options can keep that of the record. Error: usage, naming the option that is in the way, or
// what has become of TEXCOORD_1.
Status check_record(const AtlasRecord& record, const ChartSet& charts, const ChartOptions& options);

}  // namespace lumel
