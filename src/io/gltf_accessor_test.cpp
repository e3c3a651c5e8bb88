// Accessors against values written by hand.
#include "io/gltf_accessor.h"

#include <gtest/gtest.h>

#include "io/gltf_container.h"
#include "support/gltf_builder.h"

namespace lumel {
namespace {

using test::GltfBuilder;

GltfDocumentPtr document_of(const GltfBuilder& builder) {
    auto document = read_document(builder.glb(), {}, "test.glb");
    EXPECT_TRUE(document.ok()) << document.error().text();
    return std::move(document).value();
}

std::string error_of(const GltfBuilder& builder, std::size_t accessor = 0) {
    const auto view = open_accessor(*document_of(builder), accessor);
    return view.ok() ? "no error" : view.error().text();
}

template <class T>
float number(const std::vector<T>& values, bool normalized, std::uint64_t i) {
    GltfBuilder builder;
    builder.accessor(values, "SCALAR", normalized);
    const auto document = document_of(builder);
    const float in_place = open_accessor(*document, 0)->number(i, 0);
    EXPECT_EQ(in_place, document->accessor_bytes(0)->number(i, 0));
    return in_place;
}

// glTF 2.0, 3.11: f = c / 255, max(c / 127, -1), c / 65535, max(c / 32767, -1).
TEST(GltfAccessor, ConvertsEveryComponentType) {
    EXPECT_EQ(number<float>({1.5f, -2.25f}, false, 1), -2.25f);
    EXPECT_EQ(number<std::uint8_t>({0, 255}, true, 1), 1.0f);
    EXPECT_EQ(number<std::uint8_t>({0, 51}, true, 1), 0.2f);
    EXPECT_EQ(number<std::uint8_t>({0, 51}, false, 1), 51.0f);
    EXPECT_EQ(number<std::int8_t>({-128, -127, 127}, true, 0), -1.0f);
    EXPECT_EQ(number<std::int8_t>({-128, -127, 127}, true, 1), -1.0f);
    EXPECT_EQ(number<std::int8_t>({-128, -127, 127}, true, 2), 1.0f);
    EXPECT_EQ(number<std::int8_t>({-128}, false, 0), -128.0f);
    EXPECT_EQ(number<std::uint16_t>({13107}, true, 0), 0.2f);
    EXPECT_EQ(number<std::int16_t>({-32768, 32767}, true, 0), -1.0f);
    EXPECT_EQ(number<std::int16_t>({-32768, 32767}, true, 1), 1.0f);
    EXPECT_EQ(number<std::uint32_t>({70000}, false, 0), 70000.0f);
}

TEST(GltfAccessor, FollowsStrideAndOffset) {
    GltfBuilder builder;
    // Interleaved: position of three floats, then a colour of four bytes.
    std::vector<std::byte> bytes(32);
    const float positions[6] = {1, 2, 3, 4, 5, 6};
    for (std::size_t v = 0; v < 2; ++v) {
        std::memcpy(&bytes[v * 16], &positions[v * 3], 12);
        bytes[v * 16 + 12] = static_cast<std::byte>(100 + v);
    }
    const std::size_t view = builder.view(bytes, 16);
    builder.accessor(view, 5126, "VEC3", 2);
    builder.root["accessors"].push_back(
        {{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5121}, {"count", 2}, {"type", "VEC4"}});
    const auto document = document_of(builder);
    EXPECT_EQ(open_accessor(*document, 0)->number(1, 2), 6.0f);
    EXPECT_EQ(open_accessor(*document, 1)->number(1, 0), 101.0f);
    const auto packed = document->accessor_bytes(0);
    EXPECT_EQ(packed->bytes.size(), 24u) << "tightly packed";
    EXPECT_EQ(packed->number(1, 0), 4.0f);
}

TEST(GltfAccessor, AppliesSparseValues) {
    GltfBuilder builder;
    builder.accessor<float>({0, 1, 2, 3}, "SCALAR");
    const std::vector<std::uint16_t> indices{1, 3};
    const std::vector<float> values{10, 30};
    const std::size_t index_view = builder.view(std::as_bytes(std::span(indices)));
    const std::size_t value_view = builder.view(std::as_bytes(std::span(values)));
    builder.root["accessors"][0]["sparse"] = {{"count", 2},
                                              {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
                                              {"values", {{"bufferView", value_view}}}};
    const auto view = open_accessor(*document_of(builder), 0);
    ASSERT_TRUE(view.ok()) << view.error().text();
    EXPECT_EQ(view->number(0, 0), 0.0f);
    EXPECT_EQ(view->number(1, 0), 10.0f);
    EXPECT_EQ(view->number(2, 0), 2.0f);
    EXPECT_EQ(view->number(3, 0), 30.0f);

    builder.root["accessors"][0].erase("bufferView");
    const auto zeros = open_accessor(*document_of(builder), 0);
    EXPECT_EQ(zeros->number(2, 0), 0.0f) << "without a view the others are zero";
    EXPECT_EQ(zeros->number(3, 0), 30.0f);

    builder.root["accessors"][0]["count"] = 3;
    EXPECT_NE(error_of(builder).find("sparse index 3 is out of range"), std::string::npos) << error_of(builder);
    builder.root["accessors"][0]["sparse"]["count"] = 3;
    EXPECT_NE(error_of(builder).find("reach beyond"), std::string::npos);
}

TEST(GltfAccessor, MatrixColumnsBeginAtMultiplesOfFour) {
    GltfBuilder builder;
    const std::vector<std::uint8_t> padded{1, 2, 0, 0, 3, 4, 0, 0, 5, 6, 0, 0, 7, 8, 0, 0};  // two 2x2 matrices
    builder.accessor(builder.view(std::as_bytes(std::span(padded))), 5121, "MAT2", 2);
    const auto packed = document_of(builder)->accessor_bytes(0);
    ASSERT_TRUE(packed.ok()) << packed.error().text();
    ASSERT_EQ(packed->bytes.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(packed->bytes[i], static_cast<std::byte>(i + 1));
}

TEST(GltfAccessor, RefusesWhatReachesBeyondItsView) {
    const auto with = [](const char* key, GltfBuilder::Json value) {
        GltfBuilder builder;
        builder.accessor<float>({1, 2, 3, 4, 5, 6}, "VEC3");
        builder.root["accessors"][0][key] = std::move(value);
        return error_of(builder);
    };
    EXPECT_EQ(with("count", 2), "no error");
    EXPECT_NE(with("count", 3).find("reach beyond bufferView 0"), std::string::npos);
    EXPECT_NE(with("count", 0).find("no elements"), std::string::npos);
    EXPECT_NE(with("count", -1).find("'count' must be"), std::string::npos);
    EXPECT_NE(with("count", ~std::uint64_t{0}).find("reach beyond"), std::string::npos);
    EXPECT_NE(with("count", std::uint64_t{1} << 62).find("reach beyond"), std::string::npos) << "count * 12 overflows";
    EXPECT_NE(with("byteOffset", 1).find("reach beyond"), std::string::npos);
    EXPECT_NE(with("byteOffset", ~std::uint64_t{0}).find("reach beyond"), std::string::npos);
    EXPECT_NE(with("bufferView", 1).find("bufferViews[1]"), std::string::npos);
    EXPECT_NE(with("componentType", 5124).find("5124"), std::string::npos);
    EXPECT_NE(with("type", "VEC5").find("VEC5"), std::string::npos);
    EXPECT_NE(with("sparse", 1).find("'sparse'"), std::string::npos);
}

TEST(GltfAccessor, RefusesElementsWithoutDataBeyondAllReason) {
    GltfBuilder builder;
    builder.add("accessors", {{"componentType", 5126}, {"count", 100}, {"type", "VEC3"}});
    EXPECT_EQ(error_of(builder), "no error") << "a hundred zeros";
    builder.root["accessors"][0]["count"] = 1u << 30;
    EXPECT_NE(error_of(builder).find("without data"), std::string::npos);
}

TEST(GltfAccessor, RefusesOverlappingElements) {
    GltfBuilder builder;
    const std::vector<float> values(6);
    builder.accessor(builder.view(std::as_bytes(std::span(values)), 4), 5126, "VEC3", 2);
    EXPECT_NE(error_of(builder).find("overlap"), std::string::npos);
}

}  // namespace
}  // namespace lumel
