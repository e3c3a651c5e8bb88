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
    Vec3 sky{};
};

std::uint32_t samples_per_bake() {
    const char* asked = std::getenv("LUMEL_REFERENCE_SAMPLES");
    return asked ? static_cast<std::uint32_t>(std::strtoul(asked, nullptr, 10)) : 2048;
}

// Texels that an edge of a triangle runs through. Cycles gathers such a texel from the one triangle that has its
// centre, with barycentrics clamped to it: at a shadow's edge it is off by as much as the light itself. (With the other
// diagonal of the quads left out instead, the figure does not change.)
Mask off_the_edges(const Scene& scene, std::uint32_t size, Mask mask) {
    for (const auto& mesh : scene.meshes) {
        if (mesh->uv1.empty()) continue;
        for (const Triangle& t : mesh->triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec2 a = mesh->uv1[t[k]], b = mesh->uv1[t[(k + 1) % 3]];
                const int steps = static_cast<int>(16 * size);
                for (int s = 0; s <= steps; ++s) {
                    const Vec2 p =
                        (a + (b - a) * (static_cast<float>(s) / static_cast<float>(steps))) * static_cast<float>(size);
                    const auto x = std::min(static_cast<std::uint32_t>(p.x), size - 1);
                    const auto y = std::min(static_cast<std::uint32_t>(p.y), size - 1);
                    mask[std::size_t{y} * size + x] = 0;
                }
            }
    }
    return mask;
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
    const auto second = bake_irradiance(scene, options, context);
    ASSERT_TRUE(first.ok() && second.ok());
    Image both = *first;
    for (std::size_t i = 0; i < both.data.size(); ++i) both.data[i] = 0.5f * (both.data[i] + second->data[i]);

    const Mask mask = mask_from_image(*valid);
    const ImageMetrics all = compare_images(both, *reference, mask);
    const Mask inner = off_the_edges(scene, reference->width, mask);
    const ImageMetrics off_edges = compare_images(both, *reference, inner);
    const double left =
        common_relmse(*first, *second, *reference, inner, off_edges.reference_mean) - of.relmse_of_noise;
    std::printf("%s, 2 x %u samples: bias %+.4f %%, relMSE %.3g; off the triangles' edges %.3g, less all noise %.3g\n",
                of.name, options.samples, 100.0 * all.relative_bias, all.relmse, off_edges.relmse, left);
    EXPECT_LE(std::fabs(all.relative_bias), 0.003);
    EXPECT_GT(off_edges.texels, all.texels * 9 / 10);
    EXPECT_LE(left, of.relmse_bar);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Cycles,
                         testing::Values(Reference{"cornell", 2.6e-4, 2e-4},
                                         Reference{"courtyard", 4e-5, 1e-4, {0.7f, 0.9f, 1.3f}}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace lumel::test
