#include "io/encoded_output.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "encode/encodings.h"
#include "lumel/scene.h"
#include "support/json_schema.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;
using Json = nlohmann::ordered_json;

void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

Json json_file(const fs::path& path) { return Json::parse(std::ifstream(path)); }

Names names_in(const fs::path& folder) {
    Names out;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) out.insert(entry.path().filename());
    return out;
}

// A folder with a manifest, as far as it is read here.
class EncodedFiles : public testing::Test {
protected:
    EncodedFiles() {
        fs::create_directory(bake_);
        put(bake_ / "manifest.json",
            R"({"pages": [{"width": 3, "height": 2, "files": {"master": {"file": "master_0.exr"}}}]})");
        record_.input_hash = std::string(32, 'a');
        record_.include = {true, false, true};
    }

    Result<EncodedOutput> with_pages(std::size_t count, const EncodedTarget& target = {}) {
        Result<EncodedOutput> out = EncodedOutput::create(bake_, kIrradZHhd, record_, target);
        for (std::size_t p = 0; p < count && out.ok(); ++p) {
            const EncodedPage page{3, 2, {0, kNone, kNone, kNone, kNone, kNone}, {Numbers{1, 2, 3, 0.5f, 0, 0}}};
            EXPECT_TRUE(out->page({&page, 1}, context_).ok());
        }
        return out;
    }
    MasterList masters() { return list_masters(bake_).value(); }

    const test::TemporaryFolder folder_;
    const fs::path bake_ = folder_ / "bake";
    LightRecord record_;
    Context context_;
};

TEST_F(EncodedFiles, AreDescribedAsTheSchemaSays) {
    auto output = with_pages(2);
    ASSERT_TRUE(output.ok()) << output.error().text();
    ASSERT_TRUE(output->commit(masters()).ok());
    const Json json = json_file(bake_ / "encoded_irradz-hhd.json");
    const test::JsonSchema schema(json_file(std::string(LUMEL_SOURCE_DIR) + "/docs/schema/encoded.schema.json"));
    for (const std::string& line : schema.errors(json)) ADD_FAILURE() << line;
    EXPECT_EQ(json["layers"], Json({"direct", "indirect"}));
    EXPECT_EQ(json["channels"].size(), kIrradZHhd.fields.size());
    ASSERT_EQ(json["pages"].size(), 2u);
    EXPECT_EQ(json["pages"][1], Json({{"file", "encoded_irradz-hhd_1.exr"},
                                      {"width", 3},
                                      {"height", 2},
                                      {"type", "half"},
                                      {"mips", Json::array()}}));
    Json broken = json;
    broken["pages"][0]["type"] = "double";
    EXPECT_FALSE(schema.errors(broken).empty());
}

TEST_F(EncodedFiles, OfTexturesAreDescribedAsTheSchemaSays) {
    const test::JsonSchema schema(json_file(std::string(LUMEL_SOURCE_DIR) + "/docs/schema/encoded.schema.json"));
    for (const EncodedFormat& format : encoded_formats()) {
        if (format.file == EncodedFile::exr) continue;
        SCOPED_TRACE(format.name);
        const TextureStorage* storage = find_texture_storage(format.storage ? format.storage : "bc45");
        const bool layered = format.file == EncodedFile::ktx2 || format.file == EncodedFile::dds;
        {
            auto output = with_pages(2, {&format, storage, BcQuality::fast, layered ? 2u : 0u});
            ASSERT_TRUE(output.ok()) << output.error().text();
            ASSERT_TRUE(output->commit(masters()).ok());
        }
        const Json json = json_file(bake_ / "encoded_irradz-hhd.json");
        for (const std::string& line : schema.errors(json)) ADD_FAILURE() << line;
        EXPECT_EQ(json["format"], format.name);
        ASSERT_EQ(json["pages"].size(), 2u);
        Names files{"manifest.json", "encoded_irradz-hhd.json"};
        for (const Json& texture : json["pages"][1]["textures"]) {
            files.insert(texture["file"]);
            EXPECT_EQ(texture["layer"], layered ? 1 : 0);
        }
        if (!layered)
            for (const Json& texture : json["pages"][0]["textures"]) files.insert(texture["file"]);
        // Nothing of the format before is left.
        EXPECT_EQ(names_in(bake_), files);
    }
}

TEST_F(EncodedFiles, OfPagesOfOneSizeAreLayers) {
    const EncodedFormat* ktx2 = find_encoded_format("ktx2");
    const TextureStorage* bc7 = find_texture_storage("bc7");
    auto output = with_pages(3, {ktx2, bc7, BcQuality::fast, 3});
    ASSERT_TRUE(output.ok() && output->commit(masters()).ok());
    const auto word = [&](const char* file, std::streamoff at) {
        std::ifstream stream(bake_ / file, std::ios::binary);
        std::uint32_t out = 0;
        stream.seekg(at);
        stream.read(reinterpret_cast<char*>(&out), sizeof out);
        EXPECT_TRUE(stream.good()) << file;
        return out;
    };
    EXPECT_EQ(word("encoded_irradz-hhd_I.ktx2", 12), 143u);
    EXPECT_EQ(word("encoded_irradz-hhd_I.ktx2", 32), 3u) << "layers";
    EXPECT_EQ(word("encoded_irradz-hhd_w-d.ktx2", 12), 145u);
    auto apart = with_pages(2, {ktx2, bc7, BcQuality::fast, 0});
    ASSERT_TRUE(apart.ok() && apart->commit(masters()).ok());
    EXPECT_EQ(word("encoded_irradz-hhd_w-d_1.ktx2", 32), 0u) << "no array";
    EXPECT_FALSE(fs::exists(bake_ / "encoded_irradz-hhd_I.ktx2"));
}

