#include "io/page_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/try.h"
#include "encode/l1.h"
#include "encode/output_sizes.h"
#include "encode/units.h"
#include "image/tonemap.h"
#include "io/image_io.h"

namespace lumel {
namespace {

constexpr std::array<const char*, 3> kXyz{"X", "Y", "Z"};

// Fills one row of one channel: out[x] is the value of texels[x], zero where that is kNone.
using FillChannel = std::function<void(std::span<const std::uint32_t> texels, std::span<float> out)>;

struct Channel {
    ExrChannelSource source;
    FillChannel fill;
};

template <class Value>
Channel channel(std::string name, ExrType type, Value value) {
    return {{std::move(name), type}, [value](std::span<const std::uint32_t> texels, std::span<float> out) {
                for (std::size_t x = 0; x < texels.size(); ++x) out[x] = texels[x] == kNone ? 0.0f : value(texels[x]);
            }};
}

bool is_empty(std::span<const std::uint32_t> texels) {
    return std::ranges::all_of(texels, [](std::uint32_t t) { return t == kNone; });
}

const char* type_name(ExrType type) { return type == ExrType::half ? "half" : "float"; }

// Half where its range holds the numbers: the largest below 65504, and the mean far enough above its smallest steps
// (6e-8) that they stay below a hundred-thousandth of it.
class HalfCheck {
public:
    void add(float value) {
        const float size = std::fabs(value);
        largest_ = std::max(largest_, size);
        sum_ += static_cast<double>(size);
        ++count_;
    }
    [[nodiscard]] ExrType type() const {
        constexpr float kLargest = 65000.0f;
        constexpr double kSmallestMean = 0.006;
        const double mean = count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_);
        return largest_ < kLargest && (mean >= kSmallestMean || largest_ == 0.0f) ? ExrType::half : ExrType::full;
    }

private:
    float largest_ = 0.0f;
    double sum_ = 0.0;
    std::uint64_t count_ = 0;
};

class PageWriter {
public:
    PageWriter(const std::filesystem::path& folder, const Lightmap& map, const LayerWeights& weights,
               WriteProgress& progress, LightUnit (*unit)(PageFile))
        : folder_(folder), map_(map), weights_(weights), progress_(progress), unit_(unit) {}

    Result<ManifestPage> write() {
        out_.width = map_.width;
        out_.height = map_.height;
        const auto baked = std::count(map_.coverage.begin(), map_.coverage.end(), Coverage::baked);
        out_.coverage = static_cast<double>(baked) / (static_cast<double>(map_.width) * map_.height);
        LUMEL_TRY_STATUS(write_lightmap());
        LUMEL_TRY_STATUS(write_irradiance());
        LUMEL_TRY_STATUS(write_l1());
        LUMEL_TRY_STATUS(write_master());
        LUMEL_TRY_STATUS(write_grey(PageFile::ao, map_.texels.ambient_occlusion));
        LUMEL_TRY_STATUS(write_bent_normal());
        LUMEL_TRY_STATUS(write_grey(PageFile::sky_visibility, map_.texels.sky_visibility));
        return std::move(out_);
    }

private:
    [[nodiscard]] std::filesystem::path file(PageFile kind) const {
        return folder_ / page_file(kind, map_.page, map_.mip);
    }

    [[nodiscard]] Vec3 irradiance(std::size_t texel) const {
        const auto& layers = map_.texels.layers[texel];
        return sum_layers(weights_, [&](std::size_t l) { return layers[l].irradiance; });
    }
    [[nodiscard]] L1Texel l1(std::size_t texel) const {
        const auto& layers = map_.texels.layers[texel];
        RadianceSh<Vec3, 4> sum;
        for (std::size_t i = 0; i < 4; ++i)
            sum.c[i] = sum_layers(weights_, [&](std::size_t l) { return layers[l].sh[i]; });
        return encode_l1(sum);
    }

