// Records, and rays that are traced on, that aim at hot spots: the same irradiance, less of a gamble.
#include "core/statistics.h"
#include "gather/compute_record.h"
#include "gather/spots/spot_mixture.h"
#include "mapped_gather.h"
#include "photon_support.h"
#include "scene/warp.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A room of 4 m; close to one wall a small lamp shines on a white card.
std::unique_ptr<Scene> room_with_a_bright_card() {
    const auto gray = make_diffuse(Rgb(0.5)), black = make_diffuse(Rgb(0.0));
    test::SceneMaker m;
    m.room({0, 0, 0}, {4, 4, 4}, gray)
        .rectangle({3.5f, 3.5f, 0.2f}, {0.1f, 0, 0}, {0, 0.1f, 0}, make_diffuse(Rgb(0.8)))
        // Faces the card at a distance of 15 cm.
        .rectangle({3.53f, 3.53f, 0.35f}, {0, 0.04f, 0}, {0.04f, 0, 0}, black, Rgb(100.0))
        .camera({2, 2, 3.9f}, {2, 1, 0}, 90)
        .window(64, 64);
    return m.build();
}

struct Records {
    RunningStats irradiance;
    double slope = 0; ///< mean of the derivative of the irradiance along x
};

constexpr int kRecords = 1600;

class SpotRecords : public testing::Test {
  protected:
    SpotRecords() : from_(*visible_point(rays_, {0.5f, 0.8f}, rng_)) {
        EXPECT_GT(from_.vertex.point.ng.y, 0.9f) << "that is not the floor";
    }

    Records make(const HotSpots& spots, const VisiblePoint& at) const {
        const CacheOptions options;
        const RecordMaker maker(rays_, spots, options);
        Records r;
        for (std::uint64_t i = 0; i < kRecords; ++i) {
            const HemisphereEstimate light = maker.light(at, 400, i);
            r.irradiance.add(light.irradiance.x);
            r.slope += static_cast<double>(light.translation[0].x) / kRecords;
        }
        return r;
    }

    std::unique_ptr<Scene> scene_ = room_with_a_bright_card();
    GatherRays rays_{*scene_, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 24};
    Rng rng_{1, StreamPurpose::test, 0};
    VisiblePoint from_;
    HotSpots spots_{rays_, 1 << 16, 1, {}};
};

bool lies_in_one(const Vec3& place, const HotSpots& spots) {
    for (int i = 0; i < static_cast<int>(spots.size()); ++i)
        if (spots.contains(i, place)) return true;
    return false;
}

TEST_F(SpotRecords, FindWhatIsBrightAndSmall) {
    EXPECT_GE(spots_.size(), 1u);
    EXPECT_TRUE(lies_in_one({3.55f, 3.55f, 0.2f}, spots_));
    EXPECT_FALSE(lies_in_one({0.5f, 0.5f, 0}, spots_));
    EXPECT_FALSE(lies_in_one(Vec3(std::numeric_limits<float>::infinity()), spots_));
}

TEST_F(SpotRecords, HaveTheSameMeanAndLessVariance) {
    const Records aimed = make(spots_, from_), blind = make({}, from_);
    const double error = std::hypot(aimed.irradiance.standard_error(), blind.irradiance.standard_error());
    EXPECT_TRUE(test::same_mean(aimed.irradiance, blind.irradiance));
    EXPECT_LT(error, 0.05 * blind.irradiance.mean()) << "too noisy to mean anything";
    EXPECT_LT(aimed.irradiance.variance(), blind.irradiance.variance() / 10);
}

TEST_F(SpotRecords, HaveTheSlopeThatTheirNeighboursShow) {
    VisiblePoint left = from_, right = from_;
    left.vertex.point.p.x -= 0.4f;
    right.vertex.point.p.x += 0.4f;
    const Records a = make(spots_, left), b = make(spots_, right), middle = make(spots_, from_);
    const double difference = (b.irradiance.mean() - a.irradiance.mean()) / 0.8;
    EXPECT_NEAR(middle.slope, difference, 0.25 * std::abs(difference));
}

