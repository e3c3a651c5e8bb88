// What must hold for any light that is sampled and hit: expectations, and that the two ways of meeting it agree.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "light/light_sample.h"
#include "math/constants.h"
#include "math/frame.h"
#include "math/warp.h"
#include "support/statistics.h"

namespace lumel::test {

using SampleLight = std::function<LightSample(Vec2)>;
using MeetLight = std::function<LightHit(Vec3 direction)>;

// Green channel of E[weight * cos]: the irradiance on a plane of the given normal. Of the channels, so that a mix-up of
// one colour with another would show, lights of tests have different ones and checks ask for green.
inline Moments irradiance_by_light(const SampleLight& sample, Vec3 normal, int count = 200000, std::uint64_t seed = 1) {
    Random random(seed);
    Moments moments;
    for (int i = 0; i < count; ++i) {
        const LightSample s = sample(random.pair());
        moments.add(s.distance > 0.0f ? double{s.weight.y} * std::max(0.0f, dot(s.direction, normal)) : 0.0);
    }
    return moments;
}

// The same by rays over the hemisphere alone (hits only).
inline Moments irradiance_by_rays(const MeetLight& meet, Vec3 normal, int count = 200000, std::uint64_t seed = 2) {
    Random random(seed);
    const Frame frame(normal);
    Moments moments;
    for (int i = 0; i < count; ++i) {
        const Vec3 local = CosineHemisphere::sample(random.pair());
        moments.add(double{kPi} * meet(frame.to_world(local)).radiance.y);
    }
    return moments;
}

// And by both, weighted by the balance heuristic: wrong by their disagreement where the pdf of a hit is not that of the
// sample.
inline Moments irradiance_by_both(const SampleLight& sample, const MeetLight& meet, Vec3 normal, int count = 200000,
                                  std::uint64_t seed = 3) {
    Random random(seed);
    const Frame frame(normal);
    Moments moments;
    for (int i = 0; i < count; ++i) {
        double sum = 0.0;
        const LightSample s = sample(random.pair());
        const double cosine = dot(s.direction, normal);
        if (s.distance > 0.0f && cosine > 0.0)
            sum += s.weight.y * cosine * (s.pdf > 0.0f ? s.pdf / (s.pdf + cosine * kInvPi) : 1.0);
        const Vec3 local = CosineHemisphere::sample(random.pair());
        const LightHit hit = meet(frame.to_world(local));
        const double pdf = CosineHemisphere::pdf(local.z);
        sum += hit.radiance.y * local.z / (pdf + hit.pdf);
        moments.add(sum);
    }
    return moments;
}

// Samples lead to hits with the same distance, density and radiance. `tolerance` is relative: float directions of small
// or grazed lights cannot do better than (rounding / angle).
inline void expect_samples_hit(const SampleLight& sample, const MeetLight& meet, double tolerance, int count = 20000) {
    Random random(4);
    int missed = 0, sampled = 0;
    for (int i = 0; i < count; ++i) {
        const LightSample s = sample(random.pair());
        if (s.distance == 0.0f) continue;
        ++sampled;
        ASSERT_NEAR(length(s.direction), 1.0, 1e-6);
        const LightHit hit = meet(s.direction);
        if (hit.pdf == 0.0f) {
            ++missed;  // off the edge by rounding
            continue;
        }
        if (s.distance < kInfiniteDistance) {
            ASSERT_NEAR(hit.distance / s.distance, 1.0, tolerance);
        }
        ASSERT_NEAR(hit.pdf / s.pdf, 1.0, tolerance);
        ASSERT_NEAR(hit.radiance.y / (s.weight.y * s.pdf), 1.0, tolerance);
        ASSERT_NEAR(hit.radiance.x / (s.weight.x * s.pdf), 1.0, tolerance);
        ASSERT_NEAR(hit.radiance.z / (s.weight.z * s.pdf), 1.0, tolerance);
    }
    ASSERT_GT(sampled, 0);
    EXPECT_LE(missed, count / 500);
}

}  // namespace lumel::test