    // `fill` for the rows that have texels.
    Status write_rows(PageFile kind, std::string type, const std::vector<ExrChannelSource>& channels,
                      const std::function<void(std::span<const std::uint32_t> texels, std::span<float> out)>& fill) {
        out_.files.push_back({kind, std::move(type)});
        const auto row = [&](std::uint32_t y, std::span<float> out) {
            const auto texels = std::span(map_.texel_at).subspan(std::size_t{y} * map_.width, map_.width);
            if (is_empty(texels)) return false;
            fill(texels, out);
            return true;
        };
        const double work = static_cast<double>(channels.size());
        LUMEL_TRY_STATUS(write_exr(file(kind), map_.width, map_.height, channels, row, &progress_.context(),
                                   [&](double fraction) { progress_.within(fraction * work); }));
        progress_.add(work);
        return success();
    }

    Status write_channels(PageFile kind, std::string type, const std::vector<Channel>& channels) {
        std::vector<ExrChannelSource> sources;
        sources.reserve(channels.size());
        for (const Channel& c : channels) sources.push_back(c.source);
        return write_rows(kind, std::move(type), sources, [&](auto texels, std::span<float> out) {
            for (std::size_t c = 0; c < channels.size(); ++c)
                channels[c].fill(texels, out.subspan(c * texels.size(), texels.size()));
        });
    }

    Status write_irradiance_in(PageFile kind, ExrType type) {
        std::vector<Channel> channels;
        for (std::size_t c = 0; c < 3; ++c)
            channels.push_back(channel(kRgbChannels[c], type, [this, c, unit = unit_(kind)](std::size_t t) {
                return to_file_unit(irradiance(t)[c], unit);
            }));
        return write_channels(kind, type_name(type), channels);
    }

    Status write_lightmap() { return write_irradiance_in(PageFile::lightmap, ExrType::full); }

    Status write_irradiance() {
        HalfCheck check;
        for (std::size_t t = 0; t < map_.texels.size(); ++t)
            for (std::size_t c = 0; c < 3; ++c) check.add(to_file_unit(irradiance(t)[c], unit_(PageFile::irradiance)));
        return write_irradiance_in(PageFile::irradiance, check.type());
    }

    // L0.R .. L0.B, and per channel the normalised linear band as a world-space vector: L1n.R.X ..
    Status write_l1() {
        HalfCheck check;
        for (std::size_t t = 0; t < map_.texels.size(); ++t)
            for (std::size_t c = 0; c < 3; ++c) check.add(to_file_unit(l1(t).l0[c], unit_(PageFile::l1)));
        std::vector<ExrChannelSource> sources;
        for (std::size_t c = 0; c < 3; ++c) sources.push_back({std::string("L0.") + kRgbChannels[c], check.type()});
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < 3; ++k)
                sources.push_back({std::string("L1n.") + kRgbChannels[c] + "." + kXyz[k], ExrType::half});
        return write_rows(PageFile::l1, check.type() == ExrType::half ? "half" : "half+float", sources,
                          [this](auto texels, std::span<float> out) {
                              for (std::size_t x = 0; x < texels.size(); ++x) {
                                  const L1Texel texel = texels[x] == kNone ? L1Texel{} : l1(texels[x]);
                                  for (std::size_t c = 0; c < kL1Channels; ++c)
                                      out[c * texels.size() + x] = l1_number(texel, c);
                              }
                          });
    }

    static constexpr std::size_t kL1Channels = 12;

    // In the order of the file's channels. The linear band is a ratio: it has no unit.
    [[nodiscard]] float l1_number(const L1Texel& texel, std::size_t channel) const {
        return channel < 3 ? to_file_unit(texel.l0[channel], unit_(PageFile::l1))
                           : texel.l1n[channel / 3 - 1][channel % 3];
    }

    [[nodiscard]] ExrType sh_type() const {
        const LightUnit unit = unit_(PageFile::master);
        HalfCheck check;
        float largest = 0.0f;  // of all coefficients; the mean is that of the constant ones
        for (const auto& layers : map_.texels.layers) {
            Vec3 constant{};
            for (const LayerMoments& layer : layers) {
                constant += layer.sh[0];
                for (const Vec3& v : layer.sh) largest = std::max(largest, max_component(max(v, -v)));
            }
            for (std::size_t c = 0; c < 3; ++c) check.add(to_file_unit(constant[c], unit));
        }
        check.add(to_file_unit(largest, unit));
        return check.type();
    }

