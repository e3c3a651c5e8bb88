// lumel compare A B: how far image A is from reference B.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/try.h"
#include "command.h"
#include "image/metrics.h"
#include "io/image_io.h"
#include "io/page_files.h"

namespace lumel::cli {
namespace {

struct Options {
    std::string image, reference, mask, metric = "relmse";
    double max_error = -1.0;
    bool json = false;
};

// RGBA against RGB: alpha is not compared.
Image first_channels(const Image& image, std::uint32_t channels) {
    if (image.channels == channels) return image;
    Image out(image.width, image.height, channels);
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x)
            for (std::uint32_t c = 0; c < channels; ++c) out.at(x, y)[c] = image.at(x, y)[c];
    return out;
}

// Radiance against the tone-mapped picture of it: never zero apart, and by how much says nothing. Two such pictures may
// have an exposure each, and a tone curve hides what is bright.
Status warn_of_codes(const Options& options) {
    LUMEL_TRY(const bool image, is_eight_bit_image(options.image));
    LUMEL_TRY(const bool reference, is_eight_bit_image(options.reference));
    if (image && reference)
        std::fprintf(stderr,
                     "lumel: note: both have 8-bit codes, compared as stored / 255: the figures are of pictures, not "
                     "of light; for that compare .exr, .hdr or .pfm [codes]\n");
    if (image != reference)
        std::fprintf(
            stderr,
            "lumel: warning: %s has 8-bit codes, read as stored / 255, but %s has linear numbers: unless the codes "
            "are linear, too, compare two .exr, .hdr or .pfm [mixed-kinds]\n",
            (image ? options.image : options.reference).c_str(), (image ? options.reference : options.image).c_str());
    return success();
}

// A bake is no image, but has some.
Result<Image> read_compared(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return Error{ErrorCode::io, "is a folder", path,
                     "give an image; of the folder of a bake, a page of it such as " +
                         (std::filesystem::path(path) / page_file(PageFile::lightmap, 0)).string()};
    return read_image(path);
}

Result<ImageMetrics> measure(const Options& options) {
    LUMEL_TRY(Image image, read_compared(options.image));
    LUMEL_TRY(Image reference, read_compared(options.reference));
    LUMEL_TRY_STATUS(warn_of_codes(options));
    const auto size = [](const Image& i) { return std::to_string(i.width) + "x" + std::to_string(i.height); };
    if (image.width != reference.width || image.height != reference.height)
        return Error{ErrorCode::invalid_input,
                     "is " + size(image) + " but " + options.reference + " is " + size(reference), options.image,
                     "images to compare must be of equal size"};
    const std::uint32_t channels = std::min({image.channels, reference.channels, 3u});
    Mask mask;
    if (!options.mask.empty()) {
        LUMEL_TRY(const Image mask_image, read_compared(options.mask));
        if (mask_image.width != image.width || mask_image.height != image.height)
            return Error{ErrorCode::invalid_input,
                         "the mask is " + size(mask_image) + " but the images are " + size(image), options.mask,
                         "a mask must be of their size"};
        mask = mask_from_image(mask_image);
    }
    ImageMetrics metrics = compare_images(first_channels(image, channels), first_channels(reference, channels), mask);
    if (metrics.texels == 0)
        return Error{ErrorCode::invalid_input, "the mask leaves no texel to compare", options.mask,
                     "texels count where the mask is white"};
    if (metrics.reference_mean == 0.0)
        std::fprintf(stderr,
                     "lumel: warning: %s has a mean of 0: nRMSE and bias are absolute, and relMSE says nothing "
                     "[black-reference]\n",
                     options.reference.c_str());
    return metrics;
}

// JSON has no infinity: such figures are null.
nlohmann::ordered_json number(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json to_json(const ImageMetrics& m) {
    nlohmann::ordered_json out{{"texels", m.texels},
                               {"non_finite", m.non_finite},
                               {"mean", number(m.mean)},
                               {"reference_mean", number(m.reference_mean)},
                               {"nrmse", number(m.nrmse)},
                               {"relmse", number(m.relmse)},
                               {"relmse_without_worst", number(m.relmse_without_worst)},
                               {"bias", number(m.bias)},
                               {"relative_bias", number(m.relative_bias)},
                               {"block_bias_p95", number(m.block_bias_p95)},
                               {"median_relative_error", number(m.median_relative_error)},
                               {"log_psnr", number(m.log_psnr)}};
    const auto channels = [&](const std::array<float, 4>& texel) {
        return std::vector<float>(texel.begin(), texel.begin() + static_cast<std::ptrdiff_t>(m.channel_bias.size()));
    };
    for (const WorstTexel& texel : m.worst)
        out["worst"].push_back({{"x", texel.x},
                                {"y", texel.y},
                                {"relative_squared_error", number(texel.relative_squared_error)},
                                {"value", channels(texel.value)},
                                {"reference", channels(texel.reference)}});
    return out;
}

void print_channels(const std::array<float, 4>& texel, std::size_t channels) {
    for (std::size_t c = 0; c < channels; ++c) std::printf(" %.4g", static_cast<double>(texel[c]));
}

void print(const ImageMetrics& m) {
    std::printf("texels            %llu (%llu not finite), %zu channel%s\n", static_cast<unsigned long long>(m.texels),
                static_cast<unsigned long long>(m.non_finite), m.channel_bias.size(),
                m.channel_bias.size() == 1 ? "" : "s");
    std::printf("mean              %.6g, reference %.6g\n", m.mean, m.reference_mean);
    std::printf("nRMSE             %.6g\nrelMSE            %.6g, without the worst 0.1 %% of texels %.6g\n", m.nrmse,
                m.relmse, m.relmse_without_worst);
    std::printf("bias              %+.6g (%+.4f %%)\nblock bias P95    %.4f %%\n", m.bias, 100.0 * m.relative_bias,
                100.0 * m.block_bias_p95);
    std::printf("median rel. error %.4f %%\nlog-PSNR          %.2f dB\n", 100.0 * m.median_relative_error, m.log_psnr);
    for (const WorstTexel& t : m.worst) {
        if (t.relative_squared_error == 0.0) break;  // and of the rest, for the worst come first
        std::printf("worst (%u, %u):", t.x, t.y);
        print_channels(t.value, m.channel_bias.size());
        std::printf(", reference");
        print_channels(t.reference, m.channel_bias.size());
        std::printf("\n");
    }
}

}  // namespace

Run add_compare(CLI::App& app) {
    auto options = std::make_shared<Options>();
    app.add_option("A", options->image, "Image: EXR, HDR, PFM, PNG, JPEG or PGM")->required();
    app.add_option("B", options->reference, "Reference image, of the same kinds")->required();
    app.add_option("--mask", options->mask,
                   "Compare only where this image is white: PGM, PNG or any of the above (default: everywhere)");
    app.add_option("--metric", options->metric, "What --max-error looks at")->check(CLI::IsMember({"nrmse", "relmse"}));
    app.add_option("--max-error", options->max_error, "Exit with 1 above this error")
        ->default_str("none")
        ->check(not_negative());
    app.add_flag("--json", options->json, "Figures as JSON on standard output");
    return [options] {
        const Result<ImageMetrics> metrics = measure(*options);
        if (!metrics.ok()) return fail(metrics.error(), "compare");
        if (options->json)
            std::printf("%s\n", to_json(*metrics).dump(1).c_str());
        else
            print(*metrics);
        const double error = options->metric == "nrmse" ? metrics->nrmse : metrics->relmse;
        if (options->max_error < 0.0 || error <= options->max_error) return static_cast<int>(kDone);
        std::fprintf(stderr, "lumel: %s %.6g is above %.6g\n", options->metric.c_str(), error, options->max_error);
        return static_cast<int>(kFailed);
    };
}

}  // namespace lumel::cli
