// The output folder of a bake without its light: two triangles, all pages black, for what reads it back.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "fuzz/seed_corpus.h"
#include "io/baked.h"
#include "io/gltf_write.h"
#include "io/image_io.h"
#include "io/json_write.h"
#include "io/page_files.h"
#include "support/load_gltf.h"

namespace lumel::fuzz {

class BakedFolder {
public:
    BakedFolder() {
        std::filesystem::create_directories(folder);
        ChartOptions options;
        options.texels_per_metre = 8;
        geometry = flatten(loaded.scene(), loaded.context).value();
        const ChartSet charts = make_charts(loaded.scene(), geometry, options, loaded.context).value();
        const Atlas atlas = make_atlas(loaded.scene(), geometry, charts, options, loaded.context).value();
        std::vector<LitTexture> textures;
        Json manifest;
        for (std::uint32_t p = 0; p < atlas.pages.size(); ++p) {
            const AtlasPage& page = atlas.pages[p];
            const std::vector<std::uint8_t> pixels(std::size_t{page.width} * page.height * 3);
            textures.push_back({encode_png(page.width, page.height, 3, pixels), 1.0f});
            const Image image(page.width, page.height, 3);
            (void)write_exr(folder / page_file(PageFile::lightmap, p), image, ExrType::half);
            const std::vector<ExrChannelSource> channels{
                {"coverage"}, {"variance.R"}, {"variance.G"}, {"variance.B"}, {"count"}};
            (void)write_exr(folder / page_file(PageFile::master, p), page.width, page.height, channels,
                            [](std::uint32_t, std::span<float>) { return false; });
            manifest["pages"].push_back({{"width", page.width},
                                         {"height", page.height},
                                         {"files", {{"master", {{"file", page_file(PageFile::master, p)}}}}}});
        }
        (void)write_file(folder / kManifestFile, bytes_of(manifest.dump()));
        (void)write_lit_gltf(folder / kSceneFile, {*loaded.result->document, loaded.scene(), charts, atlas, textures,
                                                   Include{}, hash_geometry(geometry)});
    }
    ~BakedFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    BakedFolder(const BakedFolder&) = delete;
    BakedFolder& operator=(const BakedFolder&) = delete;

    void put_scene(const std::uint8_t* data, std::size_t size) const {
        std::ofstream(folder / kSceneFile, std::ios::binary)
            .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    }

    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("lumel-fuzz-baked-" + std::to_string(::getpid()));
    test::Loaded loaded{two_triangles()};
    WorldGeometry geometry;

private:
    static test::GltfBuilder two_triangles() {
        test::GltfBuilder builder;
        const std::size_t triangle = builder.triangle();
        builder.node({{"mesh", triangle}});
        builder.node({{"mesh", triangle}, {"translation", {2, 0, 0}}});
        return builder;
    }
};

// The one of this process.
inline const BakedFolder& baked_folder() {
    static const BakedFolder the_one;
    return the_one;
}

// Its scene.glb begins the corpus of those who change it.
inline void seed_baked_scene(int argc, char** argv) {
    seed_corpus(argc, argv, {read_file(baked_folder().folder / kSceneFile, 1 << 20).value()});
}

}  // namespace lumel::fuzz
