#include "chart/page_clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/check.h"

namespace lumel {
namespace {

using Part = std::vector<std::uint32_t>;

std::uint64_t used_by(std::span<const PackPlace> places, const Part& part) {
    std::uint64_t used = 0;
    for (const std::uint32_t i : part) used += places[i].used;
    return used;
}

std::size_t longest_side(std::span<const PackPlace> places, const Part& part) {
    constexpr float kFar = std::numeric_limits<float>::max();
    Vec3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
    for (const std::uint32_t i : part) {
        low = min(low, places[i].centre);
        high = max(high, places[i].centre);
    }
    const Vec3 size = high - low;
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

// Two parts of which the first has about `share` of the texels. Precondition: two places or more.
std::array<Part, 2> halve(std::span<const PackPlace> places, Part part, double share) {
    const std::size_t axis = longest_side(places, part);
    std::ranges::sort(part, [&](std::uint32_t a, std::uint32_t b) {
        const float x = places[a].centre[axis], y = places[b].centre[axis];
        return x != y ? x < y : a < b;
    });
    const double wanted = share * static_cast<double>(used_by(places, part));
    double sum = 0.0, nearest = std::numeric_limits<double>::max();
    std::size_t cut = 1;
    for (std::size_t k = 1; k < part.size(); ++k) {
        sum += static_cast<double>(places[part[k - 1]].used);
        if (std::abs(sum - wanted) >= nearest) continue;
        nearest = std::abs(sum - wanted);
        cut = k;
    }
    const auto at = part.begin() + static_cast<std::ptrdiff_t>(cut);
    std::array<Part, 2> out{Part(part.begin(), at), Part(at, part.end())};
    for (Part& half : out) std::ranges::sort(half);
    return out;
}

void split(std::span<const PackPlace> places, Part part, std::uint32_t parts, std::vector<Part>& out) {
    if (parts <= 1 || part.size() <= 1) {
        out.push_back(std::move(part));
        return;
    }
    const std::uint32_t first = parts / 2;
    auto [low, high] = halve(places, std::move(part), static_cast<double>(first) / parts);
    split(places, std::move(low), first, out);
    split(places, std::move(high), parts - first, out);
}

}  // namespace

std::vector<Part> cluster_places(std::span<const PackPlace> places, std::uint32_t parts) {
    std::vector<Part> out;
    Part all(places.size());
    std::iota(all.begin(), all.end(), 0u);
    if (!all.empty()) split(places, std::move(all), parts, out);
    return out;
}

Packing pack_clusters(std::span<const ChartMask> masks, std::span<const PackItem> items,
                      std::span<const PackPlace> places, std::uint32_t max_page, std::uint32_t pages,
                      Context& context) {
    constexpr double kFull = 0.95;     // of a page, about: too much is halved, too little leaves pages half empty
    std::vector<std::uint32_t> first;  // item of each group
    for (std::uint32_t i = 0; i < items.size(); ++i)
        if (i == 0 || items[i - 1].group != items[i].group) first.push_back(i);
    LUMEL_CHECK(first.size() == places.size(), first.size(), places.size());
    first.push_back(static_cast<std::uint32_t>(items.size()));
    double texels = 0.0;
    for (const PackPlace& place : places) texels += static_cast<double>(place.used);
    const double enough = std::ceil(texels / (kFull * max_page * max_page));
    const std::uint32_t parts = pages != 0 ? pages : static_cast<std::uint32_t>(std::max(1.0, enough));

    Packing out;
    out.spots.resize(items.size());
    std::vector<Part> waiting = cluster_places(places, parts);
    std::ranges::reverse(waiting);
    while (!waiting.empty()) {
        Part part = std::move(waiting.back());
        waiting.pop_back();
        std::vector<PackItem> some;
        for (const std::uint32_t place : part)
            some.insert(some.end(), items.begin() + first[place], items.begin() + first[place + 1]);
        const Packing packed = pack(masks, some, max_page, context);
        if (!packed.complete) return out;
        if (packed.pages.size() > 1) {
            if (pages != 0) return out;
            if (part.size() > 1) {
                auto [low, high] = halve(places, std::move(part), 0.5);
                waiting.push_back(std::move(high));
                waiting.push_back(std::move(low));
                continue;
            }
        }
        std::size_t next = 0;
        const auto page = static_cast<std::uint32_t>(out.pages.size());
        for (const std::uint32_t place : part)
            for (std::uint32_t i = first[place]; i < first[place + 1]; ++i) {
                out.spots[i] = packed.spots[next++];
                out.spots[i].page += page;
            }
        out.pages.insert(out.pages.end(), packed.pages.begin(), packed.pages.end());
    }
    out.complete = true;
    return out;
}

}  // namespace lumel
