#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "lumel/bake.h"
#include "support/traced_scene.h"

namespace lumel {
namespace {

TEST(Lighting, SkyIntensityAndRotationActOnTheScenesOwnSky) {
    Scene scene = test::room();
    BakeOptions options;
    options.sky.intensity = 2;
    ASSERT_TRUE(apply_lighting(scene, options).ok());
    EXPECT_EQ(scene.sky.color, (Vec3{0.8f, 1.2f, 2.0f}));

    scene.sky.map = SkyMap{2, 1, {Vec3{1, 2, 3}, Vec3{4, 5, 6}}};
    scene.sky.rotation = 0.25f;
    options.sky.rotation_degrees = 90;
    ASSERT_TRUE(apply_lighting(scene, options).ok());
    EXPECT_EQ(scene.sky.map->radiance[1], (Vec3{8, 10, 12}));
    EXPECT_FLOAT_EQ(scene.sky.rotation, 0.25f + 1.57079633f);
}

TEST(Lighting, SkyOptionsWithoutASkyToActOnAreUsageErrors) {
    const SkyMap map{2, 1, {Vec3{1, 1, 1}, Vec3{1, 1, 1}}};
    struct Case {
        const char* option;
        void (*set)(SkyOptions&);
        bool constant_will_do;
    };
    const Case cases[] = {
        {"--sky-intensity", [](SkyOptions& sky) { sky.intensity = 3; }, true},
        {"--sky-rotation", [](SkyOptions& sky) { sky.rotation_degrees = 10; }, false},
        {"--sky-blur", [](SkyOptions& sky) { sky.blur_degrees = 10; }, false},
        {"--sky-extract-sun", [](SkyOptions& sky) { sky.extract_sun = true; }, false},
    };
    for (const Case& c : cases) {
        BakeOptions options;
        c.set(options.sky);
        const auto names_the_option = [&](const Status& status) {
            return !status.ok() && status.error().code == ErrorCode::usage &&
                   status.error().message.find(c.option) == 0;
        };
        Scene none = test::room();
        none.sky = {};
        EXPECT_TRUE(names_the_option(apply_lighting(none, options))) << c.option;
        Scene constant = test::room();  // of the scene, then of the options
        EXPECT_EQ(apply_lighting(constant, options).ok(), c.constant_will_do) << c.option;
        options.sky.color = Vec3{1, 1, 1};
        EXPECT_EQ(apply_lighting(none, options).ok(), c.constant_will_do) << c.option;
        if (options.sky.extract_sun) continue;  // this map has none
        options.sky.color.reset();
        none.sky.map = map;
        EXPECT_TRUE(apply_lighting(none, options).ok()) << c.option;
    }
}

TEST(Lighting, TheOptionsSkyReplacesTheScenes) {
    Scene scene = test::room();
    scene.sky.rotation = 0.25f;
    BakeOptions options;
    options.sky.color = Vec3{1, 2, 3};
    options.sky.intensity = 2;
    ASSERT_TRUE(apply_lighting(scene, options).ok());
    EXPECT_EQ(scene.sky.color, (Vec3{2, 4, 6}));
    EXPECT_EQ(scene.sky.rotation, 0.0f);
}

TEST(Lighting, AMapWithoutASunToExtractIsNamed) {
    Scene scene = test::room();
    scene.sky.map = SkyMap{16, 8, std::vector<Vec3>(128, {1, 1, 1})};
    BakeOptions options;
    options.sky.file = "even.hdr";
    options.sky.extract_sun = true;
    const Status status = apply_lighting(scene, options);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().where, "even.hdr");
    EXPECT_NE(status.error().remedy.find("--sky-extract-sun"), std::string::npos);
}

TEST(Lighting, TooBrightIsAnErrorThatNamesTheRemedy) {
    for (const double intensity : {2e12, 3e38, 1e300}) {
        Scene scene = test::room();
        scene.sky.map = SkyMap{2, 1, {Vec3{1, 1, 1}, Vec3{1, 10, 1}}};
        BakeOptions options;
        options.sky.intensity = intensity;
        options.sky.blur_degrees = 5;
        const Status status = apply_lighting(scene, options);
        ASSERT_FALSE(status.ok()) << intensity;
        EXPECT_EQ(status.error().code, ErrorCode::invalid_input);
        EXPECT_NE(status.error().text().find("--sky-intensity"), std::string::npos) << status.error().text();

        scene = test::room();
        BakeOptions sun;
        sun.sun.direction = Vec3{0, -1, 0};
        sun.sun.illuminance = intensity;
        const Status bright_sun = apply_lighting(scene, sun);
        ASSERT_FALSE(bright_sun.ok()) << intensity;
        EXPECT_NE(bright_sun.error().text().find("--sun-direction"), std::string::npos) << bright_sun.error().text();
    }
}

TEST(Lighting, TheSunsDirectionMayHaveAnyLength) {
    for (const float length : {1e-30f, 1.0f, 1e30f}) {
        Scene scene = test::room();
        BakeOptions options;
        options.sun.direction = Vec3{0, -3, 4} * length;
        ASSERT_TRUE(apply_lighting(scene, options).ok()) << length;
        EXPECT_NEAR(scene.lights.back().direction.y, -0.6f, 1e-6f) << length;
        EXPECT_NEAR(scene.lights.back().direction.z, 0.8f, 1e-6f) << length;
    }
}

TEST(Lighting, ASunOfNoLuxIsBlack) {
    for (const double lux : {100000.0, 0.0}) {
        Scene scene = test::room();
        BakeOptions options;
        options.sun.direction = Vec3{0, -1, 0};
        if (lux == 0.0) options.sun.illuminance = 0.0;  // else as it is by default
        ASSERT_TRUE(apply_lighting(scene, options).ok());
        EXPECT_EQ(scene.lights.back().intensity, (Vec3{1, 1, 1} * float(lux)));
    }
}

}  // namespace
}  // namespace lumel
