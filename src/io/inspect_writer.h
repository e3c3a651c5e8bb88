// The files of `lumel inspect`: pictures of layers, their numbers if asked, and inspect.json, which says what they
// show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "image/image.h"
#include "io/file_set.h"
#include "lumel/result.h"

namespace lumel {

inline constexpr const char* kInspectFile = "inspect.json";

// A layer as inspect.json describes it.
struct InspectedLayer {
    std::string name, what, unit;
    std::vector<std::string> channels;
    double low = 0.0, high = 1.0;  // ends of the scale of its colours
    double exposure = 1.0;
    std::vector<std::string> files;  // by the writer
};

// Where a picture is of: a page or a view, and its number.
struct InspectedPlace {
    bool is_view = false;
    std::uint32_t index = 0;
};

class InspectWriter {
public:
    // Errors: io, where the folder cannot be written to or files of these names that no inspection wrote would be
    // replaced.
    static Result<InspectWriter> create(const std::filesystem::path& folder);
    [[nodiscard]] std::function<void()> cleaner() const { return files_.cleaner(); }

    // RGB, sRGB-coded 0..1: <layer>_page<index>.png or <layer>_view<index>.png. Characters of the layer's name that
    // are no part of file names become '_'.
    Status picture(InspectedLayer& layer, InspectedPlace place, const Image& rgb);
    // The layer's numbers as float channels beside it, .exr.
    Status values(InspectedLayer& layer, InspectedPlace place, const Image& numbers);

    // inspect.json, and all of it appears; files of an older inspection go. `bake`: the folder that was inspected.
    Status commit(const std::filesystem::path& bake, std::span<const InspectedLayer> layers);

private:
    explicit InspectWriter(FileSet files, std::filesystem::path folder)
        : files_(std::move(files)), folder_(std::move(folder)) {}

    FileSet files_;
    std::filesystem::path folder_;
};

}  // namespace lumel
