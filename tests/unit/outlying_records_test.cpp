// What one record has too much is shared out: no light is lost, and what is really there stays.
#include "gather/outlying_records.h"

#include "core/rng.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr int kSide = 12, kMiddle = kSide / 2 * kSide + kSide / 2;

/// Records on a plane, a radius apart. `light(i)` is what record i has [W/m^2], `variance(i)` that of its luminance.
template <class Light, class Variance> IrradianceCache plane(Light&& light, Variance&& variance) {
    IrradianceCache cache(0.2f);
    for (int i = 0; i < kSide * kSide; ++i) {
        IrradianceRecord r;
        r.position = Vec3(0.2f * static_cast<float>(i % kSide), 0.2f * static_cast<float>(i / kSide), 0);
        r.normal = {0, 0, 1};
        r.min_radius = 0.01f;
        r.max_radius = i % 2 == 0 ? 0.2f : 0.15f; // areas differ
        r.light.irradiance = light(i);
        r.light.distance = 1;
        r.light.variance = variance(i);
        cache.insert(r);
    }
    return cache;
}

/// Irradiance times area, by channel.
Rgb sum(const IrradianceCache& cache) {
    Rgb all(0.0);
    for (std::size_t i = 0; i < cache.size(); ++i)
        all += cache.light(i) * (static_cast<double>(cache.radius(i)) * cache.radius(i));
    return all;
}

double noisy(Rng& rng) { return 10 + std::sqrt(12.0) * (rng.next() - 0.5); }

TEST(OutlyingRecords, ShareWhatOneRayFoundAndLoseNoLight) {
    Rng rng(1, StreamPurpose::test, 0);
    // A ray that brought 40 to one record: that is its standard error, too.
    IrradianceCache cache =
        plane([&](int i) { return Rgb(i == kMiddle ? 50.0 : noisy(rng), 10, i == kMiddle ? 25 : 10); },
              [](int i) { return i == kMiddle ? 1600.0 : 1.0; });
    const Rgb before = sum(cache);
    EXPECT_GT(share_outlying_light(cache), 0);
    const Rgb after = sum(cache);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c] / before[c], 1, 1e-5) << "channel " << c;
    EXPECT_LT(cache.light(kMiddle).x, 30);
    EXPECT_GT(cache.light(kMiddle - 1).x + cache.light(kMiddle + 1).x, 21) << "those beside it got their share";
}

TEST(OutlyingRecords, AreNotThoseWhoseRaysAgree) {
    IrradianceCache cache = plane([](int i) { return Rgb(i == kMiddle ? 50 : 10); }, [](int) { return 1.0; });
    const double before = cache.light(kMiddle).y;
    share_outlying_light(cache);
    EXPECT_GT(cache.light(kMiddle).y, before - 2) << "a patch of light that is there, with a standard error of 1";
}

TEST(OutlyingRecords, AreNotNoiseLikeThatOfAllNorASlope) {
    Rng rng(2, StreamPurpose::test, 0);
    for (const bool slope : {false, true}) {
        IrradianceCache cache = plane([&](int i) { return Rgb(slope ? 1 + i % kSide : noisy(rng)); },
                                      [&](int) { return slope ? 0.01 : 1; });
        std::vector<Rgb> before;
        for (std::size_t i = 0; i < cache.size(); ++i) before.push_back(cache.light(i));
        EXPECT_LT(share_outlying_light(cache), 0.1);
        for (std::size_t i = 0; i < cache.size(); ++i)
            EXPECT_NEAR(cache.light(i).y, before[i].y, slope ? 0.2 : 1.5) << "record " << i;
    }
}

} // namespace
} // namespace keyhole
