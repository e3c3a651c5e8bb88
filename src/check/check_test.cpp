// A clean bake made of formulas, and its twins with one defect each: each is found, and nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "check/verdict.h"

namespace lumel {
namespace {

// Nothing stands anywhere.
class EmptyTracer : public Tracer {
public:
    void closest(std::span<const Ray>, std::span<Hit> hits) const override { std::ranges::fill(hits, Hit{}); }
    void occluded(std::span<const Ray>, std::span<std::uint8_t> blocked) const override {
        std::ranges::fill(blocked, std::uint8_t{0});
    }
    [[nodiscard]] TraceStatistics statistics() const override { return {}; }
    [[nodiscard]] std::string_view description() const override { return "empty"; }
};

constexpr std::uint32_t kTile = 30, kGap = 4, kPageWidth = 2 * kTile + 3 * kGap, kPageHeight = kTile + 2 * kGap;

// Where tile 0 or 1 begins on the page, texels: between the centres of two.
float left_of(std::uint32_t tile) { return static_cast<float>(kGap + tile * (kTile + kGap)) + 0.5f; }

void add_tile(std::uint32_t tile, CheckedBake& bake) {
    const auto corner = [&](float x, float z) {
        return std::pair(Vec3{static_cast<float>(tile) + x, 0, z},
                         Vec2{(left_of(tile) + x * kTile) / kPageWidth, (kGap + 0.5f + z * kTile) / kPageHeight});
    };
    const std::array corners{corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)};
    for (const std::array<std::size_t, 3>& t : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
        CheckedTriangle triangle;
        triangle.instance = tile;
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.position[k] = corners[t[k]].first;
            triangle.normal[k] = {0, 1, 0};
            triangle.uv[k] = corners[t[k]].second;
        }
        bake.triangles.push_back(triangle);
    }
}

// Two tiles of 1 m side by side, under light that rises evenly with x, which bilinear lookups reproduce.
CheckedBake clean_bake() {
    CheckedBake bake;
    bake.instances = {"left", "right"};
    bake.pages.push_back({kPageWidth, kPageHeight, Image(kPageWidth, kPageHeight, 3),
                          std::vector<TexelState>(kPageWidth * kPageHeight), Image(kPageWidth, kPageHeight, 3)});
    CheckedPage& page = bake.pages[0];
    for (std::uint32_t tile = 0; tile < 2; ++tile) {
        add_tile(tile, bake);
        for (std::uint32_t y = kGap - 1; y <= kGap + kTile + 1; ++y)
            for (std::uint32_t x = 0; x <= kTile + 2; ++x) {
                const std::uint32_t column = static_cast<std::uint32_t>(left_of(tile)) - 1 + x;
                const float metres = static_cast<float>(tile) + (static_cast<float>(x) - 1.0f) / kTile;
                const bool inside = x >= 1 && x <= kTile + 1 && y >= kGap && y <= kGap + kTile;
                page.state[std::size_t{y} * kPageWidth + column] = inside ? TexelState::baked : TexelState::dilated;
                for (std::size_t c = 0; c < 3; ++c) page.light.at(column, y)[c] = 1.0f + 0.5f * metres;
            }
    }
    return bake;
}

// The names of what fails at limits that allow nothing.
std::vector<std::string> failures(const CheckedBake& bake) {
    Context context(1);
    const SeamCheck seams = check_seams(bake, {}, EmptyTracer(), context).value();
    EXPECT_GT(seams.open.samples, 100u);
    CheckLimits limits;
    limits.seam_p99 = 0.005;
    limits.seam_visible = limits.invalid = limits.unconverged = limits.outliers = limits.black = 0.0;
    std::vector<std::string> out;
    for (const Finding& f : judge(seams, check_texels(bake, {}, context).value(), limits))
        if (!f.passed()) out.push_back(f.name);
    return out;
}

using Names = std::vector<std::string>;
std::size_t texel(std::uint32_t x, std::uint32_t y) { return std::size_t{y} * kPageWidth + x; }

TEST(Check, HasNothingToSayOfACleanBake) { EXPECT_EQ(failures(clean_bake()), Names{}); }

