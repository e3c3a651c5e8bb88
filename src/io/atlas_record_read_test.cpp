#include "io/atlas_record_read.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "lumel/scene.h"

namespace lumel {
namespace {

using Json = nlohmann::ordered_json;

Json good() {
    return Json::parse(R"({
        "generator": "Lumel", "density": 12.5, "scene_wide_uvs": false,
        "pages": [{"width": 64, "height": 32}],
        "instances": [{"transform": [1,0,0, 0,1,0, 0,0,1, 5,0,0], "charts": [0, 2]},
                      {"transform": [1,0,0, 0,1,0, 0,0,1, 0,0,0], "charts": [2, 3]}],
        "charts": {"id": ["0123456789abcdef", "ffffffffffffffff", "0123456789abcdef"],
                   "page": [0, null, 0],
                   "box": [[0, 0, 10, 8], null, [54, 24, 10, 8]]}})");
}

std::string error_of(const Json& json) {
    const Result<AtlasRecord> record = parse_atlas_record(json.dump(), "atlas.json");
    return record.ok() ? "no error" : record.error().text();
}

TEST(AtlasRecordRead, TakesWhatIsPlaced) {
    const Result<AtlasRecord> record = parse_atlas_record(good().dump(), "atlas.json");
    ASSERT_TRUE(record.ok()) << record.error().text();
    EXPECT_EQ(record->where, "atlas.json");
    EXPECT_EQ(record->density, 12.5);
    ASSERT_EQ(record->pages.size(), 1u);
    EXPECT_EQ(record->pages[0].width, 64u);
    ASSERT_EQ(record->charts.size(), 2u);
    EXPECT_EQ(record->charts[0].name.id, 0x0123456789abcdefu);
    EXPECT_EQ(record->charts[1].name.id, 0x0123456789abcdefu);
    Affine there;
    there.translation.x = 5.0f;
    EXPECT_EQ(record->charts[0].name.place, hash_place(there));
    EXPECT_EQ(record->charts[1].name.place, hash_place(Affine{}));
    EXPECT_EQ(record->charts[1].box, (ChartBox{54, 24, 10, 8}));
}

// Charts of a scene-wide TEXCOORD_1 have no boxes, and names all the same.
TEST(AtlasRecordRead, TakesTheNamesOfASceneWideLayout) {
    Json json = good();
    json["density"] = 0;
    json["scene_wide_uvs"] = true;
    json["charts"]["page"] = {0, 0, 0};
    json["charts"]["box"] = {nullptr, nullptr, nullptr};
    const Result<AtlasRecord> record = parse_atlas_record(json.dump(), "atlas.json");
    ASSERT_TRUE(record.ok()) << record.error().text();
    ASSERT_EQ(record->charts.size(), 3u);
    EXPECT_EQ(record->charts[1].name.id, 0xffffffffffffffffu);
    EXPECT_EQ(record->charts[1].box, ChartBox{});
}

TEST(AtlasRecordRead, TakesTheLookupsItWasLaidOutFor) {
    EXPECT_EQ(parse_atlas_record(good().dump(), "atlas.json")->masks, MaskRule{}) << "of before they were recorded";
    Json json = good();
    json["lookups"] = {{"filter", "bicubic"}, {"mips", 3}, {"block", 4}};
    const Result<AtlasRecord> record = parse_atlas_record(json.dump(), "atlas.json");
    ASSERT_TRUE(record.ok()) << record.error().text();
    EXPECT_EQ(record->masks, (MaskRule{LookupFilter::bicubic, 3, 4}));
}

TEST(AtlasRecordRead, SaysWhatIsWrong) {
    const auto with = [](const char* pointer, const Json& value) {
        Json json = good();
        json[Json::json_pointer(pointer)] = value;
        return error_of(json);
    };
    const auto says = [](const std::string& error, const char* text) {
        EXPECT_NE(error.find(text), std::string::npos) << error;
        EXPECT_TRUE(error.starts_with("atlas.json")) << error;
    };
    says(with("/pages/0/width", 0), "page 0: is of a size that no layout has");
    says(with("/pages/0/height", 20000), "page 0: is of a size that no layout has");
    says(with("/lookups", Json{{"mips", 7}}), "lookups: are none");
    says(with("/lookups", Json{{"block", 2}}), "lookups: are none");
    says(with("/lookups", Json{{"filter", "nearest"}}), "lookups: are none");
    says(with("/pages", Json::array()), "describes no pages");
    says(with("/density", 0), "has no density");
    says(with("/density", -1), "has no density");
    says(with("/charts", nullptr), "charts");
    says(with("/charts/page", Json::array({0})), "differ in length");
    says(with("/charts/page/2", 1), "instance 1, chart 2: lies on a page that is not described");
    says(with("/charts/page/2", -1), "lies on a page that is not described");
    says(with("/charts/id/0", "0123456789abcde"), "instance 0, chart 0: has an id");
    says(with("/charts/id/0", "0123456789abcdeg"), "16 hexadecimal digits");
    says(with("/charts/id/0", 7), "16 hexadecimal digits");
    says(with("/charts/box/2", Json::array({55, 24, 10, 8})), "does not lie on its page");
    says(with("/charts/box/2", Json::array({54, 24, 10})), "does not lie on its page");
    says(with("/charts/box/2", Json::array({54, 24, 10, 0})), "does not lie on its page");
    says(with("/charts/box/2", Json::array({4294967295u, 24, 10, 8})), "does not lie on its page");
    says(with("/instances/1/charts", Json::array({1, 3})), "instance 1: does not have the charts that follow");
    says(with("/instances/1/charts", Json::array({2, 4})), "does not have the charts that follow");
    says(with("/instances/1/charts", Json::array({2, 2})), "has charts that no instance has");
    says(with("/instances/1/transform", Json::array({1})), "transform");
    Json older = good();
    older["charts"].erase("id");
    says(error_of(older), "older Lumel");
    says(error_of(Json::array()), "describes no pages");
    // A kept layout has neither density nor boxes.
    Json kept = good();
    kept["density"] = 0;
    kept["scene_wide_uvs"] = true;
    EXPECT_EQ(error_of(kept), "no error");
    kept["pages"].push_back({{"width", 64}, {"height", 32}});
    says(error_of(kept), "is of one atlas of the scene, yet has 2 pages");
}

}  // namespace
}  // namespace lumel
