// Connections of sub-paths against the paths that they stand for, measured vertex by vertex.
#include "sampling/paths/bidirectional_tracer.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <functional>

namespace keyhole {
namespace {

/// Density of making `path` with k vertices from the light, written down as it is defined.
double technique_density(const Path& path, int k) {
    const auto at = [&](int i) -> const Vertex& { return path.x[static_cast<std::size_t>(i)]; };
    if (k > 0 && !joinable(at(k - 1), at(k))) return 0;
    double density = 1;
    for (int i = 0; i < path.vertices(); ++i) density *= i < k ? at(i).pdf_from_light : at(i).pdf_from_eye;
    return density;
}

double expected_weight(const Path& path, int s, MisHeuristic heuristic) {
    const double own = technique_density(path, s);
    double sum = 0, best = 0;
    for (int k = 0; k < path.vertices(); ++k) {
        const double ratio = technique_density(path, k) / own;
        sum += heuristic == MisHeuristic::power ? ratio * ratio : ratio;
        if (k != s) best = std::max(best, ratio);
    }
    if (heuristic == MisHeuristic::maximum) return best < 1 ? 1 : 0;
    return 1 / sum;
}

/// Connections that were compared, and those that differ by more than single precision can explain: directions at
/// connections follow from positions.
struct Tally {
    int connections = 0, wrong = 0, wrong_class = 0, wrong_ratios = 0, undecided = 0;
};

/// Whether a medium scatters so near to the next vertex that floats don't know the direction between the two to a
/// thousandth.
bool scatters_at_next_to_no_distance(const Path& path) {
    for (std::size_t i = 1; i < path.x.size(); ++i) {
        const SurfacePoint &a = path.x[i - 1].point, &b = path.x[i].point;
        if ((a.site == Site::medium || b.site == Site::medium) && (a.p - b.p).length() < 0.03f) return true;
    }
    return false;
}

void compare(const Connection& as_made, const TracedSubPath& eye, Tally& tally) {
    const Path path = as_made.path();
    if (light_class(path) != as_made.light_class()) ++tally.wrong_class;
    const double own = technique_density(path, as_made.s());
    if (!(own > 0) || eye.vertices.empty() || scatters_at_next_to_no_distance(path)) return;
    for (const auto heuristic : {MisHeuristic::balance, MisHeuristic::power, MisHeuristic::maximum}) {
        Connection connection = as_made;
        const double value = luminance(connection.value(heuristic)), free = luminance(path.contribution) / own;
        const double expected = free * expected_weight(path, connection.s(), heuristic);
        for (int k = 0; k < path.vertices(); ++k) {
            const double ratio = technique_density(path, k) / own, told = connection.density_ratio(k);
            if (value > 0 && std::abs(told - ratio) > 1e-3 * std::max(told, ratio)) ++tally.wrong_ratios;
        }
        const bool borderline = heuristic == MisHeuristic::maximum && (value > 0) != (expected > 0);
        ++tally.connections;
        if (borderline) ++tally.undecided;
        if (!borderline && std::abs(value - expected) > 1e-3 * std::max(value, expected) + 1e-9) ++tally.wrong;
    }
}

using MakeScene = std::function<std::unique_ptr<Scene>()>;

TEST(Connection, CarriesWhatItsPathMeasures) {
    for (const MakeScene& make : {MakeScene(test::diffuse_box), MakeScene([] { return test::mirror_glass_box(0.05f); }),
                                  MakeScene(test::point_light_box), MakeScene(test::hazy_box), MakeScene(test::sky_box),
                                  MakeScene(test::spot_scene), MakeScene([] { return test::foggy_box(true); })}) {
        const auto scene = make();
        Tally tally;
        for (std::uint64_t i = 0; i < 600; ++i) {
            Rng rng(1, StreamPurpose::test, i);
            const Vec2 image(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
            auto& [eye, light] = SubPathPair::scratch();
            trace_eye_subpath(*scene, image, 7, rng, nullptr, eye);
            trace_light_subpath(*scene, 6, rng, nullptr, light);
            for (int t = 1; t <= eye.size(); ++t)
                for (int s = t == 1 ? 1 : 0; s <= light.size(); ++s) {
                    const Connection connection(*scene, light, s, eye, t, image);
                    if (connection.possible() && connection.visible()) compare(connection, eye, tally);
                }
        }
        EXPECT_GT(tally.connections, 1000);
        EXPECT_EQ(tally.wrong_class, 0);
        EXPECT_LE(tally.wrong, tally.connections / 500);
        EXPECT_LE(tally.wrong_ratios, tally.connections / 250);
        EXPECT_LE(tally.undecided, tally.connections / 500);
    }
}

} // namespace
} // namespace keyhole
