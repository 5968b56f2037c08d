// Energy: the power that chains leave in the maps, by wall and by map, is that of plain light tracing.
#include "core/parallel.h"
#include "core/statistics.h"
#include "photonmap/photon_sampling.h"
#include "sampling/light_tracer.h"
#include "sampling/proposals/registry.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <array>

namespace keyhole {
namespace {

constexpr int kMaxDepth = 8;
constexpr std::size_t kRegions = 8; // six walls, the balls, the rest

/// The wall that a point lies on, by position alone, so that photons can be sorted too.
std::size_t region(const Scene& scene, const Vec3& p) {
    constexpr float tolerance = 1e-3f;
    for (int k = 0; k < 3; ++k) {
        if (std::abs(p[k] - scene.lower()[k]) < tolerance) return static_cast<std::size_t>(2 * k);
        if (std::abs(p[k] - scene.upper()[k]) < tolerance) return static_cast<std::size_t>(2 * k + 1);
    }
    return p.y < 0.9f ? 6 : 7;
}

using Power = std::array<RunningStats, kRegions>;
struct Energy {
    Power global, caustic;
};

/// Light tracing. The global map of whole-path chains holds every sub-path that can be the one up to d2, which here is
/// every arrival after which at least one scattering is still allowed.
Energy by_light_tracing(const Scene& scene, std::int64_t paths) {
    struct Sink {
        const Scene& scene;
        std::array<double, kRegions> global{}, caustic{};
        int arrivals = 0;
        bool arrival(const Vertex& v, const Vec3&, const Rgb& power, bool specular_only) {
            const std::size_t r = region(scene, v.point.p);
            // Black surfaces scatter nothing on: no path stores there.
            if (!v.bsdf.traits().finite || is_black(v.bsdf.eval(v.point.ns, v.point.ns))) return ++arrivals < kMaxDepth;
            const bool straight = arrivals == 0; // direct light, which no map holds
            if (!straight && arrivals < kMaxDepth - 1) global[r] += luminance(power);
            if (specular_only) caustic[r] += luminance(power);
            return ++arrivals < kMaxDepth;
        }
    };
    Energy e;
    for (std::int64_t i = 0; i < paths; ++i) {
        Rng rng(3, StreamPurpose::test, static_cast<std::uint64_t>(i));
        Sink sink{scene};
        trace_light_path(scene, kMaxDepth, rng, sink);
        for (std::size_t r = 0; r < kRegions; ++r) {
            e.global[r].add(sink.global[r]);
            e.caustic[r].add(sink.caustic[r]);
        }
    }
    return e;
}

ImportanceMap importance_map(const std::vector<Importon>& importons, std::int64_t samples,
                             const SurfacePatches& patches) {
    std::vector<Photon> compact;
    for (const Importon& i : importons)
        compact.emplace_back(i.position, i.ng, i.to_eye, i.weight / static_cast<double>(samples));
    return {std::move(compact), {.k = 50, .max_radius = 0.5f, .patches = &patches}};
}

/// Several independent runs of stages one and two.
Energy by_chains(const Scene& scene, int runs) {
    const SurfacePatches patches(scene.shapes());
    Energy e;
    for (int run = 0; run < runs; ++run) {
        const auto seed = static_cast<std::uint64_t>(100 + run);
        const StageOneSettings first{.max_scatterings = kMaxDepth, .samples = 100'000, .seed = seed};
        const StageOne one = run_stage_one(scene, first, {});
        const Importance importance = trace_importance(scene, kMaxDepth, 200'000, seed, {});
        const ImportanceMap at_d1 = importance_map(importance.first, importance.samples, patches);
        const ImportanceMap at_d2 = importance_map(importance.second, importance.samples, patches);
        const Mixture<Path> mixture = make_mixture({&scene, PathSet::stored, kMaxDepth}, Settings{});
        const SampledPhotons photons = sample_photons(choose_seeds(scene, first, one, 2000), mixture, {&at_d2, &at_d1},
                                                      {.mutations = 100'000,
                                                       .global_photons = 100'000,
                                                       .caustic_photons = 50'000,
                                                       .brightness = one.brightness.mean(),
                                                       .seed = seed},
                                                      {});
        EXPECT_LT(photons.lost_share, 1e-3);
        std::array<double, kRegions> global{}, caustic{};
        for (const Photon& p : photons.global) global[region(scene, p.position())] += luminance(p.power());
        for (const Photon& p : photons.caustic) caustic[region(scene, p.position())] += luminance(p.power());
        for (std::size_t r = 0; r < kRegions; ++r) {
            e.global[r].add(global[r]);
            e.caustic[r].add(caustic[r]);
        }
    }
    return e;
}

/// Within 4 standard errors, and beyond that within what density estimation of importance may be off.
void expect_equal(const Power& chains, const Power& traced, const char* map, double tolerance,
                  std::initializer_list<std::size_t> regions) {
    for (const std::size_t r : regions) {
        const double a = chains[r].mean(), b = traced[r].mean();
        if (!(b > 20 * traced[r].standard_error())) continue; // too little light to say
        const double error = std::hypot(chains[r].standard_error(), traced[r].standard_error());
        EXPECT_NEAR(a, b, 4 * error + tolerance * b)
            << map << " map, region " << r << ", ratio " << a / b << " +- " << error / b;
        EXPECT_LT(error, 0.1 * b) << "the test says nothing";
    }
}

void expect_energy(const Scene& scene, bool caustics) {
    const Energy traced = by_light_tracing(scene, 400'000);
    const Energy chains = by_chains(scene, 8);
    expect_equal(chains.global, traced.global, "global", 0.05, {0, 1, 2, 3, 4, 5, 6});
    // Caustics are stored where the eye sees them: the back wall is in view as a whole.
    if (caustics) expect_equal(chains.caustic, traced.caustic, "caustic", 0.08, {4});
}

TEST(PhotonEnergy_EqualsLightTracing, DiffuseBox) { expect_energy(*test::diffuse_box(), false); }
TEST(PhotonEnergy_EqualsLightTracing, TwoRooms) { expect_energy(*test::two_rooms(0.5f), false); }
TEST(PhotonEnergy_EqualsLightTracing, MirrorGlassBox) { expect_energy(*test::mirror_glass_box(), true); }
TEST(PhotonEnergy_EqualsLightTracing, PointLight) { expect_energy(*test::point_light_box(), true); }

} // namespace
} // namespace keyhole
