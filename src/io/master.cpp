#include "io/master.h"

#include <array>
#include <cmath>

#include "base/hash.h"
#include "base/try.h"
#include "io/image_codecs.h"
#include "io/image_io.h"
#include "io/json_read.h"
#include "io/light_record.h"
#include "io/page_files.h"
#include "io/read_manifest.h"
#include "lumel/scene.h"
#include "path/radiance_sums.h"

namespace lumel {
namespace {

constexpr std::size_t kShChannels = 3 * kShCoefficients, kLayerChannels = kShChannels + 3;
constexpr std::uint32_t kRowsAtOnce = 64;
// No light is so bright; what encodings make of it, squares included, stays within float.
constexpr float kLargest = 1e15f;
constexpr std::uint64_t kMaxMasterFile = std::uint64_t{64} << 30;
constexpr const char* kGiveABake = "give the output folder of lumel bake; bake again if an older one wrote it";

bool is_possible(Vec3 v) { return max_component(max(v, -v)) <= kLargest && is_finite(v); }

// Coverage and the normal, then of each layer that counts nine coefficients and I.
std::vector<std::string> channel_names(const LayerWeights& layers) {
    std::vector<std::string> out{"coverage", "normal.X", "normal.Y", "normal.Z"};
    for (std::size_t l = 0; l < kLayerCount; ++l) {
        if (layers[l] == 0.0f) continue;
        const std::string layer = kLayerNames[l];
        for (std::size_t i = 0; i < kShCoefficients; ++i)
            for (const char* c : kRgbChannels) out.push_back(layer + ".L" + std::to_string(i) + "." + c);
        for (const char* c : kRgbChannels) out.push_back(layer + ".I." + c);
    }
    return out;
}

// A page of the manifest, or one of its mips.
Result<MasterFile> parse_master(const Json& page, const std::filesystem::path& folder, const std::string& here) {
    LUMEL_TRY(const std::uint64_t width, required_count(page, "width", here));
    LUMEL_TRY(const std::uint64_t height, required_count(page, "height", here));
    const Json* files = find(page, "files");
    const Json* master = files ? find(*files, "master") : nullptr;
    if (!master) return invalid(here, "names no master", kGiveABake);
    LUMEL_TRY(const std::string file, required_string(*master, "file", here));
    if (std::filesystem::path(file).filename() != file)
        return invalid(here, "names a master outside its folder: " + file, kGiveABake);
    if (width == 0 || height == 0 || width > kLargestPage || height > kLargestPage)
        return invalid(here, "is of a size that no bake writes", kGiveABake);
    return MasterFile{folder / file, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
}

// Each mip has half the edge of the one before.
Status parse_mips(const Json& page, const std::filesystem::path& folder, const std::string& here, MasterFile& out) {
    for (std::size_t k = 0; k < array_size(page, "mips"); ++k) {
        const std::string of_mip = here + ", mip " + std::to_string(k + 1);
        LUMEL_TRY(const Json* mip, element(page, "mips", k, here));
        LUMEL_TRY(MasterFile master, parse_master(*mip, folder, of_mip));
        const MasterFile& before = k == 0 ? out : out.mips.back();
        if (2 * master.width != before.width || 2 * master.height != before.height)
            return invalid(of_mip, "is not half as wide and high as the one before", kGiveABake);
        out.mips.push_back(std::move(master));
    }
    return success();
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
            if (!is_possible(c)) return damaged("a coefficient is not finite, or beyond all light");
        }
        irradiance = from_file_unit(irradiance, unit_of(PageFile::master));
        if (!is_possible(irradiance)) return damaged("an irradiance is not finite, or beyond all light");
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

Result<MasterPage> read_master(const MasterFile& master, const LayerWeights& layers) {
    LUMEL_TRY(MasterPage page, read_master(master.file, layers));
    if (page.width != master.width || page.height != master.height)
        return invalid(master.file.string(),
                       "has " + std::to_string(page.width) + " x " + std::to_string(page.height) +
                           " texels, and the manifest says " + std::to_string(master.width) + " x " +
                           std::to_string(master.height),
                       "the folder holds files of different bakes: bake again");
    return page;
}

Result<MasterList> list_masters(const std::filesystem::path& folder) {
    LUMEL_TRY(const std::vector<std::byte> bytes, read_manifest(folder));
    LUMEL_TRY(MasterList out, parse_master_list({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, folder,
                                                (folder / kManifestFile).string()));
    out.manifest_hash = Hasher().bytes(bytes).finish().hex();
    return out;
}

Result<MasterList> parse_master_list(std::string_view manifest, const std::filesystem::path& folder,
                                     const std::string& where) {
    LUMEL_TRY(const Json json, parse_json(manifest, where));
    MasterList out{folder / kManifestFile, {}, {}};
    for (std::size_t p = 0; p < array_size(json, "pages"); ++p) {
        const std::string here = where + ": page " + std::to_string(p);
        LUMEL_TRY(const Json* page, element(json, "pages", p, where));
        LUMEL_TRY(MasterFile master, parse_master(*page, folder, here));
        LUMEL_TRY_STATUS(parse_mips(*page, folder, here, master));
        out.pages.push_back(std::move(master));
    }
    if (out.pages.empty()) return invalid(where, "describes no pages", kGiveABake);
    return out;
}

Status check_unchanged(const MasterList& list) {
    LUMEL_TRY(const std::string hash, hash_file(list.manifest));
    if (hash != list.manifest_hash)
        return Error{ErrorCode::io, "was replaced by another bake meanwhile", list.manifest.parent_path().string(),
                     "run the command again"};
    return success();
}

}  // namespace lumel
