// Containers, URIs and JSON, whole and damaged.
#include "io/gltf_container.h"

#include <gtest/gtest.h>

#include <fstream>

#include "io/data_uri.h"
#include "support/gltf_builder.h"
#include "support/temporary_folder.h"

namespace lumel {
namespace {

using test::GltfBuilder;

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

Result<GltfDocumentPtr> read(std::vector<std::byte> bytes) { return read_document(std::move(bytes), {}, "test.glb"); }

std::string error_of(std::vector<std::byte> bytes) {
    const Result<GltfDocumentPtr> document = read(std::move(bytes));
    return document.ok() ? "no error" : document.error().text();
}

GltfBuilder with_view() {
    GltfBuilder builder;
    builder.accessor<std::uint8_t>({10, 20, 30, 40, 50}, "SCALAR");
    return builder;
}

TEST(GltfContainer, ReadsAGlb) {
    const auto document = read(with_view().glb());
    ASSERT_TRUE(document.ok()) << document.error().text();
    ASSERT_EQ((*document)->buffers.size(), 1u);
    EXPECT_EQ((*document)->buffers[0].size(), 5u) << "without the padding of the chunk";
    ASSERT_EQ((*document)->views.size(), 1u);
    EXPECT_EQ((*document)->views[0][3], std::byte{40});
}

TEST(GltfContainer, ReadsAnEmbeddedBuffer) {
    const auto document = read(bytes_of(with_view().gltf()));
    ASSERT_TRUE(document.ok()) << document.error().text();
    EXPECT_EQ((*document)->views[0][4], std::byte{50});
}

TEST(GltfContainer, ReadsAnExternalBufferWithAnEscapedName) {
    test::TemporaryFolder folder;
    std::ofstream(folder / "my buffer.bin") << "12345";
    GltfBuilder builder = with_view();
    builder.root["buffers"] = {{{"byteLength", 5}, {"uri", "my%20buffer.bin"}}};
    const auto document = read_document(bytes_of(builder.root.dump()), folder / "scene.gltf", "scene.gltf");
    ASSERT_TRUE(document.ok()) << document.error().text();
    EXPECT_EQ((*document)->views[0][1], std::byte{'2'});
}

TEST(GltfContainer, NamesAMissingBufferFile) {
    test::TemporaryFolder folder;
    GltfBuilder builder = with_view();
    builder.root["buffers"] = {{{"byteLength", 5}, {"uri", "gone.bin"}}};
    const auto document = read_document(bytes_of(builder.root.dump()), folder / "scene.gltf", "scene.gltf");
    ASSERT_FALSE(document.ok());
    EXPECT_EQ(document.error().code, ErrorCode::io);
    const std::string text = document.error().text();
    EXPECT_NE(text.find("gone.bin"), std::string::npos) << text;
    EXPECT_NE(text.find("buffer 0"), std::string::npos) << text;
    EXPECT_NE(text.find("beside the scene"), std::string::npos) << text;
}

TEST(GltfContainer, RefusesFilesWhereThereIsNoFolder) {
    GltfBuilder builder = with_view();
    builder.root["buffers"] = {{{"byteLength", 5}, {"uri", "/etc/passwd"}}};
    EXPECT_NE(error_of(bytes_of(builder.root.dump())).find("files are not read here"), std::string::npos);
}

TEST(ResolveUri, TakesRelativePathsOnly) {
    EXPECT_EQ(resolve_uri("a/b.png", "dir", "t").value(), std::filesystem::path("dir/a/b.png"));
    EXPECT_EQ(resolve_uri("../b.png", "dir", "t").value(), std::filesystem::path("dir/../b.png"));
    EXPECT_FALSE(resolve_uri("http://host/b.png", "dir", "t").ok());
    EXPECT_FALSE(resolve_uri("/etc/passwd", "dir", "t").ok());
    EXPECT_FALSE(resolve_uri("%2fetc/passwd", "dir", "t").ok());
    EXPECT_FALSE(resolve_uri("", "dir", "t").ok());
    EXPECT_FALSE(resolve_uri("a%00b", "dir", "t").ok());
}

TEST(DataUri, DecodesBase64OfEveryLength) {
    std::string text;
    for (int length = 0; length < 8; ++length) {
        const std::string uri = GltfBuilder::data_uri("x/y", std::as_bytes(std::span(text)));
        const auto bytes = decode_data_uri(uri, "t");
        ASSERT_TRUE(bytes.ok());
        EXPECT_EQ(*bytes, bytes_of(text)) << uri;
        text += static_cast<char>(200 + length);
    }
    EXPECT_FALSE(decode_data_uri("data:x/y;base64,ab!d", "t").ok());
    EXPECT_FALSE(decode_data_uri("data:x/y,plain", "t").ok());
}

TEST(GltfContainer, RefusesEveryTruncation) {
    const std::vector<std::byte> whole = with_view().glb();
    ASSERT_TRUE(read(whole).ok());
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_FALSE(read({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}).ok()) << length;
}

TEST(GltfContainer, RefusesAChunkThatReachesBeyondTheFile) {
    std::vector<std::byte> bytes = with_view().glb();
    bytes[12] = std::byte{0xff};
    bytes[13] = std::byte{0xff};
    EXPECT_NE(error_of(bytes).find("chunk 0 reaches beyond"), std::string::npos);
    // As many bytes as the file has, which are more than follow the chunk's head.
    bytes[12] = static_cast<std::byte>(bytes.size() & 255);
    bytes[13] = static_cast<std::byte>(bytes.size() >> 8);
    EXPECT_NE(error_of(bytes).find("chunk 0 reaches beyond"), std::string::npos);
}

TEST(GltfContainer, RefusesOtherVersions) {
    std::vector<std::byte> bytes = with_view().glb();
    bytes[4] = std::byte{1};
    EXPECT_NE(error_of(bytes).find("version 1"), std::string::npos);
    GltfBuilder builder;
    builder.root["asset"]["version"] = "1.0";
    EXPECT_NE(error_of(builder.glb()).find("glTF 1.0"), std::string::npos);
    builder.root.erase("asset");
    EXPECT_NE(error_of(builder.glb()).find("asset"), std::string::npos);
}

TEST(GltfContainer, NamesAllUnknownRequiredExtensions) {
    GltfBuilder builder;
    builder.root["extensionsRequired"] = {"KHR_texture_transform", "ACME_one", "ACME_two"};
    const auto document = read(builder.glb());
    ASSERT_FALSE(document.ok());
    EXPECT_EQ(document.error().code, ErrorCode::unsupported);
    EXPECT_NE(document.error().message.find("ACME_one, ACME_two"), std::string::npos) << document.error().message;
    EXPECT_EQ(document.error().message.find("KHR_texture_transform"), std::string::npos);
}

TEST(GltfContainer, SaysHowToGetRidOfDraco) {
    GltfBuilder builder;
    builder.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    EXPECT_NE(error_of(builder.glb()).find("gltf-transform"), std::string::npos);
}

TEST(GltfContainer, ChecksViewsAgainstTheirBuffer) {
    const auto with = [](const char* key, std::uint64_t value) {
        GltfBuilder builder = with_view();
        builder.root["bufferViews"][0][key] = value;
        return error_of(builder.glb());
    };
    EXPECT_EQ(with("byteOffset", 0), "no error");
    EXPECT_NE(with("byteOffset", 1).find("reach beyond buffer 0"), std::string::npos);
    EXPECT_NE(with("byteOffset", ~std::uint64_t{0}).find("reach beyond buffer 0"), std::string::npos);
    EXPECT_NE(with("byteLength", 6).find("reach beyond buffer 0"), std::string::npos);
    EXPECT_NE(with("byteLength", ~std::uint64_t{0}).find("reach beyond buffer 0"), std::string::npos);
    EXPECT_NE(with("buffer", 1).find("buffers[1]"), std::string::npos);
    EXPECT_NE(with("byteStride", 256).find("byteStride"), std::string::npos);
}

TEST(GltfContainer, ChecksTheBuffersLength) {
    GltfBuilder builder = with_view();
    builder.root["buffers"] = {{{"byteLength", std::uint64_t{1} << 40}}};
    EXPECT_NE(error_of(builder.glb()).find("truncated"), std::string::npos);
}

TEST(GltfContainer, WrongTypesAreErrorsThatNameTheKey) {
    GltfBuilder builder = with_view();
    builder.root["bufferViews"][0]["byteLength"] = "five";
    EXPECT_NE(error_of(builder.glb()).find("'byteLength' must be a whole number"), std::string::npos);
    builder.root["bufferViews"] = {1, 2};
    EXPECT_NE(error_of(builder.glb()).find("bufferViews[0] must be an object"), std::string::npos);
}

TEST(ParseJson, RefusesWhatWouldTakeTooLong) {
    EXPECT_TRUE(parse_json("{\"a\": [1, 2.5, \"x\"]}", "t").ok());
    EXPECT_NE(parse_json(std::string(300, '['), "t").error().text().find("nested too deeply"), std::string::npos);
    std::string keys = "{";
    for (int i = 0; i < 40000; ++i) keys.append("\"").append(std::to_string(i)).append("\":0,");
    keys += "\"last\":0}";
    EXPECT_NE(parse_json(keys, "t").error().text().find("too many keys"), std::string::npos);
    EXPECT_NE(parse_json("{\"a\": 1e999}", "t").error().text().find("JSON"), std::string::npos);
    const std::string place = parse_json("{\"a\": tru}", "t").error().text();
    EXPECT_NE(place.find("byte 10"), std::string::npos) << place;
    const std::string bytes = parse_json("{\"a\": \"\xff\x98\"}", "t").error().text();
    for (const char c : bytes) EXPECT_GE(c, ' ') << "the message repeats no raw bytes: " << bytes;
}

}  // namespace
}  // namespace lumel
