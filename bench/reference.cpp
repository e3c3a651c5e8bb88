#include "reference.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <stdexcept>

#include "base/hash.h"
#include "base/stopwatch.h"
#include "io/image_io.h"
#include "light/light_set.h"
#include "load.h"
#include "path/gather_page.h"
#include "path/path_integrator.h"

namespace lumel::bench {
namespace {

constexpr std::uint32_t kPassSamples = 256;
constexpr std::uint64_t kMagic =
    0x33304645526c6d4cull;  // "LmlREF03": raise it when brute force changes what it computes

// Sums of TexelLight over all samples, as doubles: I and SH of three channels.
constexpr std::size_t kNumbers = 3 * (1 + kScoredSh);

struct TexelSums {
    std::array<double, kNumbers> sums{};
    std::uint64_t open = 0, traced = 0;  // samples that met no back first, all
};

struct Header {
    std::uint64_t magic = kMagic, texels = 0, passes = 0;
    double seconds = 0.0;
};

struct Half {
    Header header;
    std::vector<TexelSums> texels;
};

std::array<double, kNumbers> numbers_of(const TexelLight& light) {
    std::array<double, kNumbers> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        out[c] = static_cast<double>(light.irradiance[c]);
        for (std::size_t k = 0; k < kScoredSh; ++k) out[3 * (k + 1) + c] = static_cast<double>(light.sh[k][c]);
    }
    return out;
}

TexelLight mean_of(const TexelSums& texel) {
    TexelLight out;
    if (texel.traced == 0) return out;
    const auto mean = [&](std::size_t i) {
        return static_cast<float>(texel.sums[i] / static_cast<double>(texel.traced));
    };
    for (std::size_t c = 0; c < 3; ++c) {
        out.irradiance[c] = mean(c);
        for (std::size_t k = 0; k < kScoredSh; ++k) out.sh[k][c] = mean(3 * (k + 1) + c);
    }
    return out;
}

std::filesystem::path file_of(const BenchScene& bench, TexelRange range, std::uint32_t which,
                              const std::filesystem::path& folder) {
    Hasher hash;
    hash.text(hash_scene(bench.scene).hex()).pod(bench.texels.width).pod(bench.texels.height);
    hash.pod(std::uint64_t{range.first}).pod(std::uint64_t{range.count}).pod(std::uint64_t{bench.texels.size()});
    const std::string stem = std::filesystem::path(bench.name).stem().string();
    return folder / (stem + "_" + std::to_string(bench.texels.width) + "x" + std::to_string(bench.texels.height) + "_" +
                     hash.finish().hex().substr(0, 16) + (which == 0 ? "_a" : "_b") + ".half");
}

// Nothing where the file is absent, of another version, or damaged: then it is made anew.
Half read_half(const std::filesystem::path& file, std::size_t texels) {
    Half half;
    half.header.texels = texels;
    half.texels.resize(texels);
    const auto bytes = read_file(file, std::uint64_t{1} << 32);
    if (!bytes.ok() || bytes->size() != sizeof(Header) + texels * sizeof(TexelSums)) return half;
    Header header;
    std::memcpy(&header, bytes->data(), sizeof header);
    if (header.magic != kMagic || header.texels != texels) return half;
    half.header = header;
    std::memcpy(half.texels.data(), bytes->data() + sizeof header, texels * sizeof(TexelSums));
    return half;
}

void write_half(const std::filesystem::path& file, const Half& half) {
    std::vector<std::byte> bytes(sizeof(Header) + half.texels.size() * sizeof(TexelSums));
    std::memcpy(bytes.data(), &half.header, sizeof(Header));
    std::memcpy(bytes.data() + sizeof(Header), half.texels.data(), half.texels.size() * sizeof(TexelSums));
    need(write_file(file, bytes));
}

void add_pass(Half& half, const BenchScene& bench, TexelRange range, const LightSet& lights, std::uint32_t which,
              Context& context) {
    PathOptions path;
    path.samples = kPassSamples;
    // No seed that a method is run with, and none of the other half.
    path.seed = 0x10000000000ull + half.header.passes * 2 + which;
    const RadianceSums sums = need(gather_page(bench.texels, bench.charts, bench.atlas,
                                               {bench.scene, bench.geometry, bench.surfaces, lights, *bench.tracer},
                                               path, range.first, range.count, context));
    for (std::size_t i = 0; i < range.count; ++i) {
        const std::size_t texel = range.first + i;
        const auto numbers = numbers_of(light_of(sums, texel));
        TexelSums& into = half.texels[i];
        const std::uint32_t traced = sums.count[texel];
        for (std::size_t k = 0; k < kNumbers; ++k) into.sums[k] += numbers[k] * static_cast<double>(traced);
        into.open += sums.open[texel];
        into.traced += traced;
    }
    ++half.header.passes;
}

}  // namespace

TexelLight light_of(const RadianceSums& sums, std::size_t texel) {
    TexelLight out;
    for (const LayerMoments& layer : sums.layers[texel]) {
        out.irradiance += layer.irradiance;
        for (std::size_t k = 0; k < kScoredSh; ++k) out.sh[k] += layer.sh[k];
    }
    return out;
}

std::filesystem::path default_reference_folder() {
    if (const char* named = std::getenv("LUMEL_BENCH_REFERENCES"); named && *named) return named;
    return std::filesystem::temp_directory_path() / "lumel-bench-references";
}

ReferenceHalf reference_half(const BenchScene& bench, TexelRange range, std::uint32_t which,
                             const ReferenceOptions& options, Context& context) {
    std::filesystem::create_directories(options.folder);
    const std::filesystem::path file = file_of(bench, range, which, options.folder);
    Half half = read_half(file, range.count);
    const LightSet lights(bench.scene, bench.geometry, bench.surfaces);
    double longest = 0.0;
    const auto wanted = [&] {
        if (half.header.passes == 0) return true;
        return half.header.passes * kPassSamples < options.samples &&
               half.header.seconds + longest <= 60.0 * options.minutes;
    };
    bool more = false;
    while (wanted()) {
        const Stopwatch clock;
        add_pass(half, bench, range, lights, which, context);
        const double seconds = clock.seconds();
        half.header.seconds += seconds;
        longest = std::max(longest, seconds);
        more = true;
    }
    if (more) write_half(file, half);

    ReferenceHalf out;
    out.samples = half.header.passes * kPassSamples;
    for (const TexelSums& texel : half.texels) {
        out.light.push_back(mean_of(texel));
        out.valid.push_back(texel.traced > 0 && 2 * texel.open >= texel.traced ? 1 : 0);
    }
    return out;
}

}  // namespace lumel::bench
