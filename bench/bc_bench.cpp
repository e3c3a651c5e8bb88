// Block compression of baked lightmaps: error and speed of each format, against our own encoders held to what simpler
// ones do, and with masks against the two ways to fill texels that nobody sees.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bc/bc1.h"
#include "bc/bc4.h"
#include "bc/bc5.h"
#include "bc/bc6h.h"
#include "bc/bc7.h"
#include "bc/block_image.h"
#include "bench.h"
#include "image/metrics.h"
#include "io/image_io.h"
#include "load.h"

namespace lumel::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::vector<std::string> lightmaps;
    std::uint32_t threads = 1;
    double seconds = 0.5;
};

// Blocks of one kind, cut out of a page and put side by side: a picture in which every block counts.
struct Blocks {
    Image image;
    std::vector<float> weights;  // 0 or 1
};

struct BlockPlace {
    std::uint32_t x, y;
};

constexpr std::uint32_t kBlocksAcross = 64;

// Places of the blocks with 16 covered texels, or of those with some.
std::vector<BlockPlace> places(const Mask& covered, std::uint32_t width, std::uint32_t height, bool full) {
    std::vector<BlockPlace> out;
    for (std::uint32_t y = 0; y + 4 <= height; y += 4)
        for (std::uint32_t x = 0; x + 4 <= width; x += 4) {
            unsigned count = 0;
            for (std::uint32_t i = 0; i < 16; ++i)
                count += covered[(y + i / 4) * std::size_t{width} + x + i % 4] != 0 ? 1 : 0;
            if (full ? count == 16 : count > 0 && count < 16) out.push_back({x, y});
        }
    return out;
}

Blocks cut_out(const Image& page, const Mask& covered, const std::vector<BlockPlace>& from) {
    const auto rows = static_cast<std::uint32_t>((from.size() + kBlocksAcross - 1) / kBlocksAcross);
    Blocks out{Image(4 * kBlocksAcross, 4 * rows, page.channels), {}};
    out.weights.assign(std::size_t{out.image.width} * out.image.height, 0.0f);
    for (std::size_t b = 0; b < from.size(); ++b)
        for (std::uint32_t i = 0; i < 16; ++i) {
            const std::uint32_t x = from[b].x + i % 4, y = from[b].y + i / 4;
            const auto to_x = static_cast<std::uint32_t>(4 * (b % kBlocksAcross)) + i % 4;
            const auto to_y = static_cast<std::uint32_t>(4 * (b / kBlocksAcross)) + i / 4;
            std::copy_n(page.at(x, y), page.channels, out.image.at(to_x, to_y));
            const bool counts = covered[y * std::size_t{page.width} + x] != 0;
            out.weights[to_y * std::size_t{out.image.width} + to_x] = counts ? 1.0f : 0.0f;
        }
    return out;
}

// What a block's unseen texels hold in the two simpler ways to deal with them; all texels then weigh the same.
enum class Fill { zero, mean };

Blocks filled(const Blocks& blocks, Fill fill) {
    Blocks out = blocks;
    const std::uint32_t width = out.image.width, channels = out.image.channels;
    for (std::uint32_t y = 0; y < out.image.height; y += 4)
        for (std::uint32_t x = 0; x < width; x += 4) {
            std::vector<float> sum(channels + 1, 0.0f);
            const auto weight = [&](std::uint32_t i) -> float& {
                return out.weights[(y + i / 4) * std::size_t{width} + x + i % 4];
            };
            for (std::uint32_t i = 0; i < 16; ++i) {
                for (std::uint32_t c = 0; c < channels; ++c)
                    sum[c] += weight(i) * out.image.at(x + i % 4, y + i / 4)[c];
                sum[channels] += weight(i);
            }
            for (std::uint32_t i = 0; i < 16; ++i) {
                float* texel = out.image.at(x + i % 4, y + i / 4);
                const bool unseen = weight(i) == 0.0f;
                for (std::uint32_t c = 0; c < channels && unseen; ++c)
                    texel[c] = fill == Fill::mean && sum[channels] > 0.0f ? sum[c] / sum[channels] : 0.0f;
                weight(i) = 1.0f;
            }
        }
    return out;
}

Mask mask_of(const Blocks& blocks) {
    Mask out(blocks.weights.size());
    std::transform(blocks.weights.begin(), blocks.weights.end(), out.begin(),
                   [](float w) { return static_cast<std::uint8_t>(w > 0.0f ? 1 : 0); });
    return out;
}

