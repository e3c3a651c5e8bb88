#include "render/picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/constants.h"
#include "support/traced_scene.h"

namespace lumel {
namespace {

// A wall that fills the view of `front_view`, and another behind it.
constexpr Vec3 kNearGlow{1, 2, 3}, kFarGlow{4, 5, 6};

Scene walls(bool near_faces_camera, bool double_sided) {
    test::SceneBuilder b;
    const auto near = b.material({0.5f, 0.25f, 0.125f}, kNearGlow, double_sided);
    const auto far = b.material({0, 0, 0}, kFarGlow);
    b.object("near", near, [&](Mesh& m) {
        if (near_faces_camera)
            test::add_quad(m, {-9, -9, 0}, {18, 0, 0}, {0, 18, 0});
        else
            test::add_quad(m, {-9, -9, 0}, {0, 18, 0}, {18, 0, 0});
    });
    b.object("far", far, [](Mesh& m) { test::add_quad(m, {-9, -9, -1}, {18, 0, 0}, {0, 18, 0}); });
    return b.build();
}

Camera front_view() { return look_at({0, 0, 2}, {0, 0, 0}, 0.8f); }

Image picture(const test::TracedScene& traced, const Camera& camera, const BakedLight* baked = nullptr,
              std::uint32_t samples = 4, std::uint32_t bounces = 0) {
    Context context(2);
    PathOptions path;
    path.bounces = bounces;
    return render_picture(traced.transport, path, camera, {6, 4, samples}, baked, context).value();
}

Vec3 pixel(const Image& image, std::uint32_t x, std::uint32_t y) {
    return {image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]};
}

void expect_everywhere(const Image& image, Vec3 expected, float relative) {
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(pixel(image, x, y)[c], expected[c], relative * expected[c]) << x << " " << y << " " << c;
}

constexpr float kRounding = 1e-5f;  // means of a few samples in single precision

TEST(Picture, SurfacesShowWhatTheyEmit) {
    Context context(1);
    const test::TracedScene traced(walls(true, false), context);
    expect_everywhere(picture(traced, front_view()), kNearGlow, kRounding);
}

TEST(Picture, SingleSidedSurfacesAreNotSeenFromBehind) {
    Context context(1);
    const test::TracedScene single(walls(false, false), context);
    expect_everywhere(picture(single, front_view()), kFarGlow, kRounding);
    const test::TracedScene both(walls(false, true), context);
    // The glow of the far wall lights nothing of the near one that is seen.
    expect_everywhere(picture(both, front_view()), kNearGlow, kRounding);
}

TEST(Picture, MissesShowTheSky) {
    Context context(1);
    Scene scene = walls(true, false);
    scene.sky.color = {0.25f, 0.5f, 0.75f};
    const test::TracedScene traced(std::move(scene), context);
    expect_everywhere(picture(traced, look_at({0, 0, 2}, {0, 0, 9}, 0.8f)), {0.25f, 0.5f, 0.75f}, kRounding);
}

TEST(Picture, TheBakeLightsFrontFacesOnly) {
    Context context(1);
    const BakedLight two{[](std::uint32_t, float, float) { return Vec3{2, 2, 2}; }};
    const test::TracedScene front(walls(true, true), context);
    expect_everywhere(picture(front, front_view(), &two), kNearGlow + Vec3{0.5f, 0.25f, 0.125f} * 2.0f, kRounding);
    const test::TracedScene back(walls(false, true), context);
    expect_everywhere(picture(back, front_view(), &two), kNearGlow, kRounding);
}

TEST(Picture, WhatHasNoTexelsIsTraced) {
    Context context(1);
    Scene scene = walls(true, false);
    scene.sky.color = {1, 1, 1};
    const test::TracedScene traced(std::move(scene), context);
    const BakedLight none{[](std::uint32_t, float, float) { return std::optional<Vec3>(); }};
    const Image with = picture(traced, front_view(), &none, 64), without = picture(traced, front_view(), nullptr, 64);
    EXPECT_EQ(with.data, without.data);
    // A free wall under a white sky: E/pi = 1 on all that is seen.
    expect_everywhere(with, kNearGlow + Vec3{0.5f, 0.25f, 0.125f}, 0.05f);  // 64 paths: 1 % of noise
}

// A floor before the back of a wall: the sun on it is what it is in the open.
TEST(Picture, ABackDoesNotBrightenTheSun) {
    Context context(1);
    test::SceneBuilder b;
    b.object("floor", b.material({0.5f, 0.5f, 0.5f}), [](Mesh& m) {
        test::add_quad(m, {-4, 0, 4}, {4, 0, 0}, {0, 0, -8});
    });
    b.object("wall", b.material({0.5f, 0.5f, 0.5f}), [](Mesh& m) {
        test::add_quad(m, {0, 0, 4}, {0, 0, -8}, {0, 3, 0});
    });
    Light& sun = b.light(LightShape::sun);
    sun.direction = normalize(Vec3{1, -1, 0});
    sun.intensity = {4, 4, 4};
    const test::TracedScene traced(b.build(), context);
    const float light = 0.5f * 4.0f * std::sqrt(0.5f) / kPi;
    const Camera camera = look_at({-1, 2, 0.01f}, {-1, 0, 0}, 0.5f);
    PathOptions path;
    path.bounces = 0;
    const Image image = render_picture(traced.transport, path, camera, {6, 4, 16}, nullptr, context).value();
    expect_everywhere(image, {light, light, light}, kRounding);
}

TEST(Picture, TheSameBitsForAnyNumberOfThreads) {
    Context context(1);
    const test::TracedScene traced(test::room(), context);
    const Camera camera = look_at({1.5f, 1, 4}, {1.5f, 1, 0}, 1.0f);
    PathOptions path;
    path.bounces = 4;
    Context one(1), eight(8);
    // More samples than a batch holds.
    const PictureOptions options{8, 6, kWavefrontLanes + 44};
    const Image a = render_picture(traced.transport, path, camera, options, nullptr, one).value();
    const Image b = render_picture(traced.transport, path, camera, options, nullptr, eight).value();
    EXPECT_EQ(a.data, b.data);
}

// Three boxes under a sky on a floor that has no texels.
Scene boxes() {
    test::SceneBuilder b;
    const auto white = b.material({0.8f, 0.6f, 0.7f});
    b.object("floor", white, [](Mesh& m) { test::add_quad(m, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8}); });
    for (const float x : {-2.0f, 0.0f, 2.0f})
        b.object("box", white, [x](Mesh& m) { test::add_box(m, {x - 0.5f, 0, -0.5f}, {x + 0.5f, 1, 0.5f}, false); });
    b.scene().sky.color = {0.4f, 0.6f, 1.0f};
    return b.build();
}