TEST(Check, FindsASeam) {
    CheckedBake bake = clean_bake();
    for (std::uint32_t y = 0; y < kPageHeight; ++y)
        for (std::uint32_t x = kGap + kTile + 3; x < kPageWidth; ++x)
            for (std::size_t c = 0; c < 3; ++c) bake.pages[0].light.at(x, y)[c] *= 1.02f;
    EXPECT_EQ(failures(bake), (Names{"seam_p99", "seam_visible"}));
    Context context(1);
    const SeamCheck seams = check_seams(bake, {}, EmptyTracer(), context).value();
    EXPECT_NEAR(seams.open.metres, 1.0, 1e-6);
    EXPECT_NEAR(seams.open.p99, 0.02, 0.001);  // 1.5 against 1.53, of their mean and a hundredth of the scene's
    ASSERT_EQ(seams.worst.empty(), false);
    EXPECT_NEAR(seams.worst[0].position.x, 1.0f, 1e-6f);
}

TEST(Check, TellsSeamsThatAWallPartsFromOthers) {
    class Wall : public EmptyTracer {
        void occluded(std::span<const Ray>, std::span<std::uint8_t> blocked) const override {
            std::ranges::fill(blocked, std::uint8_t{1});
        }
    };
    Context context(1);
    const SeamCheck seams = check_seams(clean_bake(), {}, Wall(), context).value();
    EXPECT_EQ(seams.open.samples, 0u);
    EXPECT_GT(seams.parted.samples, 100u);
}

TEST(Check, FindsWhatIsNoNumber) {
    CheckedBake bake = clean_bake();
    bake.pages[0].light.at(20, 20)[1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(failures(bake), Names{"not_finite"});
}

TEST(Check, FindsABlackTexel) {
    CheckedBake bake = clean_bake();
    for (std::size_t c = 0; c < 3; ++c) bake.pages[0].light.at(20, 20)[c] = 0.0f;
    EXPECT_EQ(failures(bake), Names{"black"});
}

TEST(Check, FindsAnInvalidTexel) {
    CheckedBake bake = clean_bake();
    bake.pages[0].state[texel(20, 20)] = TexelState::filled;
    EXPECT_EQ(failures(bake), Names{"invalid"});
}

// What the texels within one triangle are.
CheckedBake bake_with_hole(TexelState state) {
    CheckedBake bake = clean_bake();
    const auto middle = static_cast<std::uint32_t>(left_of(0)) + kTile / 3;  // of one triangle alone
    for (std::uint32_t y = 22; y < 27; ++y)
        for (std::uint32_t x = middle - 2; x < middle + 3; ++x) bake.pages[0].state[texel(x, y)] = state;
    return bake;
}

TEST(Check, FindsAnUncoveredTriangle) { EXPECT_EQ(failures(bake_with_hole(TexelState::empty)), Names{"uncovered"}); }

TEST(Check, WhatNobodySeesIsNotUncovered) { EXPECT_EQ(failures(bake_with_hole(TexelState::hidden)), Names{}); }

TEST(Check, FindsAnOverlap) {
    CheckedBake bake = clean_bake();
    CheckedTriangle over = bake.triangles[0];
    for (std::size_t k = 0; k < 3; ++k) over.position[k].y += 1.0f;  // another surface on the same texels
    for (Vec2& uv : over.uv) uv = uv * 0.999f;
    bake.triangles.push_back(over);
    EXPECT_EQ(failures(bake), Names{"overlaps"});
}

TEST(Check, FindsADensityOutlier) {
    CheckedBake bake = clean_bake();
    CheckedTriangle coarse = bake.triangles[2];
    coarse.page = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        coarse.position[k].y += 1.0f;
        coarse.uv[k] = coarse.uv[0] + (coarse.uv[k] - coarse.uv[0]) * 0.1f;  // a tenth as dense
    }
    bake.triangles.push_back(coarse);
    CheckedPage page = bake.pages[0];
    std::ranges::fill(page.light.data, 1.0f);
    std::ranges::fill(page.state, TexelState::baked);
    bake.pages.push_back(page);
    EXPECT_EQ(failures(bake), Names{"density_outliers"});
}

TEST(Check, FindsAnUnconvergedPatch) {
    CheckedBake bake = clean_bake();
    for (std::uint32_t y = 15; y < 20; ++y)
        for (std::uint32_t x = 15; x < 20; ++x)
            for (std::size_t c = 0; c < 3; ++c) bake.pages[0].variance.at(x, y)[c] = 0.09f;  // 0.3 of some 1.2
    EXPECT_EQ(failures(bake), Names{"unconverged"});
}

