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
    for (const Finding& f : judge(seams, check_texels(bake, {}), limits))
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

TEST(Check, FindsAnUncoveredTriangle) {
    CheckedBake bake = clean_bake();
    const auto middle = static_cast<std::uint32_t>(left_of(0)) + kTile / 3;  // of one triangle alone
    for (std::uint32_t y = 22; y < 27; ++y)
        for (std::uint32_t x = middle - 2; x < middle + 3; ++x) bake.pages[0].state[texel(x, y)] = TexelState::empty;
    EXPECT_EQ(failures(bake), Names{"uncovered"});
}

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

TEST(Check, SameBitsForAnyNumberOfThreads) {
    const CheckedBake bake = clean_bake();
    Context one(1), four(4);
    const SeamCheck a = check_seams(bake, {}, EmptyTracer(), one).value();
    const SeamCheck b = check_seams(bake, {}, EmptyTracer(), four).value();
    EXPECT_EQ(a.open.p99, b.open.p99);
    EXPECT_EQ(a.open.metres, b.open.metres);
}

}  // namespace
}  // namespace lumel