struct Level {
    Context context{2};
    test::TracedScene traced{boxes(), context};
    Camera camera = look_at({0, 3, 6}, {0, 0.5f, 0}, 0.9f);

    [[nodiscard]] std::optional<Vec3> light(std::uint32_t triangle) const {
        const std::uint32_t instance = traced.geometry.triangles[triangle].instance;
        if (instance == 0) return std::nullopt;
        return Vec3{1, 2, 3} * static_cast<float>(instance);
    }
    Image render(const BakedLight& baked) {
        PathOptions path;
        path.bounces = 1;
        return render_picture(traced.transport, path, camera, {48, 27, 80}, &baked, context).value();
    }
};

TEST(RenderPicture, OfABakeInPartsIsThatOfTheWhole) {
    Level level;
    const BakedLight whole{[&](std::uint32_t t, float, float) { return level.light(t); }};
    std::uint32_t loaded = 99;
    const BakedLight parts{
        [&](std::uint32_t t, float, float) {
            const auto light = level.light(t);
            if (!light) return light;
            return std::optional(level.traced.geometry.triangles[t].instance == loaded + 1 ? *light : Vec3{});
        },
        3,
        [&](std::uint32_t part) {
            loaded = part;
            return success();
        }};
    const Image a = level.render(whole), b = level.render(parts);
    float brightest = 0.0f;
    for (std::size_t i = 0; i < a.data.size(); ++i) {
        // The same 80 numbers summed in another order.
        EXPECT_NEAR(a.data[i], b.data[i], 1e-5f * (1.0f + a.data[i]));
        brightest = std::max(brightest, a.data[i]);
    }
    EXPECT_GT(brightest, 5.0f) << "the third box is not in the picture";
}