// Over the masked texels and all channels of the reference.
double mean_square(const Image& image, const Image& reference, const Mask& mask,
                   const std::function<double(double, double)>& difference) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (mask[i] == 0) continue;
        for (std::uint32_t c = 0; c < reference.channels; ++c) {
            const double d = difference(static_cast<double>(image.data[i * image.channels + c]),
                                        static_cast<double>(reference.data[i * reference.channels + c]));
            sum += d * d;
            count += 1.0;
        }
    }
    return count > 0.0 ? sum / count : 0.0;
}

// Root mean square of the difference of logarithms; what is below 1e-4 is as good as black.
double rmsle(const Image& image, const Image& reference, const Mask& mask) {
    return std::sqrt(mean_square(image, reference, mask, [](double a, double b) {
        return std::log(std::max(a, 0.0) + 1e-4) - std::log(std::max(b, 0.0) + 1e-4);
    }));
}

double psnr(const Image& image, const Image& reference, const Mask& mask) {
    return -10.0 * std::log10(mean_square(image, reference, mask, [](double a, double b) { return a - b; }));
}

struct Coder {
    std::string name;
    std::function<std::vector<std::uint8_t>(const Blocks&, Context&)> encode;
    std::function<Image(const std::vector<std::uint8_t>&, const Image&)> decode;
};

constexpr std::array<std::pair<const char*, BcQuality>, 3> kQualities = {
    {{"fast", BcQuality::fast}, {"normal", BcQuality::normal}, {"best", BcQuality::best}}};

Coder bc6h(std::string name, Bc6hOptions options) {
    return {
        std::move(name),
        [=](const Blocks& b, Context& context) { return need(encode_bc6h(b.image, b.weights, options, context)); },
        [=](const auto& bytes, const Image& as) { return decode_bc6h(bytes, as.width, as.height, options.is_signed); }};
}

Coder bc7(std::string name, Bc7Options options) {
    return {std::move(name),
            [=](const Blocks& b, Context& context) { return need(encode_bc7(b.image, b.weights, options, context)); },
            [=](const auto& bytes, const Image& as) { return decode_bc7(bytes, as.width, as.height); }};
}

Coder bc1(std::string name, BcQuality quality) {
    return {std::move(name),
            [=](const Blocks& b, Context& context) { return need(encode_bc1(b.image, b.weights, {quality}, context)); },
            [=](const auto& bytes, const Image& as) { return decode_bc1(bytes, as.width, as.height); }};
}

std::string file_label(const fs::path& path) {
    return path.parent_path().filename().string() + "/" + path.filename().string();
}

struct Row {
    std::string file, texture, blocks;
    std::size_t block_count = 0;
};

// Encodes until the clock can tell, and prints the errors of what comes out against `truth` where that counts.
void run(const Row& row, const Coder& coder, const Blocks& input, const Blocks& truth, const Options& options,
         Context& context) {
    const CpuStopwatch clock;
    std::vector<std::uint8_t> bytes;
    double rounds = 0.0;
    do {
        bytes = coder.encode(input, context);
        rounds += 1.0;
    } while (clock.seconds() < options.seconds);
    const double rate = rounds * 16.0 * static_cast<double>(row.block_count) / clock.seconds();
    const Image decoded = coder.decode(bytes, truth.image);
    const Mask mask = mask_of(truth);
    Image comparable(truth.image.width, truth.image.height, truth.image.channels);
    for (std::size_t i = 0; i < mask.size(); ++i)
        std::copy_n(&decoded.data[i * decoded.channels], comparable.channels,
                    &comparable.data[i * comparable.channels]);
    const ImageMetrics metrics = compare_images(comparable, truth.image, mask);
    std::printf("%s,%s,%s,%zu,%s,%.5f,%.2f,%.2f,%.2f\n", row.file.c_str(), row.texture.c_str(), row.blocks.c_str(),
                row.block_count, coder.name.c_str(), rmsle(decoded, truth.image, mask), metrics.log_psnr,
                psnr(decoded, truth.image, mask), 1e-6 * rate);
    std::fflush(stdout);
}

