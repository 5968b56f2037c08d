// Spots of light that chains make, and pilot photons don't confirm.
#include "photonmap/confirmation.h"

#include "gather/final_gather.h"
#include "methods/photons/photon_report.h"
#include "photon_support.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>

namespace keyhole {
namespace {

using namespace photon_test;

const SurfaceRegion kRegion{Vec3(0.5f, 0.5f, 0), Vec3(0, 0, 1)};
constexpr float kRadius = 0.4f;
const Rectangle kSpot{{0.3f, 0.3f, 0}, {0.02f, 0, 0}, {0, 0.02f, 0}};

/// Spread evenly over the unit square, three main photons for a pilot photon.
PhotonSet even(Rng& rng) {
    PhotonSet set;
    throw_photons(kUnitSquare, 40, rng, set.pilots);
    throw_photons(kUnitSquare, 120, rng, set.main_photons);
    return set;
}

double share(PhotonSet set) {
    return unconfirmed_share(PilotedMap(std::move(set)), kRegion, kRadius,
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
    throw_photons(kSpot, 1, rng, set.main_photons, Rgb(200.0));
    EXPECT_GT(share(set), 0.6);
}

TEST(UnconfirmedShare, FindsTheManyOfOneChain) {
    Rng rng = make_rng(2);
    PhotonSet set = even(rng);
    throw_photons(kSpot, 200, rng, set.main_photons);
    EXPECT_GT(share(set), 0.6);
}

TEST(UnconfirmedShare, IsZeroForACausticThatPilotsFindToo) {
    Rng rng = make_rng(3);
    PhotonSet set = even(rng);
    throw_photons(kSpot, 200, rng, set.main_photons);
    throw_photons(kSpot, 67, rng, set.pilots);
    EXPECT_EQ(share(set), 0);
}

/// Warnings on a picture of the diffuse box, with caustics over its floor; `spots` places have all of them.
std::vector<std::string> warnings(int spots, std::int64_t passes) {
    const auto scene = test::diffuse_box();
    const Rectangle floor{{-1, 0, 3}, {2, 0, 0}, {0, 0, -4}};
    Rng rng = make_rng(4);
    PhotonSet set;
    throw_photons(floor, 20'000, rng, set.pilots);
    if (spots == 0) throw_photons(floor, 60'000, rng, set.main_photons, Rgb(1e-3));
    for (int i = 0; i < spots; ++i) throw_photons(floor, 1, rng, set.main_photons, Rgb(60.0 / spots));
    const PilotedMap map(std::move(set));
    const SurfacePatches patches(scene->shapes());
    const PilotSurroundings surroundings(map, patches, LookupOptions{}.nearest, 0.1f, 1);
    const GatherRays rays(*scene, {.caustic = &map, .caustic_surroundings = &surroundings, .patches = &patches},
                          {.max_radius = 0.1f, .caustic_radius = 0.1f}, 24);
    const FinalGather gather(rays, nullptr, nullptr, {.light = 4, .rays = 1});
    RenderStats stats;
    stats.photons_caustic = map.main_photons().photons().size();
    report_false_spots(gather, 1, stats);
    warn_of_photons(stats, passes, 24);
    return stats.warnings;
}

TEST(FalseSpots, AreWarnedOf) {
    EXPECT_THAT(warnings(0, 1), testing::IsEmpty());
    EXPECT_THAT(warnings(60, 1), testing::ElementsAre(testing::HasSubstr("bright discs that are not there")));
    EXPECT_THAT(warnings(60, 1000), testing::IsEmpty()) << "what is in one picture of so many doesn't show";
}

} // namespace
} // namespace keyhole