TEST(RenderPicture, APartThatCannotBeLoadedIsAnError) {
    Level level;
    const BakedLight broken{[](std::uint32_t, float, float) { return std::optional(Vec3{}); }, 2,
                            [](std::uint32_t part) -> Status {
                                if (part == 0) return success();
                                return Error{ErrorCode::io, "gone", {}, {}};
                            }};
    const auto picture = render_picture(level.traced.transport, {}, level.camera, {8, 8, 1}, &broken, level.context);
    ASSERT_FALSE(picture.ok());
    EXPECT_EQ(picture.error().message, "gone");
}

TEST(Views, TheScenesOwnCamerasComeFirst) {
    Context context(1);
    Scene scene = test::room();
    scene.cameras.push_back(look_at({1, 1, 3}, {1, 1, 0}, 0.7f));
    scene.cameras.back().name = "mine";
    const test::TracedScene traced(std::move(scene), context);
    const std::vector<Camera> views = choose_views(traced.transport, 3, context).value();
    ASSERT_EQ(views.size(), 3u);
    EXPECT_EQ(views[0].name, "mine");
    EXPECT_EQ(views[1].name, "view 1");
    EXPECT_EQ(views[2].name, "view 2");
    const std::vector<Camera> again = choose_views(traced.transport, 3, context).value();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(views[i].transform.translation, again[i].transform.translation) << i;
}

TEST(Views, ClosedRoomsAreLookedAtFromInsideAndOpenScenesFromOutside) {
    Context context(1);
    for (const bool inward : {true, false}) {
        test::SceneBuilder b;
        const auto glowing = b.material({0.5f, 0.5f, 0.5f}, {1, 1, 1});
        b.object("box", glowing, [&](Mesh& m) { test::add_box(m, {0, 0, 0}, {4, 3, 5}, inward); });
        const test::TracedScene traced(b.build(), context);
        const std::vector<Camera> views = choose_views(traced.transport, 2, context).value();
        ASSERT_EQ(views.size(), 2u);
        for (const Camera& view : views) {
            const Vec3 eye = view.transform.translation;
            const bool inside = eye.x > 0 && eye.x < 4 && eye.y > 0 && eye.y < 3 && eye.z > 0 && eye.z < 5;
            EXPECT_EQ(inside, inward) << view.name << " at " << eye.x << " " << eye.y << " " << eye.z;
            EXPECT_GE(view.transform.columns[2].y, 0.0f) << view.name << " does not look up";
        }
    }
}

TEST(LookAt, PutsTheTargetOnTheAxisAndKeepsUpUp) {
    const Camera camera = look_at({1, 2, 3}, {4, 0, -2}, 0.5f);
    const Vec3 forward = normalize(Vec3{3, -2, -5});
    const Vec3 back = camera.transform.columns[2];
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(back[c], -forward[c], 1e-6f);
    EXPECT_NEAR(camera.transform.columns[0].y, 0.0f, 1e-6f) << "the horizon is level";
    EXPECT_GT(camera.transform.columns[1].y, 0.0f);
    EXPECT_EQ(camera.vertical_fov, 0.5f);
}

}  // namespace
}  // namespace lumel
