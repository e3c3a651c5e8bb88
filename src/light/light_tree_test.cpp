#include "light/light_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "math/discrete.h"
#include "math/frame.h"
#include "math/warp.h"
#include "support/light_checks.h"

namespace lumel {
namespace {

constexpr Vec3 kUp{0, 1, 0};
constexpr std::size_t kGroups = 8;

LightBounds point_bounds(Vec3 at, double intensity) {
    LightBounds b;
    b.low = b.high = at;
    b.intensity = intensity;
    b.must_be_sampled = true;
    return b;
}

template <class Where>
double importance(const LightBounds& light, const Where& where) {
    PreparedBounds<1> bounds;
    bounds.set(0, light);
    return bounds.importance(where)[0];
}

LightBounds patch_bounds(Vec3 centre, float half, Vec3 normal, double intensity) {
    LightBounds b;
    b.low = centre - Vec3{half, half, half};
    b.high = centre + Vec3{half, half, half};
    b.axis = normal;
    b.cos_facing = 1.0f;
    b.intensity = intensity;
    return b;
}

// Points, patches that face all ways, spots, things that reach a metre: in a cube of 10 m.
std::vector<LightBounds> crowd(std::size_t count, std::uint32_t seed) {
    test::Random random(seed);
    std::vector<LightBounds> lights;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 a = random.pair(), b = random.pair();
        const Vec3 at = Vec3{a.x, a.y, b.x} * 10.0f;
        const Vec2 u = random.pair();
        const Vec3 axis = direction_from_z(1.0f - 2.0f * u.x, u.y);
        LightBounds light =
            i % 3 == 0 ? point_bounds(at, 0.1 + double{b.y}) : patch_bounds(at, 0.3f * b.y, axis, 0.01 + double{b.y});
        if (i % 5 == 0) {
            light.axis = axis;
            light.cos_facing = 0.9f;
            light.cos_emission = 0.8f;
        }
        if (i % 7 == 0) light.reach = 1.0f;
        if (i % 11 == 0) light.both_sides = true;
        lights.push_back(light);
    }
    return lights;
}

std::vector<Receiver> receivers(std::size_t count) {
    test::Random random(99);
    std::vector<Receiver> out;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 a = random.pair(), u = random.pair();
        out.push_back(
            {Vec3{a.x, a.y, random.unit()} * 12.0f - Vec3{1, 1, 1}, direction_from_z(1.0f - 2.0f * u.x, u.y)});
    }
    return out;
}

// Every unit of the random number belongs to a light, and to no other than it is stated for.
TEST(LightTree, StatesExactlyHowOftenEachLightIsChosen) {
    for (const std::size_t count : {1u, 2u, 3u, 40u, 1000u}) {
        const std::vector<LightBounds> lights = crowd(count, 3);
        const LightTree tree(lights, kGroups);
        for (const Receiver& receiver : receivers(20)) {
            // The lights' units, one after another in the order of the tree, fill the numbers from 0 on.
            std::uint64_t unit = 0;
            while (unit < kUnits) {
                const LightTree::Chosen chosen = tree.choose(receiver, static_cast<float>(unit) * 0x1p-24f);
                if (chosen.light == LightTree::kNoLight) break;
                ASSERT_GT(chosen.units, 0u);
                ASSERT_EQ(tree.units_of(receiver, chosen.light), chosen.units);
                const LightTree::Chosen last =
                    tree.choose(receiver, static_cast<float>(unit + chosen.units - 1) * 0x1p-24f);
                ASSERT_EQ(last.light, chosen.light) << "the interval is shorter than stated";
                unit += chosen.units;
            }
            // Numbers that choose nothing come in whole subtrees; those lights have no units.
            std::uint64_t stated = 0;
            for (std::uint32_t light = 0; light < count; ++light) stated += tree.units_of(receiver, light);
            EXPECT_LE(stated, kUnits);
            EXPECT_GE(stated, unit);
        }
    }
}

