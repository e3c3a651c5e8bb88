// What meshoptimizer's encoders write is what the reader gives back, and what no encoder writes is refused.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "io/gltf_accessor.h"
#include "io/gltf_container.h"
#include "support/gltf_builder.h"

namespace lumel {
namespace {

using test::GltfBuilder;

std::vector<std::byte> as_bytes_of(const std::vector<unsigned char>& data) {
    const auto bytes = std::as_bytes(std::span(data));
    return {bytes.begin(), bytes.end()};
}

// A document whose view 0 is `compressed`, decoding to count * stride bytes.
GltfBuilder compressed_document(const std::vector<unsigned char>& compressed, std::size_t count, std::size_t stride,
                                const char* mode, const char* filter = "NONE") {
    GltfBuilder builder;
    builder.binary = as_bytes_of(compressed);
    builder.root["buffers"] = {
        {{"byteLength", compressed.size()}},
        {{"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    GltfBuilder::Json view{{"buffer", 1}, {"byteLength", count * stride}};
    view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},          {"byteLength", compressed.size()},
                                                     {"byteStride", stride}, {"count", count},
                                                     {"mode", mode},         {"filter", filter}};
    builder.add("bufferViews", view);
    return builder;
}

template <class T>
std::vector<unsigned char> encode_vertices(const std::vector<T>& vertices) {
    std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(T)));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), vertices.data(), vertices.size(), sizeof(T)));
    return out;
}

std::string error_of(const GltfBuilder& builder) {
    const auto document = read_document(builder.glb(), {}, "test.glb");
    return document.ok() ? "no error" : document.error().text();
}

struct Point {
    float x, y, z, w;
};

std::vector<Point> some_points() {
    std::vector<Point> points;
    for (int i = 0; i < 300; ++i) points.push_back({std::sin(float(i)), float(i), 0.0f, -float(i)});
    return points;
}

TEST(GltfMeshopt, DecodesAttributes) {
    const std::vector<Point> points = some_points();
    GltfBuilder builder = compressed_document(encode_vertices(points), points.size(), sizeof(Point), "ATTRIBUTES");
    builder.accessor(0, 5126, "VEC3", points.size());
    const auto document = read_document(builder.glb(), {}, "test.glb");
    ASSERT_TRUE(document.ok()) << document.error().text();
    const auto view = open_accessor(**document, 0);
    ASSERT_TRUE(view.ok()) << view.error().text();
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(view->number(i, 0), points[i].x);
        EXPECT_EQ(view->number(i, 1), points[i].y) << "the stride of 16 is the extension's";
    }
}

TEST(GltfMeshopt, DecodesTrianglesAndIndices) {
    const std::vector<unsigned> indices{0, 1, 2, 2, 1, 3, 4, 6, 5, 7, 8, 9};
    std::vector<unsigned char> triangles(meshopt_encodeIndexBufferBound(indices.size(), 10));
    triangles.resize(meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), indices.data(), indices.size()));
    std::vector<unsigned char> sequence(meshopt_encodeIndexSequenceBound(indices.size(), 10));
    sequence.resize(meshopt_encodeIndexSequence(sequence.data(), sequence.size(), indices.data(), indices.size()));
    for (const bool as_triangles : {true, false}) {
        GltfBuilder builder = compressed_document(as_triangles ? triangles : sequence, indices.size(), 2,
                                                  as_triangles ? "TRIANGLES" : "INDICES");
        builder.accessor(0, 5123, "SCALAR", indices.size());
        const auto document = read_document(builder.glb(), {}, "test.glb");
        ASSERT_TRUE(document.ok()) << document.error().text();
        const auto view = open_accessor(**document, 0);
        std::vector<unsigned> read;
        for (std::size_t i = 0; i < indices.size(); ++i) read.push_back(view->index(i));
        if (!as_triangles) {
            EXPECT_EQ(read, indices);
        }
        // The triangle codec may turn a triangle, but keeps its winding.
        for (std::size_t t = 0; as_triangles && t < indices.size(); t += 3) {
            const unsigned turn = static_cast<unsigned>(std::find(&read[t], &read[t] + 3, indices[t]) - &read[t]);
            for (unsigned k = 0; k < 3; ++k) EXPECT_EQ(read[t + (turn + k) % 3], indices[t + k]) << t;
        }
    }
}

TEST(GltfMeshopt, DecodesOctahedralNormals) {
    const float normals[8] = {0.6f, 0.0f, 0.8f, 0.0f, 0.0f, -1.0f, 0.0f, 0.0f};
    std::vector<std::array<std::int8_t, 4>> encoded(2);
    meshopt_encodeFilterOct(encoded.data(), 2, 4, 8, normals);
    GltfBuilder builder = compressed_document(encode_vertices(encoded), 2, 4, "ATTRIBUTES", "OCTAHEDRAL");
    builder.accessor(0, 5120, "VEC3", 2, true);
    const auto document = read_document(builder.glb(), {}, "test.glb");
    ASSERT_TRUE(document.ok()) << document.error().text();
    const auto view = open_accessor(**document, 0);
    // 8 bits: half a step of 1/127 in the square, not quite doubled by the projection.
    EXPECT_NEAR(view->number(0, 0), 0.6f, 0.015f);
    EXPECT_NEAR(view->number(0, 2), 0.8f, 0.015f);
    EXPECT_NEAR(view->number(1, 1), -1.0f, 0.015f);
}

TEST(GltfMeshopt, RefusesDamage) {
    const std::vector<Point> points = some_points();
    const std::vector<unsigned char> good = encode_vertices(points);
    const auto document = [&](const std::vector<unsigned char>& data, std::size_t count, std::size_t stride,
                              const char* mode, const char* filter = "NONE") {
        return error_of(compressed_document(data, count, stride, mode, filter));
    };
    EXPECT_EQ(document(good, 300, 16, "ATTRIBUTES"), "no error");
    std::vector<unsigned char> cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(good.size() / 2));
    EXPECT_NE(document(cut, 300, 16, "ATTRIBUTES").find("cannot be decoded"), std::string::npos);
    EXPECT_NE(document(good, 300, 15, "ATTRIBUTES").find("byteStride"), std::string::npos);
    EXPECT_NE(document(good, 300, 256, "ATTRIBUTES").find("byteStride"), std::string::npos);
    EXPECT_NE(document(good, 300, 0, "ATTRIBUTES").find("byteStride"), std::string::npos);
    EXPECT_NE(document(good, 300, 16, "TRIANGLES").find("byteStride"), std::string::npos);
    EXPECT_NE(document(good, 300, 16, "ATTRIBUTES", "QUATERNION").find("byteStride"), std::string::npos);
    EXPECT_NE(document(good, 301, 2, "TRIANGLES").find("multiple of three"), std::string::npos);
    EXPECT_NE(document(good, std::size_t{1} << 40, 16, "ATTRIBUTES").find("cannot hold"), std::string::npos);
    EXPECT_NE(document(good, 300, 16, "SOMETHING").find("SOMETHING"), std::string::npos);
}

}  // namespace
}  // namespace lumel
