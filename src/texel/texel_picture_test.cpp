// Pictures of pages: what they show where, and black where nothing is covered.
#include "texel/texel_picture.h"

#include <gtest/gtest.h>

#include "support/flat_page.h"

namespace lumel {
namespace {

Vec3 pixel(const Image& image, std::uint32_t x, std::uint32_t y) {
    const float* p = image.at(x, y);
    return {p[0], p[1], p[2]};
}

TEST(TexelPicture, ShowsWhatThePageHolds) {
    test::FlatPage page;
    page.width = 12;
    page.height = 8;
    page.add_quad({1, 2}, {8, 0}, {0, 4});
    page.add({Vec2{10.4f, 6.4f}, {10.41f, 6.4f}, {10.4f, 6.41f}}, 1);  // between sample points
    const test::BakedPage baked(page);
    const Image position = position_picture(baked.texels), normal = normal_picture(baked.texels);
    const Image size = world_size_picture(baked.texels), triangle = triangle_picture(baked.texels);
    const Image validity = validity_picture(baked.texels);
    for (const Image* image : {&position, &normal, &size, &triangle, &validity}) {
        ASSERT_EQ(image->width, 12u);
        ASSERT_EQ(image->height, 8u);
        EXPECT_EQ(pixel(*image, 0, 0), Vec3{});
        EXPECT_EQ(pixel(*image, 9, 2), Vec3{});
        EXPECT_NE(pixel(*image, 8, 5), Vec3{});
        for (const float value : image->data) EXPECT_TRUE(value >= 0.0f && value <= 1.0f);
    }
    EXPECT_EQ(pixel(normal, 3, 3), (Vec3{0.5f, 1.0f, 0.5f}));
    EXPECT_EQ(pixel(validity, 3, 3), (Vec3{1, 1, 1}));
    EXPECT_EQ(pixel(validity, 10, 6), (Vec3{1, 0, 0}));
    EXPECT_LT(position.at(2, 3)[0], position.at(7, 3)[0]);  // x grows to the right
    EXPECT_EQ(pixel(size, 2, 3), pixel(size, 7, 4));        // one density
    EXPECT_NE(pixel(triangle, 8, 2), pixel(triangle, 1, 5));
}

TEST(TexelPicture, EmptyPagesAreBlack) {
    TexelBuffer texels;
    texels.width = 4;
    texels.height = 3;
    for (const Image& image : {position_picture(texels), normal_picture(texels), world_size_picture(texels),
                               triangle_picture(texels), validity_picture(texels)}) {
        EXPECT_EQ(image.data.size(), 36u);
        for (const float value : image.data) EXPECT_EQ(value, 0.0f);
    }
}

}  // namespace
}  // namespace lumel
