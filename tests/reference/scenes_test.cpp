// Every real scene loads: exporters write what no test of ours would think of.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/gltf_document.h"
#include "scene/world_geometry.h"
#include "support/test_data.h"

namespace lumel::test {
namespace {

TEST(RealScenes, AllLoad) {
    const auto folder = data_file("scenes");
    if (!folder) GTEST_SKIP() << "no real scenes: set LUMEL_DATA";
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(*folder))
        if (entry.path().extension() == ".glb") files.push_back(entry.path());
    std::ranges::sort(files);
    ASSERT_FALSE(files.empty()) << *folder;
    for (const auto& file : files) {
        Context context;
        const auto loaded = load_scene(file, context);
        ASSERT_TRUE(loaded.ok()) << loaded.error().text();
        const auto geometry = flatten(loaded->scene, context);
        ASSERT_TRUE(geometry.ok()) << geometry.error().text();
        EXPECT_GT(geometry->triangle_count(), 0u) << file;
        EXPECT_TRUE(std::isfinite(length(geometry->bounds_max - geometry->bounds_min))) << file;
    }
    std::printf("%zu scenes of %s\n", files.size(), folder->c_str());
}

}  // namespace
}  // namespace lumel::test