    void add_layer(std::size_t l, ExrType type, std::vector<Channel>& channels) const {
        const std::string layer = kLayerNames[l];
        const LightUnit unit = unit_(PageFile::master);
        const RadianceSums& texels = map_.texels;
        for (std::size_t i = 0; i < kShCoefficients; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                channels.push_back(channel(layer + ".L" + std::to_string(i) + "." + kRgbChannels[c], type,
                                           [&texels, l, i, c, unit](std::size_t t) {
                                               return to_file_unit(texels.layers[t][l].sh[i][c], unit);
                                           }));
        for (std::size_t c = 0; c < 3; ++c)
            channels.push_back(
                channel(layer + ".I." + kRgbChannels[c], ExrType::full, [&texels, l, c, unit](std::size_t t) {
                    return to_file_unit(texels.layers[t][l].irradiance[c], unit);
                }));
    }

    Status write_master() {
        const ExrType type = sh_type();
        const LightUnit unit = unit_(PageFile::master);
        const RadianceSums& texels = map_.texels;
        std::vector<Channel> channels;
        for (std::size_t l = 0; l < kLayerCount; ++l) add_layer(l, type, channels);
        channels.push_back(
            channel("coverage", ExrType::half, [this](std::size_t t) { return static_cast<float>(map_.coverage[t]); }));
        channels.push_back(
            channel("count", ExrType::full, [&texels](std::size_t t) { return static_cast<float>(texels.count[t]); }));
        for (std::size_t c = 0; c < 3; ++c)
            channels.push_back(channel(std::string("normal.") + kXyz[c], ExrType::half,
                                       [this, c](std::size_t t) { return map_.normal[t][c]; }));
        for (std::size_t c = 0; c < 3; ++c)
            channels.push_back(
                channel(std::string("variance.") + kRgbChannels[c], ExrType::full, [&texels, c, unit](std::size_t t) {
                    // Of a light, hence twice.
                    return to_file_unit(to_file_unit(texels.variance[t][c], unit), unit);
                }));
        return write_channels(PageFile::master, type == ExrType::half ? "half+float" : "float", channels);
    }

    Status write_bent_normal() {
        std::vector<Channel> channels;
        for (std::size_t c = 0; c < 3; ++c)
            channels.push_back(channel(kRgbChannels[c], ExrType::half,
                                       [this, c](std::size_t t) { return map_.texels.bent_normal[t][c]; }));
        return write_channels(PageFile::bent_normal, "half", channels);
    }

    // 0..1 as 0..255, linear.
    Status write_grey(PageFile kind, const std::vector<float>& values) {
        std::vector<std::uint8_t> pixels(map_.texel_at.size());
        for (std::size_t i = 0; i < pixels.size(); ++i)
            if (const std::uint32_t t = map_.texel_at[i]; t != kNone)
                pixels[i] = static_cast<std::uint8_t>(std::clamp(values[t], 0.0f, 1.0f) * 255.0f + 0.5f);
        out_.files.push_back({kind, "8-bit"});
        LUMEL_TRY_STATUS(write_png(file(kind), map_.width, map_.height, 1, pixels));
        progress_.add(kPngWork);
        return success();
    }

    const std::filesystem::path& folder_;
    const Lightmap& map_;
    const LayerWeights& weights_;
    WriteProgress& progress_;
    LightUnit (*unit_)(PageFile);
    ManifestPage out_;
};

// What 8 bits are scaled by, of the brightest reflected light but for the last thousandth: twice that, so that lamps
// stand out, and up to four times where the last thousandth needs it (a patch of sun); more would leave too few codes
// for the rest. The brightest of all where that is less.
float display_strength(const std::vector<Vec3>& reflected, float brightest) {
    constexpr double kFraction = 0.999;
    constexpr float kHeadroom = 2.0f, kMostHeadroom = 4.0f;
    std::vector<float> peaks;
    peaks.reserve(reflected.size());
    for (const Vec3& v : reflected)
        if (const float peak = max_component(v); peak > 0.0f && std::isfinite(peak)) peaks.push_back(peak);
    if (peaks.empty()) return brightest > 0.0f ? brightest : 1.0f;
    const auto at = peaks.begin() + static_cast<std::ptrdiff_t>(kFraction * static_cast<double>(peaks.size() - 1));
    std::nth_element(peaks.begin(), at, peaks.end());
    const float usual = *at, most = *std::max_element(at, peaks.end());
    return std::min(std::clamp(most, kHeadroom * usual, kMostHeadroom * usual), brightest);
}

}  // namespace