// Groups share all lights among them, and below their roots they choose as the whole tree does.
TEST(LightTree, GroupsHaveEachLightOnce) {
    for (const std::size_t count : {1u, 2u, 40u, 300u}) {
        const std::vector<LightBounds> lights = crowd(count, 5);
        for (const std::size_t most : {1u, 2u, 16u, 500u}) {
            const LightTree tree(lights, most);
            const std::span<const LightTree::Subtree> groups = tree.groups();
            EXPECT_EQ(groups.size(), std::min(most, count));
            const std::span<const std::uint32_t> group_of = tree.group_of_lights();
            std::vector<std::uint32_t> guaranteed(groups.size());
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_LT(group_of[i], groups.size()) << i;
                guaranteed[group_of[i]] += lights[i].must_be_sampled ? 1 : 0;
            }
            for (std::size_t g = 0; g < groups.size(); ++g) EXPECT_EQ(groups[g].guaranteed, guaranteed[g]);
        }
    }
}

TEST(LightTree, GroupsStateExactlyHowOftenEachLightIsChosen) {
    const std::vector<LightBounds> lights = crowd(200, 6);
    const LightTree tree(lights, kGroups);
    const std::span<const LightTree::Subtree> groups = tree.groups();
    const std::span<const std::uint32_t> group_of = tree.group_of_lights();
    constexpr std::uint32_t kGiven = 4000;  // of a group, more than it has lights
    std::size_t chosen_lights = 0;
    for (const Receiver& receiver : receivers(10)) {
        std::vector<std::uint32_t> chosen(lights.size());
        for (const LightTree::Subtree& group : groups)
            for (std::uint32_t unit = 0; unit < kGiven; ++unit) {
                const LightTree::Chosen c = tree.choose_in(group, unit, kGiven, receiver);
                if (c.light != LightTree::kNoLight) ++chosen[c.light];
            }
        for (std::uint32_t i = 0; i < lights.size(); ++i) {
            if (chosen[i] == 0) continue;  // or its part of the tree does not light the receiver
            EXPECT_EQ(tree.units_in(groups[group_of[i]], kGiven, receiver, i), chosen[i]);
            ++chosen_lights;
        }
    }
    EXPECT_GT(chosen_lights, 500u);
}

// What can light a receiver has a chance, however dim: else points and spots without a radius would be lost.
TEST(LightTree, LeavesOutNoLightThatMustBeSampled) {
    std::vector<LightBounds> lights = crowd(500, 4);
    for (std::size_t i = 0; i < lights.size(); i += 2) lights[i].intensity *= 1e-12;
    const LightTree tree(lights, kGroups);
    std::size_t lit = 0, dark = 0;
    for (const Receiver& receiver : receivers(200))
        for (std::uint32_t i = 0; i < lights.size(); ++i) {
            const std::uint32_t units = tree.units_of(receiver, i);
            if (!lights[i].must_be_sampled) continue;
            const bool lights_it = importance(lights[i], receiver) > 0.0;
            (lights_it ? lit : dark) += 1;
            if (lights_it) {
                ASSERT_GT(units, 0u) << i;
            }
        }
    EXPECT_GT(lit, 1000u);
    EXPECT_GT(dark, 1000u);
}

// A group is dark only if all in it are: what must be sampled and lights the receiver keeps its unit under every split.
TEST(LightTree, ALightLosesNothingInCompany) {
    for (std::uint32_t seed = 20; seed < 40; ++seed) {
        const std::vector<LightBounds> lights = crowd(30, seed);
        const LightTree tree(lights, kGroups);
        for (const Receiver& receiver : receivers(50))
            for (std::uint32_t i = 0; i < lights.size(); ++i) {
                const LightTree alone(std::vector<LightBounds>{lights[i]}, kGroups);
                if (lights[i].must_be_sampled && alone.units_of(receiver, 0) > 0) {
                    EXPECT_GT(tree.units_of(receiver, i), 0u) << seed << " " << i;
                }
            }
    }
}

