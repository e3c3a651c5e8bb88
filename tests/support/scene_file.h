// A scene file taken as far as its texels: charts, atlas, pages.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "chart/chart_set.h"
#include "io/gltf_document.h"
#include "texel/texel_buffer.h"

namespace lumel::test {

class SceneFile {
public:
    SceneFile(const std::filesystem::path& path, const ChartOptions& options, unsigned threads = 1) : context(threads) {
        take(load_scene(path, context), [&](LoadedScene&& loaded) { scene = std::move(loaded.scene); });
        take(flatten(scene, context), [&](WorldGeometry&& flat) { geometry = std::move(flat); });
        take(make_charts(scene, geometry, options, context), [&](ChartSet&& made) { charts = std::move(made); });
        take(make_atlas(scene, geometry, charts, options, context), [&](Atlas&& made) { atlas = std::move(made); });
        page_triangles = triangles_by_page(scene, geometry, charts, atlas);
    }

    [[nodiscard]] TexelBuffer rasterize(std::uint32_t page = 0) {
        TexelBuffer texels;
        take(rasterize_page(scene, geometry, charts, atlas, page, page_triangles.at(page), context),
             [&](TexelBuffer&& made) { texels = std::move(made); });
        return texels;
    }

    Context context;
    Scene scene;
    WorldGeometry geometry;
    ChartSet charts;
    Atlas atlas;
    std::vector<std::vector<std::uint32_t>> page_triangles;

private:
    template <class T, class Keep>
    static void take(Result<T> result, Keep&& keep) {
        if (result.ok()) {
            keep(std::move(result).value());
        } else {
            ADD_FAILURE() << result.error().text();
        }
    }
};

}  // namespace lumel::test
