// Absorption, boundaries without a surface, and holes.
#include "sampling/paths/bidirectional_tracer.h"
#include "sampling/paths/clear_glass.h"
#include "sampling/paths/direct_light.h"
#include "sampling/paths/light_tracer.h"
#include "scene/emitters/emitters.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::SceneMaker;
using MediumPtr = std::shared_ptr<const Medium>;

MediumPtr medium(double absorption) { return std::make_shared<Medium>(Medium{Rgb(absorption, 2 * absorption, 0)}); }

SurfacePoint place(const Vec3& p) {
    SurfacePoint s;
    s.p = p;
    s.site = Site::point;
    return s;
}

void expect_transmittance(const Scene& scene, const SurfacePoint& a, const SurfacePoint& b, double depth) {
    for (const Rgb& t : {scene.transmittance(a, b), scene.transmittance(b, a)}) {
        EXPECT_NEAR(t.x, std::exp(-depth), 2e-6);
        EXPECT_NEAR(t.y, std::exp(-2 * depth), 2e-6);
        EXPECT_EQ(t.z, 1);
    }
}

SceneMaker wall_behind(float z) {
    SceneMaker m;
    m.rectangle({-9, -9, z}, {18, 0, 0}, {0, 18, 0}, make_diffuse(Rgb(0.5)));
    return m;
}

TEST(Medium_Transmittance, FollowsBeersLaw) {
    const Rgb t = Medium{Rgb(0.5, 0, 2)}.transmittance(3);
    EXPECT_NEAR(t.x, std::exp(-1.5), 1e-15);
    EXPECT_EQ(t.y, 1);
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ((Medium{Rgb(0.5, 0, 2)}.transmittance(inf)), Rgb(0, 1, 0));
}

TEST(Media_Edges, CountTheLengthInsideACloud) {
    SceneMaker m = wall_behind(-5);
    const auto scene = m.cloud({-1, -1, -1}, {1, 1, 1}, medium(0.3)).build();
    const SurfacePoint front = place({0, 0, 4}), inside = place({0, 0, 0.5f}), behind = place({0, 0, -3});
    expect_transmittance(*scene, front, behind, 0.6);
    expect_transmittance(*scene, front, inside, 0.15);
    expect_transmittance(*scene, inside, place({0.5f, 0, 0.5f}), 0.15);
    expect_transmittance(*scene, front, place({2, 0, 4}), 0);
    const SurfacePoint wall = scene->trace(front, {0, 0, -1}).value();
    EXPECT_NEAR(wall.p.z, -5, 1e-5) << "a cloud stops no ray";
    EXPECT_TRUE(scene->visible(front, behind));
    expect_transmittance(*scene, front, wall, 0.6);
    expect_transmittance(*scene, inside, infinite_point({1, 0, 0}), 0.3);
}

TEST(Media_Edges, StartAndEndOnGlass) {
    SceneMaker m = wall_behind(-5);
    const auto scene = m.sphere({0, 0, 0}, 1, make_glass(1.5)).media(medium(0.7), medium(0.1)).build();
    const SurfacePoint front = scene->trace(place({0, 0, 4}), {0, 0, -1}).value();
    const SurfacePoint back = scene->trace(front, {0, 0, -1}).value();
    EXPECT_NEAR(back.p.z, -1, 1e-5);
    expect_transmittance(*scene, front, back, 1.4);
    expect_transmittance(*scene, place({0, 0, 4}), front, 0.3);
    expect_transmittance(*scene, back, scene->trace(back, {0, 0, -1}).value(), 0.4);
}

TEST(Media_Edges, LieInTheOutermostMediumWhereNothingElseIs) {
    SceneDescription d;
    d.shapes.resize(1);
    d.shapes[0].geometry = Sphere{};
    d.medium = medium(0.2);
    const Scene scene(std::move(d));
    expect_transmittance(scene, place({0, 0, 4}), place({0, 3, 4}), 0.6);
}

// Embree now and then meets what lies the last bit before where its search began.
TEST(Media_Boundary, IsLeftBehindEvenWhereItIsMetBeforeTheSearchBegan) {
    for (const float nearest : {0.0f, 1e-30f, 1.0f, 12345.678f}) {
        const float before = std::nextafter(nearest, -1.0f), after = std::nextafter(nearest, 1e9f);
        EXPECT_GT(beyond_boundary(nearest, before, 0), nearest);
        EXPECT_GT(beyond_boundary(nearest, nearest, 0), nearest);
        EXPECT_GT(beyond_boundary(nearest, after, 0), after);
        EXPECT_GE(beyond_boundary(nearest, before, 0.25f), nearest + 0.25f);
    }
}

