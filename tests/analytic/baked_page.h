// Bakes a scene through the public interface and compares every texel with what it should be.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "lumel/bake.h"
#include "post/lightmap.h"
#include "support/scene_builder.h"
#include "support/statistics.h"
#include "texel/texel_buffer.h"

namespace lumel::test {

struct BakedTexel {
    std::uint32_t x, y;
    Vec3 irradiance;  // I = E/pi, all layers
    Vec3 error;       // standard error, as the bake states it
    std::array<Vec3, kLayerCount> layers;
    float ambient_occlusion;
    Vec3 normal;  // the vertex normal, of one of the texel's points
    std::uint32_t chart;
};

inline std::vector<BakedTexel> bake_texels(const Scene& scene, const BakeOptions& options) {
    std::vector<BakedTexel> texels;
    BakeSink sink;
    sink.layout = [](const WorldGeometry&, const ChartSet&, const Atlas&) { return success(); };
    sink.page = [&](const Lightmap& page) {
        for (std::uint32_t y = 0; y < page.height; ++y)
            for (std::uint32_t x = 0; x < page.width; ++x) {
                const std::uint32_t i = page.texel_at[std::size_t{y} * page.width + x];
                if (i == kNone || page.coverage[i] != Coverage::baked) continue;
                BakedTexel texel{x, y, {}, {}, {}, page.texels.ambient_occlusion[i], page.normal[i], page.chart[i]};
                for (std::size_t l = 0; l < kLayerCount; ++l) {
                    texel.layers[l] = page.texels.layers[i][l].irradiance;
                    texel.irradiance += texel.layers[l];
                }
                const Vec3 variance = page.texels.variance[i];
                texel.error = {std::sqrt(variance.x), std::sqrt(variance.y), std::sqrt(variance.z)};
                texels.push_back(texel);
            }
        return success();
    };
    Context context;
    const Result<BakeReport> report = bake(scene, options, sink, context);
    if (!report.ok()) ADD_FAILURE() << report.error().text();
    return texels;
}

// I per channel that a texel should have.
using Expected = std::function<std::array<double, 3>(const BakedTexel&)>;

// Every texel within the Sidak limit, at a false-alarm rate of 1e-4 for the page, of its own stated error (with the
// floor of 1e-5 that rounding needs), and the mean of each channel within `mean_tolerance`.
inline void expect_texels(const std::vector<BakedTexel>& texels, const Expected& expected, double mean_tolerance) {
    const double limit = z_limit(sidak(1e-4, texels.size() * 3));
    std::array<double, 3> mean{}, mean_expected{};
    for (const BakedTexel& texel : texels) {
        const std::array<double, 3> e = expected(texel);
        for (std::size_t c = 0; c < 3; ++c) {
            mean[c] += texel.irradiance[c];
            mean_expected[c] += e[c];
        }
    }
    int beyond = 0;
    for (const BakedTexel& texel : texels) {
        const std::array<double, 3> e = expected(texel);
        for (std::size_t c = 0; c < 3; ++c) {
            const double floor = 1e-5 * (e[c] + mean_expected[c] / static_cast<double>(texels.size()));
            const double error = texel.irradiance[c] - e[c];
            if (std::fabs(error) <= limit * texel.error[c] + floor) continue;
            if (++beyond <= 5)
                ADD_FAILURE() << "texel " << texel.x << " " << texel.y << " channel " << c << ": "
                              << texel.irradiance[c] << " for " << e[c] << ", stated error " << texel.error[c]
                              << ", limit " << limit << " standard errors";
        }
    }
    EXPECT_EQ(beyond, 0);
    for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_GT(mean_expected[c], 0.0) << "nothing to compare";
        EXPECT_NEAR(mean[c] / mean_expected[c], 1.0, mean_tolerance) << "channel " << c;
        const std::string name = "mean_error_" + std::string(1, "rgb"[c]);
        ::testing::Test::RecordProperty(name, std::to_string(mean[c] / mean_expected[c] - 1.0));
    }
}

// A square of one chart that fills a square page: texel (x, y) is known in the world.
struct Square {
    Vec3 corner, u, v;        // faces along u x v
    std::uint32_t edge = 16;  // texels

    [[nodiscard]] Vec3 normal() const { return normalize(cross(u, v)); }

    void add_to(SceneBuilder& builder, std::uint32_t material) const {
        builder.object("square", material, [&](Mesh& mesh) {
            add_quad(mesh, corner, u, v);
            mesh.uv1 = mesh.uv0;
        });
    }
    [[nodiscard]] BakeOptions options(std::uint32_t samples) const {
        BakeOptions options;
        options.resolution_width = options.resolution_height = edge;
        options.uv1 = Uv1Choice::scene;
        options.samples = samples;
        return options;
    }
    // Mean of a function of the position over the sample points of a texel.
    template <class Function>
    [[nodiscard]] double mean_over(const BakedTexel& texel, Function&& function) const {
        double sum = 0;
        for (std::uint32_t s = 0; s < kSamplesPerTexel; ++s) {
            const Vec2 p = gather_point(~std::uint64_t{0}, s);  // every texel of the square is covered whole
            const float a = (static_cast<float>(texel.x) + p.x) / static_cast<float>(edge);
            const float b = (static_cast<float>(texel.y) + p.y) / static_cast<float>(edge);
            sum += function(corner + u * a + v * b);
        }
        return sum / kSamplesPerTexel;
    }
};

}  // namespace lumel::test
