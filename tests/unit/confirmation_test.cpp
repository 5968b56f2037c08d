// Spots of light that chains make, and scouts don't confirm.
#include "photonmap/confirmation.h"

#include "gather/final_gather.h"
#include "photon_support.h"
#include "render/photon_report.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>

namespace keyhole {
namespace {

using namespace photon_test;

const SurfaceRegion kRegion{Vec3(0.5f, 0.5f, 0), Vec3(0, 0, 1)};
constexpr float kRadius = 0.4f;
const Rectangle kSpot{{0.3f, 0.3f, 0}, {0.02f, 0, 0}, {0, 0.02f, 0}};

/// Spread evenly over the unit square, three carriers for a scout.
PhotonSet even(Rng& rng) {
    PhotonSet set;
    throw_photons(kUnitSquare, 40, rng, set.scouts);
    throw_photons(kUnitSquare, 120, rng, set.carriers);
    return set;
}

double share(PhotonSet set) {
    return unconfirmed_share(ScoutedMap(std::move(set)), kRegion, kRadius,
                             [](const Photon& p) { return luminance(p.power()); });
}

TEST(UnconfirmedShare, IsZeroWhereLightIsSpread) {
    for (std::uint64_t i = 0; i < 100; ++i) {
        Rng rng = make_rng(i);
        EXPECT_EQ(share(even(rng)), 0);
    }
}

TEST(UnconfirmedShare, FindsOnePhotonAmongMany) {
    Rng rng = make_rng(1);
    PhotonSet set = even(rng);
    throw_photons(kSpot, 1, rng, set.carriers, Rgb(200.0));
    EXPECT_GT(share(set), 0.6);
}

TEST(UnconfirmedShare, FindsTheManyOfOneChain) {
    Rng rng = make_rng(2);
    PhotonSet set = even(rng);
    throw_photons(kSpot, 200, rng, set.carriers);
    EXPECT_GT(share(set), 0.6);
}

TEST(UnconfirmedShare, IsZeroForACausticThatScoutsFindToo) {
    Rng rng = make_rng(3);
    PhotonSet set = even(rng);
    throw_photons(kSpot, 200, rng, set.carriers);
    throw_photons(kSpot, 67, rng, set.scouts);
    EXPECT_EQ(share(set), 0);
}

/// Warnings on a picture of the diffuse box, with caustics over its floor; `spots` places have all of them.
std::vector<std::string> warnings(int spots, std::int64_t passes) {
    const auto scene = test::diffuse_box();
    const Rectangle floor{{-1, 0, 3}, {2, 0, 0}, {0, 0, -4}};
    Rng rng = make_rng(4);
    PhotonSet set;
    throw_photons(floor, 20'000, rng, set.scouts);
    if (spots == 0) throw_photons(floor, 60'000, rng, set.carriers, Rgb(1e-3));
    for (int i = 0; i < spots; ++i) throw_photons(floor, 1, rng, set.carriers, Rgb(60.0 / spots));
    const ScoutedMap map(std::move(set));
    const SurfacePatches patches(scene->shapes());
    const GatherRays rays(*scene, {.caustic = &map, .patches = &patches}, {.max_radius = 0.1f, .caustic_radius = 0.1f},
                          24);
    const FinalGather gather(rays, nullptr, {.light = 4, .rays = 1});
    RenderStats stats;
    stats.photons_caustic = map.carriers().photons().size();
    report_false_spots(gather, 1, stats);
    warn_of_photons(stats, passes);
    return stats.warnings;
}

TEST(FalseSpots, AreWarnedOf) {
    EXPECT_THAT(warnings(0, 1), testing::IsEmpty());
    EXPECT_THAT(warnings(60, 1), testing::ElementsAre(testing::HasSubstr("bright discs that are not there")));
    EXPECT_THAT(warnings(60, 1000), testing::IsEmpty()) << "what is in one picture of so many doesn't show";
}

} // namespace
} // namespace keyhole