// Planes through the origin have no error of position that would carry the search away from them.
TEST(Media_Boundary, ManyInOnePlaneAreCrossedFromAnywhere) {
    SceneMaker m = wall_behind(-5);
    for (int i = 0; i < 8; ++i) {
        m.rectangle({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, make_interface());
        m.media(medium(0.1));
    }
    const auto scene = m.build();
    Rng rng(3, StreamPurpose::test, 0);
    const auto between = [&](double a, double b) { return static_cast<float>(a + (b - a) * rng.next()); };
    for (int i = 0; i < 20'000; ++i) {
        const SurfacePoint above = place({between(-4, 4), between(-4, 4), between(0.01, 3)});
        const SurfacePoint below = place({between(-4, 4), between(-4, 4), between(-3, -0.01)});
        const Rgb t = scene->transmittance(above, below), back = scene->transmittance(below, above);
        for (const double share : {t.x, back.x}) {
            EXPECT_GE(share, std::exp(-0.1 * 3.001 * 12));
            EXPECT_LE(share, 1);
        }
    }
}

TEST(Media_Interface, LetsDirectLightThroughWithWhatIsLeft) {
    SceneMaker m;
    m.rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, make_diffuse(Rgb(1.0)));
    m.cloud({-0.5f, 0.2f, -0.5f}, {0.5f, 0.7f, 0.5f}, medium(1));
    m.emitter(make_distant_emitter({0, -1, 0}, Rgb(1.0)));
    const auto scene = m.build();
    const Vertex v = next_vertex(*scene, place({0, 0.1f, 0}), Vec3(0, -1, 0)).value();
    Rng rng(1, StreamPurpose::test, 0);
    const auto light = sample_direct_light(*scene, v, Vec3(0, 1, 0), rng);
    ASSERT_TRUE(light.has_value());
    EXPECT_TRUE(scene->visible(v.point, light->x0.point));
    const Rgb clear = straight_transmittance(*scene, v.point, light->x0.point);
    EXPECT_NEAR((light->value * clear).x, std::exp(-0.5) / kPi, 1e-6);
}

std::unique_ptr<Scene> sheet_with_alpha(double alpha) {
    SceneDescription d;
    for (const float z : {0.0f, -1.0f}) {
        Shape& s = d.shapes.emplace_back();
        TriangleMesh mesh;
        mesh.positions = {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}};
        mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        s.geometry = mesh;
        s.material = make_diffuse(Rgb(0.5));
    }
    d.shapes[0].alpha = constant_texture(alpha);
    return std::make_unique<Scene>(std::move(d));
}

TEST(Alpha_Sheet, StopsItsShareOfRaysAndNoOthersThanItHides) {
    for (const double alpha : {0.0, 0.3, 1.0}) {
        const auto scene = sheet_with_alpha(alpha);
        Rng rng(2, StreamPurpose::test, 0);
        int stopped = 0, disagree = 0;
        constexpr int n = 20'000;
        for (int i = 0; i < n; ++i) {
            const auto x = static_cast<float>(1.8 * rng.next() - 0.9), y = static_cast<float>(1.8 * rng.next() - 0.9);
            const SurfacePoint from = place({x, y, 1});
            const SurfacePoint hit = scene->trace(from, {0, 0, -1}).value();
            stopped += hit.shape == 0 ? 1 : 0;
            SurfacePoint wall = hit;
            wall.p.z = -0.9f;
            wall.site = Site::point;
            disagree += scene->visible(from, wall) == (hit.shape == 0) ? 1 : 0;
        }
        EXPECT_NEAR(stopped / double{n}, alpha, 4 * std::sqrt(alpha * (1 - alpha) / n) + 1e-12);
        // A hit is placed anew by each ray, and now and then falls on the other side of the screen's lines.
        EXPECT_LE(disagree, alpha == 0 || alpha == 1 ? 0 : n / 200);
    }
}

// However it is looked for: next-event estimation asks for the way to infinity, light paths for that to where they
// enter.
TEST(Media_Outermost, LeavesNothingOfLightFromInfinity) {
    for (const bool sky : {false, true}) {
        SceneDescription d;
        d.shapes.resize(1);
        d.shapes[0].geometry = Sphere{};
        d.shapes[0].material = make_diffuse(Rgb(0.5));
        d.emitters.push_back(sky ? make_constant_environment(Rgb(1.0)) : make_distant_emitter({0, -1, 0}, Rgb(1.0)));
        d.medium = medium(0.2); // clear for blue
        const Scene scene(std::move(d));
        Rng rng(1, StreamPurpose::test, 0);
        struct {
            Rgb power{0.0};
            bool arrival(const Vertex&, const Vec3&, const Rgb& carried, const LightPast&) {
                power += carried;
                return false;
            }
        } sink;
        TracedSubPath walk;
        int arrived = 0;
        for (int i = 0; i < 1000; ++i) {
            trace_light_path(scene, 4, rng, sink);
            trace_light_subpath(scene, 4, rng, nullptr, walk);
            if (walk.size() < 2) continue;
            EXPECT_EQ(walk.notes[1].throughput.x, 0);
            EXPECT_GT(walk.notes[1].throughput.z, 0);
            ++arrived;
        }
        EXPECT_GT(arrived, 100);
        EXPECT_EQ(sink.power.x, 0);
        EXPECT_GT(sink.power.z, 0);
    }
}

} // namespace
} // namespace keyhole