// A page of 8 x 8 and its mips: levels of one file where files have levels, else a file each; one scale for all.
TEST_F(EncodedFiles, HoldTheMipsOfTheirPages) {
    const test::JsonSchema schema(json_file(std::string(LUMEL_SOURCE_DIR) + "/docs/schema/encoded.schema.json"));
    std::vector<EncodedPage> levels;
    for (const std::uint32_t edge : {8u, 4u, 2u}) {
        // The second mip is the brightest, beyond all halves.
        const float light = edge == 4 ? 1e6f : 100.0f;
        std::vector<std::uint32_t> texel_at(std::size_t{edge} * edge, 0);
        levels.push_back({edge, edge, std::move(texel_at), {Numbers{light, light, light, 0.5f, 0, 0}}});
    }
    for (const EncodedFormat& format : encoded_formats()) {
        SCOPED_TRACE(format.name);
        const bool is_exr = format.file == EncodedFile::exr;
        const bool has_levels = format.file == EncodedFile::ktx2 || format.file == EncodedFile::dds;
        EncodedTarget target{&format, nullptr, BcQuality::fast, has_levels ? 2u : 0u};
        if (!is_exr) target.storage = find_texture_storage(format.storage ? format.storage : "bc7");
        {
            auto output = EncodedOutput::create(bake_, kIrradZHhd, record_, target);
            ASSERT_TRUE(output.ok()) << output.error().text();
            for (int page = 0; page < 2; ++page) ASSERT_TRUE(output->page(levels, context_).ok());
            ASSERT_TRUE(output->commit(masters()).ok());
        }
        const Json json = json_file(bake_ / "encoded_irradz-hhd.json");
        for (const std::string& line : schema.errors(json)) ADD_FAILURE() << line;
        Names files{"manifest.json", "encoded_irradz-hhd.json"};
        for (const Json& page : json["pages"]) {
            ASSERT_EQ(page["mips"].size(), 2u);
            if (is_exr) files.insert(page["file"]);
            for (std::size_t t = 0; !is_exr && t < page["textures"].size(); ++t) {
                EXPECT_EQ(page["textures"][t]["level"], 0);
                files.insert(page["textures"][t]["file"]);
            }
            for (std::size_t mip = 1; mip <= 2; ++mip) {
                const Json& level = page["mips"][mip - 1];
                EXPECT_EQ(level["width"], 8u >> mip);
                if (is_exr) {
                    files.insert(level["file"]);
                    continue;
                }
                ASSERT_EQ(level["textures"].size(), page["textures"].size());
                for (std::size_t t = 0; t < level["textures"].size(); ++t) {
                    EXPECT_EQ(level["textures"][t]["level"], has_levels ? mip : 0);
                    EXPECT_EQ(level["textures"][t]["scale"], page["textures"][t]["scale"]);
                    files.insert(level["textures"][t]["file"]);
                }
            }
            if (has_levels) {
                EXPECT_GE(page["textures"][0]["scale"].get<float>(), 1e6f / 65504.0f) << "holds the brightest mip";
            }
        }
        // Of two textures: two files; else each of two pages in three sizes, of EXR in one file.
        EXPECT_EQ(files.size(), 2u + (has_levels ? 2u : is_exr ? 6u : 12u));
        EXPECT_EQ(names_in(bake_), files) << "and nothing of the format before is left";
    }
}

TEST_F(EncodedFiles, AppearTogetherAndReplaceAllOlderOnes) {
    put(bake_ / "encoded_irradz-hhd.json", R"({"version": 1, "encoding": "irradz-hhd"})");
    put(bake_ / "encoded_irradz-hhd_1.exr", "older");
    put(bake_ / "encoded_irradz-hhd_12.exr", "older");
    put(bake_ / "encoded_l2_1.exr", "another");
    put(bake_ / "encoded_irradz-hhd_notes.exr", "somebody's");
    const Names before = names_in(bake_);
    {
        auto unfinished = with_pages(1);
        ASSERT_TRUE(unfinished.ok());
        EXPECT_FALSE(fs::exists(bake_ / "encoded_irradz-hhd_0.exr"));
        EXPECT_TRUE(fs::exists(unfinished->partial() / "encoded_irradz-hhd_0.exr"));
    }
    EXPECT_EQ(names_in(bake_), before);
    {
        auto output = with_pages(1);
        ASSERT_TRUE(output.ok());
        ASSERT_TRUE(output->commit(masters()).ok());
    }
    EXPECT_EQ(names_in(bake_), (Names{"encoded_irradz-hhd.json", "encoded_irradz-hhd_0.exr", "encoded_l2_1.exr",
                                      "encoded_irradz-hhd_notes.exr", "manifest.json"}));
}

TEST_F(EncodedFiles, OfABakeThatWasReplacedAreNotWritten) {
    const MasterList source = masters();
    auto output = with_pages(1);
    ASSERT_TRUE(output.ok());
    put(bake_ / "manifest.json", "{}");
    const Status status = output->commit(source);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().text().find("another bake"), std::string::npos) << status.error().text();
    EXPECT_FALSE(fs::exists(bake_ / "encoded_irradz-hhd_0.exr"));
}

}  // namespace
}  // namespace lumel
