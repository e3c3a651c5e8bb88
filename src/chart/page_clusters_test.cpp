#include "chart/page_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/pack_checker.h"
#include "support/random_masks.h"

namespace lumel {
namespace {

// Objects of a few charts each, anywhere in a square of 100 m.
struct Town {
    std::vector<ChartMask> masks;
    std::vector<PackItem> items;
    std::vector<PackPlace> places;

    explicit Town(std::uint32_t objects) {
        constexpr std::uint32_t kCharts = 4;
        masks = test::random_masks(objects * kCharts, 30, 7);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> where(0.0f, 100.0f);
        for (std::uint32_t i = 0; i < masks.size(); ++i) {
            if (i % kCharts == 0) places.push_back({i / kCharts, {where(random), 0, where(random)}, 0});
            items.push_back({i, i / kCharts});
            places.back().used += masks[i].used;
        }
    }
    // Mean distance of objects from the middle of those they share a page with, metres.
    [[nodiscard]] double spread(const Packing& packing) const {
        std::vector<Vec3> sum(packing.pages.size());
        std::vector<float> count(packing.pages.size());
        const auto page_of = [&](const PackPlace& p) { return packing.spots[p.group * 4].page; };
        for (const PackPlace& p : places) sum[page_of(p)] += p.centre, count[page_of(p)] += 1.0f;
        double distance = 0.0;
        for (const PackPlace& p : places)
            distance += static_cast<double>(length(p.centre - sum[page_of(p)] / count[page_of(p)]));
        return distance / static_cast<double>(places.size());
    }
    void expect_sound(const Packing& packing, std::uint32_t max_page) const {
        ASSERT_TRUE(packing.complete);
        for (std::uint32_t p = 0; p < packing.pages.size(); ++p) {
            EXPECT_LE(std::max(packing.pages[p].width, packing.pages[p].height), max_page);
            std::vector<ChartMask> drawn;
            std::vector<test::PackedSpot> spots;
            std::uint64_t used = 0;
            for (std::size_t i = 0; i < items.size(); ++i) {
                if (packing.spots[i].page != p) continue;
                drawn.push_back(masks[items[i].mask]);
                used += drawn.back().used;
                spots.push_back({0, packing.spots[i].x, packing.spots[i].y, 0});
            }
            EXPECT_EQ(used, packing.pages[p].used);
            const test::PackConflicts conflicts = test::draw_packing(drawn, spots, packing.pages[p].width);
            EXPECT_EQ(conflicts.overlaps + conflicts.outside, 0u);
        }
    }
};

TEST(PageClusters, PartsAreNearAndOfOneSize) {
    const Town town(200);
    const auto parts = cluster_places(town.places, 7);
    ASSERT_EQ(parts.size(), 7u);
    std::vector<bool> seen(200);
    std::uint64_t all = 0, most = 0;
    for (const auto& part : parts) {
        EXPECT_TRUE(std::ranges::is_sorted(part));
        std::uint64_t used = 0;
        for (const std::uint32_t i : part) {
            EXPECT_FALSE(seen[i]);
            seen[i] = true;
            used += town.places[i].used;
        }
        all += used;
        most = std::max(most, used);
    }
    EXPECT_EQ(std::ranges::count(seen, false), 0);
    // A cut is off by half an object at most: about 4 % of such a part for each of three cuts.
    EXPECT_LE(static_cast<double>(most), 1.15 * static_cast<double>(all) / 7.0);
    EXPECT_EQ(cluster_places(std::span(town.places).first(3), 7).size(), 3u);
    EXPECT_TRUE(cluster_places({}, 7).empty());
}

TEST(PageClusters, NearObjectsShareAPage) {
    const Town town(400);
    Context context(1);
    const Packing fewest = pack(town.masks, town.items, 64, context);
    const Packing near = pack_clusters(town.masks, town.items, town.places, 64, 0, context);
    town.expect_sound(near, 64);
    ASSERT_GE(near.pages.size(), 8u);
    // Of a square in n parts the distances are those of the whole by the root of n; pages by size are spread as the
    // whole.
    EXPECT_LT(town.spread(near), 0.6 * town.spread(fewest));
    // Halves that are a little more than a page are halved again: half full at worst.
    EXPECT_LE(near.pages.size(), 2 * fewest.pages.size());
    for (std::size_t i = 1; i < town.items.size(); ++i)
        if (town.items[i].group == town.items[i - 1].group) {
            EXPECT_EQ(near.spots[i].page, near.spots[i - 1].page) << "an object on two pages";
        }
}

TEST(PageClusters, AsManyPagesAsAskedOrNone) {
    const Town town(60);
    Context context(1);
    const Packing three = pack_clusters(town.masks, town.items, town.places, 1024, 3, context);
    town.expect_sound(three, 1024);
    EXPECT_EQ(three.pages.size(), 3u);
    EXPECT_FALSE(pack_clusters(town.masks, town.items, town.places, 32, 3, context).complete);
}

TEST(PageClusters, SameBitsForAnyNumberOfThreads) {
    const Town town(60);
    Context one(1), eight(8);
    const Packing a = pack_clusters(town.masks, town.items, town.places, 128, 0, one);
    const Packing b = pack_clusters(town.masks, town.items, town.places, 128, 0, eight);
    ASSERT_EQ(a.pages.size(), b.pages.size());
    for (std::size_t i = 0; i < a.spots.size(); ++i) {
        EXPECT_EQ(a.spots[i].page, b.spots[i].page);
        EXPECT_EQ(a.spots[i].x, b.spots[i].x);
        EXPECT_EQ(a.spots[i].y, b.spots[i].y);
    }
}

}  // namespace
}  // namespace lumel
