// The power of photons by wall and by map, for tests that compare samplers with light tracing.
#pragma once

#include "core/statistics.h"
#include "photonmap/importance/importance_map.h"
#include "photonmap/importance/importance_tracing.h"
#include "photonmap/photon_weighing.h"
#include "photonmap/photons.h"
#include "sampling/paths/light_tracer.h"
#include "support/chance.h"

#include <gtest/gtest.h>

#include <array>

namespace keyhole::energy_test {

constexpr std::size_t kRegions = 8; // six walls, the balls, the rest

/// The wall that a point lies on, by position alone, so that photons can be sorted too.
inline std::size_t region(const Scene& scene, const Vec3& p) {
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
    Power seen;   ///< the part of `caustic` that the eye sees directly: chains store no other but through mirrors
    Power marked; ///< the part of `global` that came by specular vertices alone; all of it counts as of region 0
};

/// Whether the eye sees `p` with nothing in between.
inline bool in_view(const Scene& scene, const Vec3& p) {
    Rng rng(1, StreamPurpose::test, 0);
    const Vertex eye = sample_eye(scene, rng);
    SurfacePoint at;
    at.site = Site::point; // a little above the surface
    at.p = p + (eye.point.p - p) * 1e-3f;
    return scene.camera().image_point(eye.point, direction(eye.point, at)) && scene.visible(at, eye.point);
}

/// What is stored, by the rule in words: see by_light_tracing().
struct Rule {
    int depth;
    const GatherCoverage* coverage = nullptr;
    const ImageWeight* weight =
        nullptr;   ///< of pixels, which changes how photons are shared out and not what they carry
    int runs = 16; ///< of chains: more where their power has a long tail

    bool reached(const Vec3& p, const Vec3& n) const { return coverage == nullptr || coverage->comes_to(p, n); }
    StorageRule storage() const { return {.max_scatterings = depth, .coverage = coverage}; }
};

/// Light tracing. The global map of whole-path chains holds every sub-path that can be the one up to d2, which here is
/// every arrival within reach after which at least one scattering is still allowed. The caustic map holds what
/// arrives from outside gather coverage besides caustics.
inline Energy by_light_tracing(const Scene& scene, const Rule& rule, std::int64_t paths) {
    struct Sink {
        const Scene& scene;
        const Rule& rule;
        std::array<double, kRegions> global{}, caustic{}, seen{}, marked{};
        int arrivals = 0;
        bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
            const int depth = rule.depth;
            const std::size_t r = region(scene, v.point.p);
            // Black surfaces scatter nothing on: no path stores there.
            if (!v.bsdf.traits().finite || is_black(v.bsdf.eval(v.point.ns, v.point.ns))) return ++arrivals < depth;
            const bool straight = arrivals == 0; // direct light, which no map holds
            const bool here = rule.reached(v.point.p, facing(v.point.ng, to_light));
            if (!straight && arrivals < depth - 1 && here) {
                global[r] += luminance(power);
                if (past.specular && !past.last) marked[0] += luminance(power);
            }
            if ((past.specular && !past.last) || (past.last && !rule.reached(past.last->p, past.last->n))) {
                caustic[r] += luminance(power);
                if (in_view(scene, v.point.p)) seen[r] += luminance(power);
            }
            return ++arrivals < depth;
        }
    };
    Energy e;
    for (std::int64_t i = 0; i < paths; ++i) {
        Rng rng(3, StreamPurpose::test, static_cast<std::uint64_t>(i));
        Sink sink{scene, rule};
        trace_light_path(scene, rule.depth, rng, sink);
        for (std::size_t r = 0; r < kRegions; ++r) {
            e.global[r].add(sink.global[r]);
            e.caustic[r].add(sink.caustic[r]);
            e.seen[r].add(sink.seen[r]);
            e.marked[r].add(sink.marked[r]);
        }
    }
    return e;
}

inline ImportanceMap importance_map(std::vector<Photon>&& importons, const SurfacePatches& patches) {
    return {std::move(importons), {.k = 50, .max_radius = 0.5f, .patches = &patches}};
}

inline ImportanceGuide guide(const Scene& scene, std::vector<Photon>&& importons, const SurfacePatches& patches,
                             float radius) {
    return {PhotonMap(std::move(importons)), radius, patches, &scene, {}};
}

inline void add_run(const Scene& scene, const Photons& photons, Energy& e) {
    std::array<double, kRegions> global{}, caustic{}, seen{}, marked{};
    for (const Photon& p : photons.global.main_photons) {
        const double power = luminance(p.power());
        global[region(scene, p.position())] += power;
        if (p.caustic()) marked[0] += power;
    }
    for (const Photon& p : photons.caustic.main_photons) {
        const double power = luminance(p.power());
        caustic[region(scene, p.position())] += power;
        if (in_view(scene, p.position())) seen[region(scene, p.position())] += power;
    }
    for (std::size_t r = 0; r < kRegions; ++r) {
        e.global[r].add(global[r]);
        e.caustic[r].add(caustic[r]);
        e.seen[r].add(seen[r]);
        e.marked[r].add(marked[r]);
    }
}

/// What a run's importons say.
struct Guides {
    ImportanceGuide at_d1, at_d2;
    EmissionGuide both() const { return {&at_d2, &at_d1}; }
};

inline Guides make_guides(const Scene& scene, const Rule& rule, std::uint64_t seed, const SurfacePatches& patches,
                          float radius = 0.5f) {
    Importons importons = trace_importance(
        scene, {.samples = 8'000, .max_scatterings = rule.depth, .seed = seed, .weight = rule.weight}, {});
    return {guide(scene, std::move(importons.first), patches, radius),
            guide(scene, std::move(importons.second), patches, radius)};
}

/// The same up to chance, and beyond that within what density estimation of importance may be off.
inline void expect_equal(const Power& chains, const Power& traced, const char* map, double tolerance,
                         std::initializer_list<std::size_t> regions) {
    const double most = test::most_errors(static_cast<int>(regions.size()), static_cast<double>(chains[0].count()));
    int told = 0, untold = 0;
    for (const std::size_t r : regions) {
        const double a = chains[r].mean(), b = traced[r].mean();
        if (!(b > 20 * traced[r].standard_error())) continue; // too little light to say
        const double error = std::hypot(chains[r].standard_error(), traced[r].standard_error());
        EXPECT_NEAR(a, b, most * error + tolerance * b)
            << map << " map, region " << r << ", ratio " << a / b << " +- " << error / b;
        ++(error < 0.2 * b ? told : untold);
    }
    EXPECT_GE(told, 2 * untold) << "the test says next to nothing of the " << map << " map";
}

} // namespace keyhole::energy_test