void run_light(const fs::path& path, const Image& page, const Mask& covered, const Options& options, Context& context) {
    const auto full_places = places(covered, page.width, page.height, true);
    const auto partial_places = places(covered, page.width, page.height, false);
    const Blocks full = cut_out(page, covered, full_places), partial = cut_out(page, covered, partial_places);
    const Row full_row{file_label(path), "irradiance", "full", full_places.size()};
    Bc6hOptions mode_11;
    mode_11.only_mode_11 = true;
    run(full_row, bc6h("bc6h-mode-11", mode_11), full, full, options, context);
    for (const auto& [name, quality] : kQualities) {
        Bc6hOptions o;
        o.quality = quality;
        run(full_row, bc6h(std::string("bc6h-") + name, o), full, full, options, context);
        o.is_signed = true;
        if (quality == BcQuality::normal) run(full_row, bc6h("bc6h-signed-normal", o), full, full, options, context);
    }
    const Row row{file_label(path), "irradiance", "partial", partial_places.size()};
    run(row, bc6h("bc6h-normal zero-fill", {}), filled(partial, Fill::zero), partial, options, context);
    run(row, bc6h("bc6h-normal mean-fill", {}), filled(partial, Fill::mean), partial, options, context);
    run(row, bc6h("bc6h-normal masked", {}), partial, partial, options, context);
}

// The vector of one colour channel over the constant band, -1..1, as textures hold it: eight bits of 0..1.
Image l1_texture(const fs::path& path, char channel) {
    const std::string stem = std::string("L1n.") + channel + ".";
    const std::vector<std::string> names = {stem + "X", stem + "Y", stem + "Z"};
    const NamedChannels planes = need(read_exr_channels(path, names));
    Image out(planes.width, planes.height, 3);
    for (std::size_t i = 0; i < out.data.size(); ++i) {
        const float value = std::clamp(planes.planes[i % 3][i / 3] * 0.5f + 0.5f, 0.0f, 1.0f);
        out.data[i] = std::floor(value * 255.0f + 0.5f) / 255.0f;
    }
    return out;
}

void run_l1(const fs::path& path, const Mask& covered, const Options& options, Context& context) {
    for (const char channel : {'R', 'G', 'B'}) {
        const Image page = l1_texture(path, channel);
        const auto full_places = places(covered, page.width, page.height, true);
        const auto partial_places = places(covered, page.width, page.height, false);
        const Blocks full = cut_out(page, covered, full_places), partial = cut_out(page, covered, partial_places);
        const Row row{file_label(path), std::string("L1n.") + channel, "full", full_places.size()};
        Bc7Options mode_6;
        mode_6.only_mode_6 = true;
        run(row, bc7("bc7-mode-6", mode_6), full, full, options, context);
        for (const auto& [name, quality] : kQualities)
            run(row, bc7(std::string("bc7-") + name, {quality, false}), full, full, options, context);
        for (const auto& [name, quality] : kQualities)
            run(row, bc1(std::string("bc1-") + name, quality), full, full, options, context);
        const Row cut{file_label(path), std::string("L1n.") + channel, "partial", partial_places.size()};
        run(cut, bc7("bc7-normal zero-fill", {}), filled(partial, Fill::zero), partial, options, context);
        run(cut, bc7("bc7-normal mean-fill", {}), filled(partial, Fill::mean), partial, options, context);
        run(cut, bc7("bc7-normal masked", {}), partial, partial, options, context);
    }
}

Mask coverage(const fs::path& master) {
    const std::vector<std::string> names = {"coverage"};
    const NamedChannels planes = need(read_exr_channels(master, names));
    Mask out(planes.planes[0].size());
    std::transform(planes.planes[0].begin(), planes.planes[0].end(), out.begin(),
                   [](float v) { return static_cast<std::uint8_t>(v > 0.0f ? 1 : 0); });
    return out;
}

fs::path beside(const fs::path& lightmap, const std::string& stem) {
    const std::string name = lightmap.filename().string();
    const std::size_t cut = name.rfind('_');
    if (cut == std::string::npos) throw std::runtime_error(lightmap.string() + ": not a lightmap_<page>.exr");
    return lightmap.parent_path() / (stem + name.substr(cut));
}

void run_bc(const Options& options) {
    Context context(options.threads);
    std::printf("file,texture,blocks,count,encoder,rmsle,log_psnr_db,psnr_db,mtexels_per_cpu_second\n");
    for (const std::string& name : options.lightmaps) {
        const Mask covered = coverage(beside(name, "master"));
        run_light(name, need(read_image(name)), covered, options, context);
        run_l1(beside(name, "l1"), covered, options, context);
    }
}

}  // namespace

void add_bc(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("bc", "Block compression of baked pages: error and speed");
    command
        ->add_option("lightmaps", options->lightmaps, "lightmap_<page>.exr of finished bakes, the master and L1 beside")
        ->required()
        ->check(CLI::ExistingFile);
    command->add_option("--threads", options->threads)->check(CLI::Range(1u, 1024u));
    command->add_option("--seconds", options->seconds, "CPU time for each measurement, at least");
    command->callback([options] { run_bc(*options); });
}

}  // namespace lumel::bench