/// The irradiance of a cone of radiance 1, about twice as large as the one that is aimed at, by both techniques.
TEST_F(SpotRecords, MixedRaysHaveTheDensityOfBothTechniques) {
    const Vec3 p = from_.vertex.point.p, n = from_.vertex.point.ng;
    const auto cones = spots_.cones_from(p, n);
    ASSERT_GE(cones.size(), 1u);
    const Vec3 axis = cones.front().axis;
    const double sine2 = 2 * (1 - cones.front().cos_half_angle * cones.front().cos_half_angle);
    for (const double besides : {0.0, 10 * cones.front().irradiance}) {
        const SpotMixture mixture(spots_, p, n, besides);
        EXPECT_GT(mixture.aimed(), 0.02);
        EXPECT_LE(mixture.aimed(), 0.5);
        RunningStats sum;
        for (int i = 0; i < 200'000; ++i) {
            const bool aims = rng_.next() < mixture.aimed();
            const double u0 = rng_.next(), u1 = rng_.next();
            const Vec3 w = aims ? mixture.sample(rng_) : Frame(n).to_world(cosine_hemisphere(u0, u1));
            const double cosine = std::max(0.0f, w.dot(n));
            const bool inside = static_cast<double>(w.dot(axis)) > std::sqrt(1 - sine2);
            sum.add(inside ? cosine / mixture.density(w, cosine * kInvPi) : 0.0);
        }
        EXPECT_TRUE(test::has_mean(sum, kPi * sine2 * static_cast<double>(axis.dot(n))));
        EXPECT_LT(sum.standard_error(), 0.05 * sum.mean()) << "too noisy to mean anything";
    }
}

/// Rays that end on the floor of the room from nearer than the estimate there looks.
TEST_F(SpotRecords, RaysThatAreTracedOnBringTheSameWithLessVariance) {
    const SurfacePatches patches(*scene_);
    PhotonSet photons;
    const photon_test::Rectangle floor{{1, 0, 1}, {0, 0, 2}, {2, 0, 0}};
    photon_test::throw_photons(floor, 20'000, rng_, photons.main_photons, Rgb(1e-6));
    photon_test::throw_photons(floor, 2'000, rng_, photons.pilots, Rgb(1e-6));
    const MappedGather gather(*scene_, patches, photons, {.max_radius = 0.1f, .caustic_radius = 0.1f});
    const auto found = [&](const HotSpots* spots) {
        RunningStats sum;
        for (int i = 0; i < 400'000; ++i)
            sum.add(luminance(gather.along({2, 0.004f, 2}, {0, -1, 0}, rng_, nullptr, spots).indirect));
        return sum;
    };
    const RunningStats aimed = found(&spots_), blind = found(nullptr);
    EXPECT_TRUE(test::same_mean(aimed, blind));
    EXPECT_LT(blind.standard_error(), 0.1 * blind.mean()) << "too noisy to mean anything";
    EXPECT_LT(aimed.variance(), blind.variance() / 10);
}

// A small globe around a lamp, in a long room: few rays meet it, and find it ten times as bright here as there.
TEST(HotSpots, AreFoundByAFewRaysOfUnlikeBrightness) {
    const Vec3 lamp(1.5f, 2.4f, 6), globe = lamp - Vec3(0, 0.05f, 0);
    const auto half = constant_texture(Rgb(0.5));
    test::SceneMaker m;
    const auto scene = m.room({0, 0, 0}, {3, 3, 9}, make_diffuse(Rgb(0.6)))
                           .rectangle(lamp, {0.02f, 0, 0}, {0, 0, 0.02f}, make_diffuse(Rgb(0.0)), Rgb(2000.0))
                           .sphere(globe, 0.1f, make_diffuse_transmission(half, half))
                           .camera({1.5f, 1.5f, 0.3f}, {1.5f, 1.2f, 9}, 70)
                           .window(64, 64)
                           .build();
    const GatherRays rays(*scene, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 24);
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed)
        if (lies_in_one(globe - Vec3(0.1f, 0, 0), HotSpots(rays, 1 << 14, seed, {}))) ++found;
    EXPECT_GE(found, 8);
}

TEST(HotSpots, AreNoneWhereLightIsEven) {
    const auto scene = test::furnace(0.5);
    const GatherRays rays(*scene, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 24);
    EXPECT_EQ(HotSpots(rays, 1 << 16, 1, {}).size(), 0u);
}

} // namespace
} // namespace keyhole
