// Energy: photons of chains and of light paths in one map, weighed by the balance heuristic, bring the power of plain
// light tracing to every wall, whatever the shares of work.
#include "photon_energy.h"

#include "photonmap/emission.h"
#include "photonmap/photon_sampling.h"
#include "photonmap/power.h"
#include "sampling/proposals/registry.h"
#include "support/test_scenes.h"
#include "support/user_paths.h"

namespace keyhole {
namespace {

using namespace energy_test;

constexpr std::array kShares{0.0, 0.2, 0.5, 0.8, 1.0}; // of the work, for chains
using EnergyByShare = std::array<Energy, kShares.size()>;

/// A scene, what is stored of its light, and how light paths are made.
struct Case {
    const Scene& scene;
    Rule rule;
    UserPaths user_paths{};
};

/// What all shares of a run have in common.
struct Start {
    PathSet set;
    ChainSeeds seeds;
    ImportanceMap at_d1, at_d2;
    ImportanceGuide guide_d1, guide_d2;
    LightGuides user_paths;

    Start(const Case& c, const SurfacePatches& patches, std::uint64_t seed, Importons&& importons)
        : set{.coverage = c.rule.coverage}, at_d1(importance_map(std::move(importons.first), patches)),
          at_d2(importance_map(std::move(importons.second), patches)),
          guide_d1(at_d1.map(), 0.5f, patches, &c.scene, {}), guide_d2(at_d2.map(), 0.5f, patches, &c.scene, {}),
          user_paths(c.scene, c.user_paths) {
        const GuidedPaths guides(c.scene, c.user_paths, set, c.rule.depth);
        const StageOneSettings first{.set = set,
                                     .max_scatterings = c.rule.depth,
                                     .samples = 10'000,
                                     .seed = seed,
                                     .guides = c.user_paths.empty() ? nullptr : &guides};
        seeds = choose_chain_seeds(c.scene, first, run_stage_one(c.scene, first, {}), 1000);
    }

    EmissionGuide guide() const { return {&guide_d2, &guide_d1}; }
};

/// Photons of one share of a run, thinned to a ceiling below what arrives.
Photons combine(const Case& c, const Start& start, double share, std::uint64_t seed) {
    const int depth = c.rule.depth;
    const auto steps = static_cast<std::int64_t>(share * 15'000);
    const auto paths = static_cast<std::int64_t>((1 - share) * 10'000);
    const Mixture<Path> mixture = make_mixture({&c.scene, start.set, depth, &c.user_paths}, Settings{});
    const TechniqueWeights weights(start.guide(), {&start.user_paths, nullptr},
                                   static_cast<double>(steps) / (static_cast<double>(paths) * start.seeds.brightness));
    MapStores stores({5'000, 2'500}, unit_of_power(c.scene), {}, seed);
    double scale = 1;
    if (steps > 0) {
        const PhotonChains chains = run_photon_chains(
            start.seeds, mixture,
            {.global = &start.at_d2,
             .caustic = &start.at_d1,
             .rule = PowerRule::reciprocal,
             .scene = &c.scene,
             .set = start.set,
             .max_scatterings = depth,
             .weights = &weights},
            {.mutations = steps, .global_photons = 5'000, .caustic_photons = 2'500, .seed = seed}, stores, {});
        scale = paths > 0 ? emission_scale(paths) : 1;
        stores.settle(chains.global_scale, chains.caustic_scale, scale);
    }
    if (paths > 0)
        scale = emit_photons(c.scene, start.guide(),
                             {.paths = paths,
                              .photons = 7'500,
                              .rule = c.rule.storage(),
                              .seed = seed,
                              .user_paths = start.user_paths,
                              .weights = &weights},
                             stores, {})
                    .scale();
    return stores.release(scale, scale);
}

void expect_energy(const Case& c) {
    const Energy traced = by_light_tracing(c.scene, c.rule, 200'000);
    const SurfacePatches patches(c.scene);
    EnergyByShare both;
    for (std::uint64_t seed = 100; seed < 112; ++seed) {
        const Start start(
            c, patches, seed,
            trace_importance(c.scene, {.samples = 10'000, .max_scatterings = c.rule.depth, .seed = seed}, {}));
        for (std::size_t i = 0; i < kShares.size(); ++i) add_run(c.scene, combine(c, start, kShares[i], seed), both[i]);
    }
    for (std::size_t i = 0; i < kShares.size(); ++i) {
        SCOPED_TRACE(kShares[i]);
        expect_equal(both[i].global, traced.global, "global", 0, {0, 1, 2, 3, 4, 5, 6});
        if (c.rule.coverage != nullptr) expect_equal(both[i].seen, traced.seen, "caustic", 0, {0, 1, 2, 3, 4, 5, 6});
    }
}

TEST(CombinedPhotons_EqualLightTracing, DiffuseBox) { expect_energy({*test::diffuse_box(), {8}}); }
TEST(CombinedPhotons_EqualLightTracing, TwoRooms) { expect_energy({*test::two_rooms(0.5f), {8}}); }
TEST(CombinedPhotons_EqualLightTracing, MirrorGlassBox) { expect_energy({*test::mirror_glass_box(), {40}}); }
TEST(CombinedPhotons_EqualLightTracing, CoatedBox) { expect_energy({*test::coated_box(), {8}}); }
TEST(CombinedPhotons_EqualLightTracing, PointLightBox) { expect_energy({*test::point_light_box(), {8}}); }
TEST(CombinedPhotons_EqualLightTracing, HazyBox) { expect_energy({*test::hazy_box(), {40}}); }

TEST(CombinedPhotons_EqualLightTracing, OutsideGatherCoverage) {
    const auto scene = test::two_rooms(0.5f);
    const GatherCoverage coverage(*scene, 8);
    expect_energy({*scene, {8, &coverage}});
}

TEST(CombinedPhotons_EqualLightTracing, AlongUserPaths) {
    const auto scene = test::diffuse_box();
    expect_energy({*scene, {8}, bind_user_paths(*scene, test::diffuse_box_paths(*scene))});
}

} // namespace
} // namespace keyhole
