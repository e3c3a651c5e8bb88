#include "io/gltf_write.h"

#include "base/check.h"
#include "base/try.h"
#include "encode/units.h"
#include "io/glb_builder.h"
#include "io/json_edit.h"
#include "io/json_write.h"
#include "io/kept_data.h"
#include "io/lit_geometry.h"
#include "io/lit_images.h"
#include "io/lit_instances.h"
#include "io/lit_lights.h"
#include "io/lit_materials.h"
#include "io/lit_mesh_plan.h"
#include "io/page_files.h"

namespace lumel {
namespace {

void write_root_extension(const GltfWriteInput& in, const std::vector<PageTexture>& textures, const ChartBuffer& charts,
                          Json& root) {
    Json pages = Json::array();
    for (std::uint32_t p = 0; p < in.atlas.pages.size(); ++p)
        pages.push_back({{"width", in.atlas.pages[p].width},
                         {"height", in.atlas.pages[p].height},
                         {"lightmap", page_file(PageFile::lightmap, p)},
                         {"irradiance", page_file(PageFile::irradiance, p)},
                         {"l1", page_file(PageFile::l1, p)},
                         {"texture", textures[p].texture},
                         {"strength", json_number(textures[p].strength)}});
    root["extensions"][kLightmapExtension] = {{"version", 1},
                                              {"units",
                                               {{"lightmap", unit_name(unit_of(PageFile::lightmap))},
                                                {"irradiance", unit_name(unit_of(PageFile::irradiance))},
                                                {"l1", unit_name(unit_of(PageFile::l1))},
                                                {"texture", "albedo x E/pi"}}},
                                              {"manifest", kManifestFile},
                                              {"geometry", in.geometry_hash},
                                              {"pages", std::move(pages)}};
    if (charts.transforms != kNone) {
        root["extensions"][kLightmapExtension]["transforms"] = charts.transforms;
        root["extensions"][kLightmapExtension]["chartPages"] = charts.pages;
    }
    add_to_list(root, "extensionsUsed", kLightmapExtension);
    root["asset"]["generator"] = "Lumel";
}

Status write(const std::filesystem::path& path, const GltfWriteInput& in) {
    LUMEL_CHECK(in.textures.size() == in.atlas.pages.size(), in.textures.size(), in.atlas.pages.size());
    LUMEL_TRY(const LitMeshPlan plan, plan_lit_meshes(in));
    GlbBuilder glb(in.document.root);
    LUMEL_TRY_STATUS(keep_used_data(in.document, plan, glb));
    LUMEL_TRY_STATUS(embed_images(in.document, glb));
    const std::vector<PageTexture> textures = add_page_textures(in.textures, glb);
    LitMaterials materials(glb.root(), textures);
    std::vector<std::vector<Json>> primitives;
    for (const SharedGeometry& geometry : plan.geometries) {
        LUMEL_TRY(std::vector<Json> written, write_geometry(in.document, geometry, glb));
        primitives.push_back(std::move(written));
    }
    const ChartBuffer charts = write_lit_instances(in, plan, primitives, materials, glb);
    if (in.include.direct) remove_baked_lights(in.document, in.scene, glb.root());
    write_root_extension(in, textures, charts, glb.root());
    return glb.write(path);
}

}  // namespace

Status write_lit_gltf(const std::filesystem::path& path, const GltfWriteInput& input) {
    try {
        return write(path, input);
    } catch (const Json::exception& e) {
        return Error{ErrorCode::invalid_input, std::string("cannot be written back: ") + e.what(), input.document.where,
                     "check the file with the glTF validator"};
    }
}

}  // namespace lumel
