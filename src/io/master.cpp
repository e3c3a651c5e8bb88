#include "io/master.h"

#include <array>
#include <cmath>

#include "base/try.h"
#include "io/image_codecs.h"
#include "io/page_files.h"
#include "lumel/scene.h"
#include "path/radiance_sums.h"

namespace lumel {
namespace {

constexpr std::array<const char*, 3> kRgb{"R", "G", "B"};
constexpr std::size_t kShChannels = 3 * kShCoefficients, kLayerChannels = kShChannels + 3;
constexpr std::uint32_t kRowsAtOnce = 64;
constexpr std::uint64_t kMaxMasterFile = std::uint64_t{64} << 30;

// Coverage and the normal, then of each layer that counts nine coefficients and I.
std::vector<std::string> channel_names(const LayerWeights& layers) {
    std::vector<std::string> out{"coverage", "normal.X", "normal.Y", "normal.Z"};
    for (std::size_t l = 0; l < kLayerCount; ++l) {
        if (layers[l] == 0.0f) continue;
        const std::string layer = kLayerNames[l];
        for (std::size_t i = 0; i < kShCoefficients; ++i)
            for (const char* c : kRgb) out.push_back(layer + ".L" + std::to_string(i) + "." + c);
        for (const char* c : kRgb) out.push_back(layer + ".I." + c);
    }
    return out;
}

class MasterReader {
public:
    MasterReader(const LayerWeights& layers, std::string where) : layers_(layers), where_(std::move(where)) {}

    Status add(const NamedChannels& band) {
        page_.width = band.width;
        page_.height += band.height;
        for (std::size_t i = 0; i < band.planes[0].size(); ++i) {
            const float coverage = band.planes[0][i];
            if (coverage == 0.0f) {
                page_.texel_at.push_back(kNone);
                continue;
            }
            LUMEL_TRY_STATUS(add_texel(band, i, coverage));
        }
        return success();
    }
    MasterPage finish() && { return std::move(page_); }

private:
    Status add_texel(const NamedChannels& band, std::size_t i, float coverage) {
        if (!(coverage == 1.0f || coverage == 2.0f || coverage == 3.0f)) return damaged("coverage is none of 0 to 3");
        const Vec3 normal{band.planes[1][i], band.planes[2][i], band.planes[3][i]};
        const float size = length(normal);
        // Of halves, so that it is a little off.
        if (!(size > 0.99f && size < 1.01f)) return damaged("a normal is not of unit length");
        RadianceSh<Vec3, 9> radiance;
        Vec3 irradiance{};
        std::size_t first = 4;
        for (const float weight : layers_) {
            if (weight == 0.0f) continue;
            const auto value = [&](std::size_t k) {
                return Vec3{band.planes[first + 3 * k][i], band.planes[first + 3 * k + 1][i],
                            band.planes[first + 3 * k + 2][i]} *
                       weight;
            };
            for (std::size_t k = 0; k < kShCoefficients; ++k) radiance.c[k] += value(k);
            irradiance += value(kShCoefficients);
            first += kLayerChannels;
        }
        for (Vec3& c : radiance.c) {
            c = from_file_unit(c, unit_of(PageFile::master));
            if (!is_finite(c)) return damaged("a coefficient is not finite");
        }
        irradiance = from_file_unit(irradiance, unit_of(PageFile::master));
        if (!is_finite(irradiance)) return damaged("an irradiance is not finite");
        page_.texel_at.push_back(static_cast<std::uint32_t>(page_.size()));
        page_.coverage.push_back(static_cast<std::uint8_t>(coverage));
        page_.radiance.push_back(radiance);
        page_.irradiance.push_back(irradiance);
        page_.normal.push_back(normal / size);
        return success();
    }
    [[nodiscard]] Error damaged(const char* what) const {
        return {ErrorCode::invalid_input, what, where_, "the file is damaged: bake again"};
    }

    LayerWeights layers_;
    std::string where_;
    MasterPage page_;
};

}  // namespace

Result<MasterPage> decode_master(std::span<const std::byte> exr, const LayerWeights& layers, const std::string& where) {
    MasterReader reader(layers, where);
    LUMEL_TRY_STATUS(decode_exr_bands(
        exr, channel_names(layers), kRowsAtOnce,
        [&](const NamedChannels& band, std::uint32_t) { return reader.add(band); }, where));
    return std::move(reader).finish();
}

Result<MasterPage> read_master(const std::filesystem::path& file, const LayerWeights& layers) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_file(file, kMaxMasterFile));
    return decode_master(bytes, layers, file.string());
}

}  // namespace lumel
