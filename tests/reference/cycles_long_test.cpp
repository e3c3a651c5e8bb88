// Long bakes of two scenes against those of Blender Cycles, texel by texel.
//
// Both images are noisy. The reference's noise is known (its README). Ours falls out of the product of the errors of
// two bakes with different seeds; what is left beyond the reference's noise is what the renderers differ by.
// LUMEL_REFERENCE_SAMPLES asks for more samples than the test's own.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "base/try.h"
#include "cycles_gather.h"
#include "image/metrics.h"
#include "io/gltf_document.h"
#include "io/image_io.h"
#include "lumel/bake.h"
#include "post/lightmap.h"
#include "support/test_data.h"

namespace lumel::test {
namespace {

struct Reference {
    const char* name;
    double relmse_of_noise;  // of the reference itself
    double relmse_bar;
    double left_bar;  // without the noise of both: three times what was measured
    bool shadows_on_diagonals;
    Vec3 sky{};
};

std::uint32_t samples_per_bake() {
    const char* asked = std::getenv("LUMEL_REFERENCE_SAMPLES");
    return asked ? static_cast<std::uint32_t>(std::strtoul(asked, nullptr, 10)) : 2048;
}

Result<Image> bake_irradiance(const Scene& scene, const BakeOptions& options, Context& context) {
    Image image(options.resolution_width, options.resolution_height, 3);
    BakeSink sink;
    sink.page = [&](const Lightmap& page) {
        for (std::size_t i = 0; i < page.texel_at.size(); ++i) {
            if (page.texel_at[i] == kNone) continue;
            for (const LayerMoments& layer : page.texels.layers[page.texel_at[i]])
                for (std::size_t c = 0; c < 3; ++c) image.data[3 * i + c] += layer.irradiance[c];
        }
        return success();
    };
    LUMEL_TRY_STATUS(bake(scene, options, sink, context));
    return image;
}

// relMSE without the noise of two independent images a and b.
double common_relmse(const Image& a, const Image& b, const Image& reference, const Mask& mask, double mean) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < reference.data.size(); ++i) {
        if (!mask[i / 3]) continue;
        const double r = reference.data[i];
        sum += (a.data[i] - r) * (b.data[i] - r) / (r * r + 0.01 * mean * mean);
        count += 1.0;
    }
    return sum / count;
}

class Cycles : public testing::TestWithParam<Reference> {};

TEST_P(Cycles, AgreesBeyondTheNoiseOfBoth) {
    const Reference& of = GetParam();
    const std::string name = of.name;
    const auto scene_file = data_file("scenes/bench_" + name + ".glb");
    const auto image_file = data_file("reference/cycles/" + name + "_256.pfm");
    const auto mask_file = data_file("reference/cycles/" + name + "_256_valid.pgm");
    if (!scene_file || !image_file || !mask_file) GTEST_SKIP() << "no reference data: set LUMEL_DATA";
    Context context;
    auto loaded = load_scene(*scene_file, context);
    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    Scene& scene = loaded->scene;
    const auto reference = read_image(*image_file);
    const auto valid = read_image(*mask_file);
    ASSERT_TRUE(reference.ok() && valid.ok());

    BakeOptions options;
    options.resolution_width = options.resolution_height = reference->width;
    options.samples = samples_per_bake();
    if (of.sky != Vec3{}) options.sky.color = of.sky;
    ASSERT_TRUE(apply_lighting(scene, options).ok());
    auto first = bake_irradiance(scene, options, context);
    options.seed = 2;
    auto second = bake_irradiance(scene, options, context);
    ASSERT_TRUE(first.ok() && second.ok());
    Image both = *first;
    for (std::size_t i = 0; i < both.data.size(); ++i) both.data[i] = 0.5f * (both.data[i] + second->data[i]);

    const Mask mask = mask_from_image(*valid);
    const ImageMetrics all = compare_images(both, *reference, mask);
    EXPECT_LE(std::fabs(all.relative_bias), 0.003);

    // The difference alone is taken from the finer bake: 16 of its texels lie in a middle half.
    options.resolution_width = options.resolution_height = 8 * reference->width;
    options.samples = std::max(1u, options.samples / 64);
    options.seed = 3;
    const auto fine = bake_irradiance(scene, options, context);
    ASSERT_TRUE(fine.ok()) << fine.error().text();
    const Image mirrored = light_of_mirrored_points(scene, *fine, reference->width);
    for (Image* image : {&both, &*first, &*second})
        for (std::size_t i = 0; i < image->data.size(); ++i) image->data[i] += mirrored.data[i];
    const ImageMetrics as_gathered = compare_images(both, *reference, mask);
    const double left = common_relmse(*first, *second, *reference, mask, all.reference_mean) - of.relmse_of_noise;
    std::printf(
        "%s, 2 x %u samples: bias %+.4f %%, relMSE %.3g; with Cycles' mirrored points %.3g, less all noise %.3g\n",
        of.name, samples_per_bake(), 100.0 * all.relative_bias, all.relmse, as_gathered.relmse, left);
    EXPECT_LE(as_gathered.relmse - of.relmse_of_noise, of.relmse_bar);
    EXPECT_LE(left, of.left_bar);
    if (of.shadows_on_diagonals) {
        EXPECT_LT(as_gathered.relmse, 0.5 * all.relmse);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Cycles,
                         testing::Values(Reference{"cornell", 2.6e-4, 2e-4, 2.2e-5, false},
                                         Reference{"courtyard", 4e-5, 1e-4, 4.5e-5, true, {0.7f, 0.9f, 1.3f}}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lumel::test