// n x n tiles of `metres` side by side, 8 texels across, each of another brightness than its neighbours.
CheckedBake chequered_bake(std::uint32_t n, float metres) {
    constexpr std::uint32_t kTexels = 8, kStep = kTexels + 4;
    const std::uint32_t edge = n * kStep + 4;
    CheckedBake bake;
    bake.pages.push_back({edge, edge, Image(edge, edge, 3), std::vector<TexelState>(std::size_t{edge} * edge), {}});
    CheckedPage& page = bake.pages[0];
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t left = i * kStep + 3, top = j * kStep + 3;
            const float light = 1.0f + 0.01f * static_cast<float>((7 * i + 13 * j) % 17);
            for (std::uint32_t y = top; y < top + kTexels + 2; ++y)
                for (std::uint32_t x = left; x < left + kTexels + 2; ++x) {
                    page.state[std::size_t{y} * edge + x] = TexelState::baked;
                    for (std::size_t c = 0; c < 3; ++c) page.light.at(x, y)[c] = light;
                }
            CheckedTriangle t;
            t.instance = j * n + i;
            bake.instances.push_back("tile");
            const auto corner = [&](std::size_t k, std::uint32_t u, std::uint32_t v) {
                t.position[k] = Vec3{static_cast<float>(i + u), 0, static_cast<float>(j + v)} * metres;
                t.normal[k] = {0, 1, 0};
                t.uv[k] = Vec2{static_cast<float>(left + 1 + u * kTexels), static_cast<float>(top + 1 + v * kTexels)} *
                          (1.0f / static_cast<float>(edge));
            };
            for (const std::uint32_t second : {0u, 1u}) {
                corner(0, 0, 0);
                corner(1, second, 1);
                corner(2, 1, 1 - second);
                bake.triangles.push_back(t);
            }
        }
    return bake;
}

SeamCheck seams_of(const CheckedBake& bake, unsigned threads) {
    Context context(threads);
    return check_seams(bake, {}, EmptyTracer(), context).value();
}

// Within a millimetre of each border of the second lie all others; of its texels, which are 25 micrometres, none.
TEST(Check, FindsTheSeamsOfScenesOfMillimetres) {
    constexpr std::uint32_t kTiles = 5;
    const SeamCheck metres = seams_of(chequered_bake(kTiles, 1.0f), 1);
    const SeamCheck millimetres = seams_of(chequered_bake(kTiles, 2e-4f), 1);
    EXPECT_NEAR(metres.open.metres, 2.0 * kTiles * (kTiles - 1), 1e-4);
    EXPECT_EQ(millimetres.open.samples, metres.open.samples);
    EXPECT_NEAR(millimetres.open.metres, 2e-4 * metres.open.metres, 1e-7);
    EXPECT_NEAR(millimetres.open.p99, metres.open.p99, 1e-4);
}

// 2304 borders: chunks for three threads, of whose samples no two tiles have the same contrasts.
TEST(Check, SameBitsForAnyNumberOfThreads) {
    const CheckedBake bake = chequered_bake(24, 1.0f);
    const SeamCheck one = seams_of(bake, 1);
    ASSERT_GT(one.open.samples, 20000u);
    ASSERT_GT(one.worst.size(), 50u);
    for (const unsigned threads : {2u, 4u}) {
        const SeamCheck many = seams_of(bake, threads);
        EXPECT_EQ(one.open.samples, many.open.samples);
        EXPECT_EQ(one.open.metres, many.open.metres);
        EXPECT_EQ(one.open.visible_metres, many.open.visible_metres);
        EXPECT_EQ(one.open.median, many.open.median);
        EXPECT_EQ(one.open.p99, many.open.p99);
        ASSERT_EQ(one.worst.size(), many.worst.size());
        for (std::size_t i = 0; i < one.worst.size(); ++i) {
            EXPECT_EQ(one.worst[i].contrast, many.worst[i].contrast);
            EXPECT_EQ(one.worst[i].position, many.worst[i].position);
            EXPECT_EQ(one.worst[i].instance_a, many.worst[i].instance_a);
            EXPECT_EQ(one.worst[i].instance_b, many.worst[i].instance_b);
        }
    }
}

// All that takes long asks, also where it is not in parallel.
TEST(Check, StopsWhereCancelled) {
    Context context(1);
    context.request_cancel();
    const CheckedBake bake = clean_bake();
    const auto seams = check_seams(bake, {}, EmptyTracer(), context);
    ASSERT_FALSE(seams.ok());
    EXPECT_EQ(seams.error().code, ErrorCode::cancelled);
    const auto texels = check_texels(bake, {}, context);
    ASSERT_FALSE(texels.ok());
    EXPECT_EQ(texels.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace lumel
