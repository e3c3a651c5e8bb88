#include "inspect/color_scale.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "image/colormap.h"
#include "image/tonemap.h"

namespace lumel {
namespace {

constexpr float kOctaves = 4.0f;          // of ColorRule::log_heat
constexpr double kUsualShare = 0.99;      // share of the numbers that a scale holds: a few outliers would flatten it
constexpr float kNearlyWhite = 1.5f;      // exposed: the tone curve is at 0.95 there
constexpr float kSmallestScale = 1e-30f;  // of scales of zeros

template <class Visit>
void for_each_value(std::span<const LayerPage> pages, Visit&& visit) {
    for (const LayerPage& page : pages)
        for (std::size_t i = 0; i < page.presence.size(); ++i)
            if (page.presence[i] != Presence::none)
                visit(std::span(&page.values.data[i * page.values.channels], page.values.channels));
}

// Of the finite ones; 0 where there are none.
float quantile(std::vector<float> values, double share) {
    std::erase_if(values, [](float v) { return !std::isfinite(v); });
    if (values.empty()) return 0.0f;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

std::vector<float> all_channels(std::span<const LayerPage> pages, bool magnitudes) {
    std::vector<float> out;
    for_each_value(pages, [&](std::span<const float> value) {
        for (const float v : value) out.push_back(magnitudes ? std::fabs(v) : v);
    });
    return out;
}

Image as_one_row(std::span<const LayerPage> pages) {
    Image out(0, 1, 3);
    for_each_value(pages, [&](std::span<const float> value) {
        const bool is_finite = std::ranges::all_of(value, [](float v) { return std::isfinite(v); });
        for (std::size_t c = 0; c < 3; ++c) out.data.push_back(is_finite ? value[c] : 0.0f);
    });
    out.width = static_cast<std::uint32_t>(out.data.size() / 3);
    return out;
}

Vec3 coded(Vec3 linear) { return {srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z)}; }

}  // namespace

ColorScale::ColorScale(const TexelLayer& layer, std::span<const LayerPage> pages)
    : rule_(layer.rule), categories_(layer.categories) {
    switch (rule_) {
        case ColorRule::category:
        case ColorRule::identity:
        case ColorRule::share:
        case ColorRule::reflectance: break;
        case ColorRule::heat:
            high_ = std::max(quantile(all_channels(pages, false), kUsualShare), kSmallestScale);
            break;
        case ColorRule::log_heat: {
            std::vector<float> values = all_channels(pages, false);
            std::erase_if(values, [](float v) { return !(v > 0.0f); });  // which have no logarithm
            const float middle = std::max(quantile(std::move(values), 0.5), kSmallestScale);
            low_ = middle * std::exp2(-0.5f * kOctaves);
            high_ = middle * std::exp2(0.5f * kOctaves);
            break;
        }
        case ColorRule::light:
            exposure_ = auto_exposure(as_one_row(pages), {}, {0.9, 0.6f});  // as that of preview_atlas_<p>.png
            high_ = kNearlyWhite / exposure_;
            break;
        case ColorRule::around_zero:
            high_ = std::max(quantile(all_channels(pages, true), kUsualShare), kSmallestScale);
            low_ = -high_;
            break;
        case ColorRule::direction: low_ = -1.0f; break;
        case ColorRule::place: {
            bool any = false;
            Vec3 highest{};
            for_each_value(pages, [&](std::span<const float> value) {
                const Vec3 p{value[0], value[1], value[2]};
                origin_ = any ? min(origin_, p) : p;
                highest = any ? max(highest, p) : p;
                any = true;
            });
            high_ = std::max(max_component(highest - origin_), kSmallestScale);
            break;
        }
    }
}

float ColorScale::value_at(float t) const {
    if (rule_ == ColorRule::log_heat) return low_ * std::exp2(kOctaves * t);
    return low_ + (high_ - low_) * t;
}

Vec3 ColorScale::color(std::span<const float> value) const {
    const auto channel = [&](std::size_t c) { return value[std::min(c, value.size() - 1)]; };
    const Vec3 rgb{channel(0), channel(1), channel(2)};
    const auto clamped = [](Vec3 v) { return max(min(v, Vec3{1, 1, 1}), Vec3{}); };
    switch (rule_) {
        case ColorRule::category: {
            const auto index = static_cast<std::size_t>(value[0]);
            LUMEL_CHECK(index < categories_.size(), index, categories_.size());
            return categories_[index].color;
        }
        case ColorRule::identity: return identity_color(static_cast<std::uint64_t>(value[0]));
        case ColorRule::share:
        case ColorRule::heat: return heat_color(value[0] / high_);
        case ColorRule::log_heat: return heat_color(value[0] > 0.0f ? std::log2(value[0] / low_) / kOctaves : 0.0f);
        case ColorRule::reflectance: return coded(clamped(rgb));
        case ColorRule::light: return coded(clamped(tone_curve(max(rgb, Vec3{}) * exposure_)));
        case ColorRule::around_zero:
        case ColorRule::direction: return clamped(rgb * (0.5f / high_) + Vec3{0.5f, 0.5f, 0.5f});
        case ColorRule::place: return clamped((rgb - origin_) * (1.0f / high_));
    }
    return {};
}

}  // namespace lumel