Result<ManifestPage> write_page_files(const std::filesystem::path& folder, const Lightmap& map,
                                      const LayerWeights& weights, WriteProgress& progress,
                                      LightUnit (*unit)(PageFile)) {
    return PageWriter(folder, map, weights, progress, unit).write();
}

LitTexture lit_texture(const Lightmap& map, const LayerWeights& weights) {
    constexpr float kCutUnseen = 0.05f;  // nobody sees a cut of that share
    std::vector<Vec3> light(map.texels.size());
    for (std::size_t t = 0; t < light.size(); ++t) {
        const auto& layers = map.texels.layers[t];
        const Vec3 irradiance = sum_layers(weights, [&](std::size_t l) { return layers[l].irradiance; });
        light[t] = map.surface.albedo[t] * to_file_unit(irradiance, LightUnit::e_over_pi);
    }
    LitTexture out;
    float brightest = 0.0f;
    for (std::size_t t = 0; t < light.size(); ++t)
        if (const Vec3 sum = light[t] + map.surface.emission[t]; is_finite(sum))
            brightest = std::max(brightest, max_component(sum));
    out.strength = display_strength(light, brightest);
    std::vector<std::uint8_t> pixels(map.texel_at.size() * 3);
    for (std::size_t i = 0; i < map.texel_at.size(); ++i) {
        const std::uint32_t t = map.texel_at[i];
        if (t == kNone) continue;
        Vec3 value = (light[t] + map.surface.emission[t]) / out.strength;
        if (max_component(light[t]) > out.strength * (1.0f + kCutUnseen)) {
            ++out.cut_texels;
            out.cut_ratio = std::max(out.cut_ratio, max_component(light[t]) / out.strength);
        }
        // What is brighter keeps its colour.
        if (const float peak = max_component(value); peak > 1.0f && std::isfinite(peak)) value = value / peak;
        for (std::size_t c = 0; c < 3; ++c) pixels[3 * i + c] = srgb8(value[c]);
    }
    out.png = encode_png(map.width, map.height, 3, pixels);
    return out;
}

PagePreview preview_of(const Lightmap& map, const LayerWeights& weights, std::uint32_t max_edge) {
    const std::uint32_t block = preview_block(map.width, map.height, max_edge);
    const std::uint32_t width = (map.width + block - 1) / block, height = (map.height + block - 1) / block;
    PagePreview out{Image(width, height, 3), Image(width, height, 1), {}};
    std::vector<std::uint32_t> counts(std::size_t{width} * height);
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const std::uint32_t t = map.texel_at[std::size_t{y} * map.width + x];
            if (t == kNone) continue;
            const auto& layers = map.texels.layers[t];
            const Vec3 light = sum_layers(weights, [&](std::size_t l) { return layers[l].irradiance; });
            float* pixel = out.irradiance.at(x / block, y / block);
            for (std::size_t c = 0; c < 3; ++c) pixel[c] += light[c];
            *out.samples.at(x / block, y / block) += static_cast<float>(map.texels.count[t]);
            ++counts[std::size_t{y / block} * width + x / block];
        }
    out.covered.resize(counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i] == 0) continue;
        out.covered[i] = 1;
        const float scale = 1.0f / static_cast<float>(counts[i]);
        for (std::size_t c = 0; c < 3; ++c) out.irradiance.data[3 * i + c] *= scale;
        out.samples.data[i] *= scale;
    }
    return out;
}

}  // namespace lumel
