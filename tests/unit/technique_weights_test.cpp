// The density of light sub-paths under light tracing, and the weights that follow from it: path by path as light was
// traced, and by histogram against sub-paths drawn evenly over the surfaces.
#include "photonmap/photon_weighing.h"

#include "core/statistics.h"
#include "photonmap/importance/importance_tracing.h"
#include "sampling/guidance/guided_light.h"
#include "sampling/paths/measure.h"
#include "scene/emitters/emitters.h"
#include "support/test_scenes.h"
#include "support/user_paths.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

#include <array>

namespace keyhole {
namespace {

constexpr int kDepth = 8;

/// Keeps a light path as it was traced.
struct Record {
    Path path;
    std::vector<Rgb> power;         ///< that arrived, by vertex; none at x0
    const Vertex* before = nullptr; ///< still in its place, its event known by now

    bool arrival(const Vertex& v, const Vec3& /*to_light*/, const Rgb& arrived, const LightPast& /*past*/) {
        if (before != nullptr) path.x.back().event = before->event;
        path.x.push_back(v);
        path.x.back().event = Event::finite;
        power.push_back(arrived);
        before = &v;
        return true;
    }
};

/// Vertices where the power replayed isn't that which arrived.
int count_other_power(const Scene& scene, const LightPathSampling& sampling, const Record& record) {
    int other = 0;
    for (std::size_t k = 1; k < record.path.x.size(); ++k) {
        const auto power = light_path_power(scene, sampling, record.path, static_cast<int>(k));
        const double carried = luminance(record.power[k - 1]);
        if (!power || !(std::abs(luminance(*power) - carried) < 2e-3 * carried)) ++other;
    }
    return other;
}

/// Replays light paths from an emitter chosen by power, or learned.
void expect_replay(const Scene& scene, const LearnedEmission* learned = nullptr) {
    const LightPathSampling sampling{nullptr, learned};
    int vertices = 0, other = 0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        Rng rng(3, StreamPurpose::test, i);
        const auto light = learned != nullptr ? learned->sample(rng) : emit_light(scene, rng);
        if (!light || is_black(light->power)) continue;
        Record record;
        record.path.x.push_back(make_vertex(light->x0));
        trace_light_path(scene, *light, kDepth, rng, record);
        other += count_other_power(scene, sampling, record);
        vertices += static_cast<int>(record.power.size());
    }
    EXPECT_GT(vertices, 1000);
    EXPECT_LT(other, 1e-3 * vertices); // directions between vertices that nearly touch are rounded
}

TEST(LightPathPower, IsWhatLightTracingCarries) {
    expect_replay(*test::diffuse_box());
    expect_replay(*test::mirror_glass_box());
    expect_replay(*test::point_light_box());
    expect_replay(*test::hazy_box());
    expect_replay(*test::coated_box());
    expect_replay(*test::sky_box());
    expect_replay(*test::distant_light_scene());
    expect_replay(*test::spot_scene());
}

TEST(LightPathPower, CountsLearnedEmission) {
    auto m = test::room_with_a_window();
    m.rectangle({-4, -0.2f, -8}, {0, 0, 7.9f}, {10, 0, 0}, make_diffuse(Rgb(0.6)));
    m.emitter(make_constant_environment(Rgb(1, 2, 3)));
    m.emitter(make_distant_emitter(Vec3(0.2f, -0.6f, 0.7f).normalized(), Rgb(8)));
    m.camera({1.5f, 1.3f, 2.9f}, {1.5f, 1.2f, 0}, 60).window(32, 24);
    const auto scene = m.build();
    const LearnedEmission learned(*scene,
                                  look_for_light(*scene, {.paths = 20'000, .max_scatterings = kDepth}, {}).ends);
    expect_replay(*scene, &learned);
}

constexpr std::size_t kWalls = 6;
/// By the walls of the vertices that light comes from and goes to.
using Cells = std::array<RunningStats, kWalls * kWalls>;

/// The wall of diffuse_box() that a point lies on; none on what stands in it.
std::optional<std::size_t> wall(const Scene& scene, const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
        if (std::abs(p[k] - scene.lower()[k]) < 1e-3f) return static_cast<std::size_t>(2 * k);
        if (std::abs(p[k] - scene.upper()[k]) < 1e-3f) return static_cast<std::size_t>(2 * k + 1);
    }
    return std::nullopt;
}

/// How often tracing makes a sub-path of three vertices, by the walls of the last two.
template <class Trace> Cells trace_counts(const Scene& scene, std::int64_t paths, const Trace& trace) {
    struct Sink {
        const Scene& scene;
        std::optional<std::size_t> cell;
        bool arrival(const Vertex& v, const Vec3& /*to_light*/, const Rgb& /*power*/, const LightPast& past) {
            const auto here = wall(scene, v.point.p);
            if (past.scatterings == 1 && here && past.last)
                if (const auto before = wall(scene, past.last->p)) cell = *before * kWalls + *here;
            return past.scatterings < 1;
        }
    };
    Cells cells;
    for (std::int64_t i = 0; i < paths; ++i) {
        Rng rng(5, StreamPurpose::test, static_cast<std::uint64_t>(i));
        Sink sink{scene, {}};
        trace(rng, sink);
        for (std::size_t c = 0; c < cells.size(); ++c) cells[c].add(sink.cell == c ? 1.0 : 0.0);
    }
    return cells;
}

/// A vertex evenly over the walls, and their area.
std::optional<Vertex> draw_on_walls(const Scene& scene, Rng& rng, double& area) {
    const Vec3 size = scene.upper() - scene.lower();
    const std::array<double, 3> sides{double(size.y) * size.z, double(size.x) * size.z, double(size.x) * size.y};
    area = 2 * (sides[0] + sides[1] + sides[2]);
    double left = rng.next() * area;
    int axis = 0;
    while (axis < 2 && left >= 2 * sides[static_cast<std::size_t>(axis)])
        left -= 2 * sides[static_cast<std::size_t>(axis++)];
    const bool upper = left >= sides[static_cast<std::size_t>(axis)];
    SurfacePoint from;
    from.site = Site::point;
    for (int k = 0; k < 3; ++k) from.p[k] = scene.lower()[k] + static_cast<float>(rng.next()) * size[k];
    from.p[axis] = upper ? scene.upper()[axis] - 1e-3f : scene.lower()[axis] + 1e-3f;
    Vec3 w(0, 0, 0);
    w[axis] = upper ? 1.0f : -1.0f;
    const auto v = next_vertex(scene, from, w);
    return v && wall(scene, v->point.p) ? v : std::nullopt;
}

/// The integral of the density over the same cells.
Cells density_of_cells(const Scene& scene, const LightPathSampling& sampling, std::int64_t samples) {
    Cells cells;
    for (std::int64_t i = 0; i < samples; ++i) {
        Rng rng(6, StreamPurpose::test, static_cast<std::uint64_t>(i));
        const auto x0 = sample_emitter(scene, rng);
        double area = 0, density = 0;
        const auto x1 = draw_on_walls(scene, rng, area), x2 = draw_on_walls(scene, rng, area);
        std::size_t cell = 0;
        if (x0 && x1 && x2 && scene.visible(x0->vertex.point, x1->point) && scene.visible(x1->point, x2->point)) {
            cell = *wall(scene, x1->point.p) * kWalls + *wall(scene, x2->point.p);
            Path path;
            for (const Vertex& v : {x0->vertex, *x1, *x2}) path.x.push_back(v);
            const Vec3 w0 = direction(x0->vertex.point, x1->point), w1 = direction(x1->point, x2->point);
            const Rgb flux = scene.emitter(x0->vertex.point.emitter).radiance(x0->vertex.point, w0) *
                             geometry_term(x0->vertex.point, x1->point) *
                             scatter(x1->point, x1->bsdf, Event::finite, -w0, w1).value *
                             geometry_term(x1->point, x2->point);
            if (const auto power = light_path_power(scene, sampling, path, 2))
                density = luminance(flux) / luminance(*power) / (x0->pdf / (area * area));
        }
        for (std::size_t c = 0; c < cells.size(); ++c) cells[c].add(c == cell ? density : 0.0);
    }
    return cells;
}

void expect_equal(const Cells& traced, const Cells& expected) {
    int told = 0;
    for (std::size_t c = 0; c < traced.size(); ++c) {
        const double error = std::hypot(traced[c].standard_error(), expected[c].standard_error());
        if (c / kWalls == c % kWalls) continue; // edges
        EXPECT_NEAR(traced[c].mean(), expected[c].mean(), 4.5 * error)
            << "from wall " << c / kWalls << " to wall " << c % kWalls;
        if (traced[c].mean() > 20 * error) ++told;
    }
    EXPECT_GE(told, 12);
}

TEST(LightPathDensity, IsThatWithWhichTracingMakesSubPaths) {
    const auto scene = test::diffuse_box();
    const LightPathSampling plain;
    expect_equal(
        trace_counts(*scene, 400'000, [&](Rng& rng, auto& sink) { trace_light_path(*scene, kDepth, rng, sink); }),
        density_of_cells(*scene, plain, 1'000'000));
}

TEST(LightPathDensity, SumsFreeWalksAndWalksAlongUserPaths) {
    const auto scene = test::diffuse_box();
    const UserPaths paths = bind_user_paths(
        *scene, {{test::user_path("floor, wall", {{0, 1.95f, 0}, {0.2f, 0, 0.4f}, {0.2f, 1.625f, 3}}, 0.9),
                  test::user_path("floor", {{0, 1.95f, 0}, {0.2f, 0, 0.4f}}, 0.7)}});
    const LightGuides guides(*scene, paths);
    const LearnedEmission learned(*scene, look_for_light(*scene, {.paths = 4096, .max_scatterings = kDepth}, {}).ends);
    for (const LightPathSampling& sampling : {LightPathSampling{&guides}, LightPathSampling{&guides, &learned}}) {
        SCOPED_TRACE(sampling.learned != nullptr ? "learned" : "by power");
        expect_equal(
            trace_counts(*scene, 400'000,
                         [&](Rng& rng, auto& sink) { trace_guided_light_path(*scene, sampling, kDepth, rng, sink); }),
            density_of_cells(*scene, sampling, 500'000));
    }
}

/// What chains get of a photon and what light tracing gets of it are computed apart: the one from a path's vertices,
/// the other from the power that arrived.
TEST(TechniqueWeights, AddUpToOne) {
    const auto scene = test::mirror_glass_box();
    const SurfacePatches patches(*scene);
    Importons importons = trace_importance(*scene, {.samples = 20'000, .max_scatterings = kDepth, .seed = 1}, {});
    const ImportanceGuide at_d1(PhotonMap(std::move(importons.first)), 0.5f, patches, scene.get(), {});
    const ImportanceGuide at_d2(PhotonMap(std::move(importons.second)), 0.5f, patches, scene.get(), {});
    const EmissionGuide guide{&at_d2, &at_d1};
    const TechniqueWeights weights(guide, {}, 20);
    const PhotonWeighing weighing{guide};
    RunningStats of_chains;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Rng rng(3, StreamPurpose::test, i);
        const auto light = emit_light(*scene, rng);
        if (!light) continue;
        Record record;
        record.path.x.push_back(make_vertex(light->x0));
        trace_light_path(*scene, *light, kDepth, rng, record);
        for (std::size_t k = 1; k < record.path.x.size(); ++k) {
            const Vertex& v = record.path.x[k];
            if (!v.bsdf.traits().finite) continue;
            for (const PhotonKind kind : {PhotonKind::global, PhotonKind::caustic}) {
                const Vec3 to_light = direction(v.point, record.path.x[k - 1].point);
                const double traced = weights.of_light_path(weighing(kind, v, to_light, record.power[k - 1]));
                const double chain = weights.of_chains(weights.visible(*scene, kind, record.path, static_cast<int>(k)));
                EXPECT_NEAR(traced + chain, 1, 1e-3);
                of_chains.add(chain);
            }
        }
    }
    EXPECT_GT(of_chains.mean(), 0.1);
    EXPECT_LT(of_chains.mean(), 0.9);
}

} // namespace
} // namespace keyhole
