// Gather rays of visible points that are aimed at hot spots: the same light with less noise.
#include "gather/spots/aimed_ray.h"

#include "core/statistics.h"
#include "gather/fill_cache.h"
#include "gather/final_gather.h"
#include "gather/visible_point.h"
#include "scene/warp.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A glossy room of 4 m; close to one wall a small lamp shines on a white card.
std::unique_ptr<Scene> glossy_room_with_a_bright_card() {
    const auto value = [](double x) { return constant_texture(x); };
    const auto gloss = make_coated_diffuse(constant_texture(Rgb(0.3)), value(0.5), value(0.5), 1.8, value(0));
    test::SceneMaker m;
    m.room({0, 0, 0}, {4, 4, 4}, gloss)
        .rectangle({3.5f, 3.5f, 0.2f}, {0.1f, 0, 0}, {0, 0.1f, 0}, make_diffuse(Rgb(0.8)))
        // Faces the card at a distance of 15 cm.
        .rectangle({3.53f, 3.53f, 0.35f}, {0, 0.04f, 0}, {0.04f, 0, 0}, make_diffuse(Rgb(0.0)), Rgb(100.0))
        .camera({0.5f, 3, 3.5f}, {3, 0, 1}, 60)
        .window(64, 64);
    return m.build();
}

class AimedGather : public testing::Test {
  protected:
    RunningStats indirect(const IrradianceCache* cache, const HotSpots* spots) const {
        const FinalGather gather(rays_, cache, spots, {.light = 1, .rays = 1});
        RunningStats sum;
        for (std::uint64_t i = 0; i < 100'000; ++i) {
            Rng rng(7, StreamPurpose::test, i);
            const double x = rng.next(), y = rng.next();
            sum.add(luminance(gather.sample({static_cast<float>(x), static_cast<float>(y)}, rng).indirect));
        }
        return sum;
    }

    std::unique_ptr<Scene> scene_ = glossy_room_with_a_bright_card();
    GatherRays rays_{*scene_, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 24};
    HotSpots spots_{rays_, 1 << 16, 1, {}};
};

/// The irradiance of a cone of radiance 1, about twice as large as the one that is aimed at, by both techniques.
TEST_F(AimedGather, DensityIsThatOfBothTechniques) {
    Rng rng(7, StreamPurpose::test, 0);
    const auto from = visible_point(rays_, {0.5f, 0.5f}, rng);
    ASSERT_TRUE(from);
    const Vec3 n = cache_normal(from->vertex, from->back);
    const auto cones = spots_.cones_from(from->vertex.point.p, n);
    ASSERT_EQ(cones.size(), 1u);
    const SpotCone& aim = cones.front();
    const double sine2 = 2 * (1 - aim.cos_half_angle * aim.cos_half_angle);
    const auto irradiance_from = [&](const Vec3& w) {
        return static_cast<double>(w.dot(aim.axis)) > std::sqrt(1 - sine2) ? static_cast<double>(w.dot(n)) : 0.0;
    };

    constexpr int kRays = 4;
    const AimedRay aimed(&spots_, from->vertex, from->vertex.bsdf, from->back, 0, kRays);
    const auto share = [&](const Vec3& w) {
        return irradiance_from(w) / aimed.density(w, static_cast<double>(w.dot(n)) * kInvPi);
    };
    RunningStats sum;
    for (int i = 0; i < 100'000; ++i) {
        double found = 0;
        for (int j = 0; j < kRays; ++j) {
            const double u0 = rng.next(), u1 = rng.next();
            found += share(Frame(n).to_world(cosine_hemisphere(u0, u1)));
        }
        if (const auto w = aimed.sample(rng)) found += share(*w);
        sum.add(found);
    }
    EXPECT_TRUE(test::has_mean(sum, kPi * sine2 * static_cast<double>(aim.axis.dot(n))));
}

TEST_F(AimedGather, BringsTheSameWithoutRecords) {
    ASSERT_GE(spots_.size(), 1u);
    const RunningStats aimed = indirect(nullptr, &spots_), blind = indirect(nullptr, nullptr);
    EXPECT_TRUE(test::same_mean(aimed, blind));
    EXPECT_LT(aimed.variance(), blind.variance() / 4);
}

TEST_F(AimedGather, BringsTheSameToGlossyParts) {
    const IrradianceCache cache = fill_cache(rays_, spots_, {}, {});
    const RunningStats aimed = indirect(&cache, &spots_), blind = indirect(&cache, nullptr);
    EXPECT_TRUE(test::same_mean(aimed, blind));
    EXPECT_LT(aimed.variance(), blind.variance() / 2);
}

} // namespace
} // namespace keyhole