// A light's importance is the same bits in any company: the chance of a light must not depend on who asks.
TEST(Importance, IsTheSameBitsAloneAndAmongEight) {
    const std::vector<LightBounds> lights = crowd(400, 7);
    std::size_t lit = 0;
    for (std::size_t first = 0; first < lights.size(); first += 8) {
        PreparedBounds<8> eight;
        for (std::size_t i = 0; i < 8; ++i) eight.set(i, lights[first + i]);
        for (const Receiver& receiver : receivers(50)) {
            const std::array<double, 8> together = eight.importance(receiver);
            for (std::size_t i = 0; i < 8; ++i) {
                ASSERT_EQ(together[i], importance(lights[first + i], receiver)) << first + i;
                lit += together[i] > 0.0 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(lit, 1000u);
}

// Zero importance promises darkness: no point of a patch sees the receiver from its lit side, above its horizon.
// Bounds of groups are wider by a rounding, whose rim is where a cosine changes its sign: what is looked at from there
// is found by bisection, then step by step around it.
TEST(Importance, IsNeverNegative) {
    LightBounds b;
    b.low = {-0.1f, -0.1f, -0.1f};
    b.high = {0.1f, 0.1f, 0.1f};
    b.cos_facing = 0.9f;
    b.cos_emission = -1e-6f;
    b.intensity = 1.0;
    const auto seen_from = [&](float angle) {
        const Vec3 at = Vec3{std::sin(angle), 0.0f, std::cos(angle)} * 3.0f;
        return importance(b, Receiver{at, normalize(at * -1.0f)});
    };
    float lit = 1.5f, dark = 3.0f;
    ASSERT_GT(seen_from(lit), 0.0);
    ASSERT_EQ(seen_from(dark), 0.0);
    for (int k = 0; k < 40; ++k) {
        const float middle = 0.5f * (lit + dark);
        (seen_from(middle) != 0.0 ? lit : dark) = middle;
    }
    float angle = lit;
    for (int k = 0; k < 300; ++k) angle = std::nextafter(angle, 0.0f);
    for (int k = 0; k < 600; ++k, angle = std::nextafter(angle, 4.0f)) ASSERT_GE(seen_from(angle), 0.0) << k;
}

TEST(Importance, OfZeroIsDarkness) {
    test::Random random(6);
    int zeros = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec2 u = random.pair(), v = random.pair();
        const Vec3 normal = direction_from_z(1.0f - 2.0f * u.x, u.y);
        const float half = 0.5f * random.unit();
        const Vec3 centre = Vec3{v.x, v.y, random.unit()} * 4.0f - Vec3{2, 2, 2};
        const Frame frame(normal);
        LightBounds b = patch_bounds(centre, 0, normal, 1.0);
        for (int k = 0; k < 4; ++k) {
            const Vec3 corner = centre + frame.to_world({k & 1 ? half : -half, k & 2 ? half : -half, 0});
            for (std::size_t c = 0; c < 3; ++c) {
                b.low[c] = std::min(b.low[c], corner[c]);
                b.high[c] = std::max(b.high[c], corner[c]);
            }
        }
        const Receiver receiver{{0, 0, 0}, kUp};
        if (importance(b, receiver) > 0.0) continue;
        ++zeros;
        for (int k = 0; k < 16; ++k) {
            const Vec2 s = random.pair();
            const Vec3 p = centre + frame.to_world({half * (2 * s.x - 1), half * (2 * s.y - 1), 0});
            // A hair above zero is rounding.
            EXPECT_LT(std::min(dot(p, kUp), -dot(p, normal)), 1e-5f);
        }
    }
    EXPECT_GT(zeros, 2000);
}

// What lights any receiver of a region has a chance in it.
TEST(Importance, OfARegionIsZeroOnlyIfThatOfAllItsReceiversIs) {
    test::Random random(8);
    const auto direction = [&] {
        const Vec2 u = random.pair();
        return direction_from_z(1.0f - 2.0f * u.x, u.y);
    };
    int zeros = 0, rims = 0;
    for (const LightBounds& light : crowd(3000, 4)) {
        const Vec2 a = random.pair();
        ReceiverRegion region{Vec3{a.x, a.y, random.unit()} * 10.0f, direction(), 0.5f * random.unit()};
        region.cos_normals = 1.0f - 0.5f * random.unit();
        const bool lit = importance(light, region) > 0.0;
        const double centre = importance(light, Receiver{region.centre, region.axis});
        // A region of one receiver: the same but for the root of a square.
        EXPECT_NEAR(importance(light, ReceiverRegion{region.centre, region.axis}), centre, 1e-5 * centre);
        rims += lit && !(centre > 0.0);
        zeros += !lit;
        for (int k = 0; k < 64 && !lit; ++k) {
            const Vec3 position = region.centre + direction() * (region.radius * random.unit());
            const float cosine = region.cos_normals + (1.0f - region.cos_normals) * random.unit();
            const Vec3 normal = Frame(region.axis).to_world(direction_from_z(cosine, random.unit()));
            EXPECT_EQ(importance(light, Receiver{position, normal}), 0.0);
        }
    }
    EXPECT_GT(zeros, 500);
    EXPECT_GT(rims, 100);
}

TEST(LightTree, PrefersWhatIsNearAndFacesTheReceiver) {
    const std::vector<LightBounds> lights{
        patch_bounds({0, 1, 0}, 0.1f, {0, -1, 0}, 1.0), patch_bounds({0, 3, 0}, 0.1f, {0, -1, 0}, 1.0),
        patch_bounds({1, 1, 0}, 0.1f, {0, 1, 0}, 1.0), patch_bounds({0, -1, 0}, 0.1f, {0, 1, 0}, 1.0)};
    const LightTree tree(lights, kGroups);
    const Receiver receiver{{0, 0, 0}, kUp};
    const double near = tree.units_of(receiver, 0), far = tree.units_of(receiver, 1);
    EXPECT_GT(near, 5 * far);  // nine times as bright, where the group of both is looked at exactly
    EXPECT_GT(far, 0);
    EXPECT_EQ(tree.units_of(receiver, 2), 0u) << "faces away";
    EXPECT_EQ(tree.units_of(receiver, 3), 0u) << "below the horizon";
}

// A ceiling of panels that shine down and, a floor above, brighter ones that shine up, turned about the origin.
std::vector<LightBounds> turned_ceiling(const Frame& turn) {
    std::vector<LightBounds> lights;
    for (int i = 0; i < 64; ++i)
        for (const float height : {3.0f, 6.0f}) {
            const Vec3 at{0.5f * static_cast<float>(i % 8) - 2.0f, height, 0.5f * static_cast<float>(i / 8) - 2.0f};
            lights.push_back(patch_bounds(turn.to_world(at), 0.02f, turn.to_world({0, height > 3.0f ? 1.0f : -1.0f, 0}),
                                          height > 3.0f ? 10.0 : 1.0));
        }
    return lights;
}

// Rounding of normals that are one and the same must not make a group shine all ways: what faces away gets nothing,
// whichever way the scene is turned.
TEST(LightTree, GroupsOfParallelPanelsKeepTheirDirection) {
    test::Random random(8);
    for (int i = 0; i < 200; ++i) {
        const Vec2 u = random.pair();
        const Frame turn(i == 0 ? Vec3{0, 0, 1} : direction_from_z(1.0f - 2.0f * u.x, u.y));
        const std::vector<LightBounds> lights = turned_ceiling(turn);
        const LightTree tree(lights, kGroups);
        const Receiver receiver{{0, 0, 0}, turn.to_world({0, 1, 0})};
        std::uint64_t down = 0;
        for (std::uint32_t k = 0; k < lights.size(); k += 2) down += tree.units_of(receiver, k);
        EXPECT_GT(static_cast<double>(down), 0.99 * kUnits) << i;
    }
}

TEST(LightTree, ManyLightsAtOnePlaceAreFoundAgain) {
    std::vector<LightBounds> lights(5000, point_bounds({1, 2, 3}, 1.0));
    // And a row whose gaps double: splits that always cut off one light.
    for (int i = 0; i < 100; ++i) lights.push_back(point_bounds({std::ldexp(1.0f, i - 50), 0, 0}, 1.0));
    const LightTree tree(lights, kGroups);
    const Receiver receiver{{0, -1, 0}, kUp};
    std::uint64_t units = 0;
    for (std::uint32_t i = 0; i < lights.size(); ++i) units += tree.units_of(receiver, i);
    EXPECT_EQ(units, kUnits);
}

TEST(LightTree, OfNothingChoosesNothing) {
    const LightTree none;
    EXPECT_EQ(none.choose({{0, 0, 0}, kUp}, 0.5f).light, LightTree::kNoLight);
    const LightTree dark(std::vector<LightBounds>{point_bounds({0, 1, 0}, 0.0)}, kGroups);
    EXPECT_EQ(dark.choose({{0, 0, 0}, kUp}, 0.5f).light, LightTree::kNoLight);
    EXPECT_EQ(dark.units_of({{0, 0, 0}, kUp}, 0), 0u);
}

}  // namespace
}  // namespace lumel
