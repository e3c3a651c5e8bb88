#include <gtest/gtest.h>

#include <cmath>

#include "io/image_io.h"
#include "light/light_sample.h"
#include "light/sky_map.h"
#include "math/constants.h"
#include "support/sky_maps.h"
#include "support/test_data.h"

namespace lumel {
namespace {

constexpr float kDegrees = kPi / 180.0f;

// A disc of the given radiance about a direction, its edge smoothed over the pixels it cuts.
SkyMap with_sun(SkyMap map, Vec3 towards, float angular_diameter, Vec3 radiance) {
    constexpr int kSub = 6;
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            int inside = 0;
            for (int j = 0; j < kSub; ++j)
                for (int i = 0; i < kSub; ++i) {
                    const float u =
                        (static_cast<float>(x) + (static_cast<float>(i) + 0.5f) / kSub) / static_cast<float>(map.width);
                    const float v = (static_cast<float>(y) + (static_cast<float>(j) + 0.5f) / kSub) /
                                    static_cast<float>(map.height);
                    const Vec3 across = cross(sky_direction(u, v), towards);
                    inside += length(across) < std::sin(angular_diameter / 2) && dot(sky_direction(u, v), towards) > 0;
                }
            const float share = static_cast<float>(inside) / (kSub * kSub);
            Vec3& pixel = map.radiance[std::size_t{y} * map.width + x];
            pixel = pixel * (1 - share) + radiance * share;
        }
    return map;
}

TEST(ExtractSun, FindsItsDirectionColourSizeAndIlluminance) {
    const Vec3 radiance{50000, 40000, 30000};
    const float diameter = 2.0f * kDegrees;
    // Across the seam of the map, near the pole, over the pole, at the horizon.
    for (const Vec3 towards : {normalize({-1, 0.6f, 0.01f}), normalize({0.02f, 1, 0.03f}),
                               normalize({0.004f, 1, 0.003f}), normalize({0.5f, 0.02f, 0.8f})}) {
        const SkyMap plain = test::gradient_sky(512, 256, 1.0f, 0.5f);
        const SkyMap map = with_sun(plain, towards, diameter, radiance);
        const Result<ExtractedSun> result = extract_sun(map);
        ASSERT_TRUE(result.ok()) << result.error().text();
        const Light& sun = result->sun;
        EXPECT_EQ(sun.shape, LightShape::sun);
        EXPECT_NEAR(std::acos(std::min(1.0f, -dot(sun.direction, towards))), 0.0, 0.1 * kDegrees);
        // Half the error of the solid angle that the map's pixels of 0.7 degrees give the disc.
        EXPECT_NEAR(sun.angular_diameter / diameter, 1.0, 0.05);
        const auto with = integrate(map), without = integrate(plain);
        for (std::size_t k = 0; k < 3; ++k)  // pixels of the edge below 2 % of the peak stay
            EXPECT_NEAR(sun.intensity[k] / (with[k] - without[k]), 1.0, 1e-3) << k;
        // Nothing bright is left.
        for (const Vec3 c : result->sky.radiance) ASSERT_LT(max_component(c), 1000.0f);  // 2 % of the peak
    }
}

TEST(ExtractSun, MovesLightFromTheMapToTheSunAndLosesNone) {
    const SkyMap map =
        with_sun(test::random_sky(256, 128, 4), normalize({0.3f, 0.7f, -0.2f}), 1.0f * kDegrees, {1e6f, 9e5f, 8e5f});
    const Result<ExtractedSun> result = extract_sun(map);
    ASSERT_TRUE(result.ok()) << result.error().text();
    const auto before = integrate(map), after = integrate(result->sky);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((after[k] + result->sun.intensity[k]) / before[k], 1.0, 1e-6) << k;
}

TEST(ExtractSun, SaysWhereThereIsNone) {
    const Result<ExtractedSun> overcast = extract_sun(test::gradient_sky(128, 64, 1.0f, 0.5f));
    ASSERT_FALSE(overcast.ok());
    EXPECT_EQ(overcast.error().code, ErrorCode::unsupported);
    // A bright window ten degrees wide is no sun.
    const SkyMap window = with_sun(test::gradient_sky(256, 128, 1.0f, 0.5f), {1, 0, 0}, 10 * kDegrees, {900, 900, 900});
    EXPECT_FALSE(extract_sun(window).ok());
    EXPECT_FALSE(extract_sun(test::gradient_sky(64, 32, 0.0f, 0.0f)).ok());  // black
}

TEST(ExtractSun, WorksOnPhotographedSkies) {
    struct Expected {
        const char* file;
        bool sun;
        double least_share, most_share;  // of the map's light
    };
    // Shares from looking at the pixels: all but the glow around the disc.
    for (const Expected& e : {Expected{"env/kloppenheim_05_512.hdr", true, 0.60, 0.66},
                              {"env/noon_grass_512.hdr", true, 0.50, 0.60},
                              {"env/spiaggia_di_mondello_1k.hdr", true, 0.42, 0.52},
                              {"env/venice_sunset_512.hdr", true, 0.02, 0.04},
                              {"env/vestibule_512.hdr", false, 0, 0},
                              {"env/leadenhall_market_512.hdr", false, 0, 0}}) {
        const auto path = test::data_file(e.file);
        if (!path) GTEST_SKIP() << "no " << e.file << " (set LUMEL_DATA)";
        const Result<SkyMap> map = read_sky(*path);
        ASSERT_TRUE(map.ok()) << map.error().text();
        const Result<ExtractedSun> result = extract_sun(*map);
        ASSERT_EQ(result.ok(), e.sun) << e.file;
        if (!e.sun) continue;
        const auto before = integrate(*map), after = integrate(result->sky);
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR((after[k] + result->sun.intensity[k]) / before[k], 1.0, 1e-6) << e.file << " " << k;
        const double share = strength(result->sun.intensity) / ((before[0] + before[1] + before[2]) / 3);
        EXPECT_GT(share, e.least_share) << e.file;
        EXPECT_LT(share, e.most_share) << e.file;
        EXPECT_LT(result->sun.angular_diameter, 1.3f * kDegrees) << e.file;
    }
}

}  // namespace
}  // namespace lumel
