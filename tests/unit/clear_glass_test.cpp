// Clear glass: what light goes straight through, and that every path is direct light if and only if one looks through.
#include "core/statistics.h"
#include "sampling/paths/clear_glass.h"
#include "sampling/paths/independent_paths.h"
#include "sampling/paths/light_tracer.h"
#include "sampling/paths/path_tracer.h"
#include "scene/emitters/emitters.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::MaterialPtr;
using test::SceneMaker;

constexpr double kIndex = 1.5;

/// A box of flat glass.
void add_slab(SceneMaker& m, const Vec3& low, const Vec3& high, const MaterialPtr& glass) {
    const Vec3 d = high - low;
    const Vec3 x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    m.rectangle(low, y, x, glass).rectangle(low, z, y, glass).rectangle(low, x, z, glass);
    m.rectangle(high, -x, -y, glass).rectangle(high, -y, -z, glass).rectangle(high, -z, -x, glass);
}

SurfacePoint point_at(const Vec3& p) {
    SurfacePoint s;
    s.p = p;
    s.site = Site::point;
    return s;
}

/// The Fresnel reflectance of glass for light that comes from air.
double reflectance(double cosine) { return fresnel_dielectric(cosine, kIndex).reflectance; }

SceneMaker under_a_sky() {
    SceneMaker m;
    m.emitter(make_constant_environment(Rgb(1.0))).camera({0, 0, 5}, {0, 0, 0}, 40).window(8, 8);
    return m;
}

const Vec3 kSlanted = Vec3(0.3f, 0.2f, -1).normalized();

TEST(ClearGlass, OfASlabLetsThroughWhatItsFacesDontReflect) {
    SceneMaker m = under_a_sky();
    add_slab(m, {-5, -5, -0.1f}, {5, 5, 0}, make_glass(kIndex));
    const auto scene = m.build();
    const double expected = std::pow(1 - reflectance(-kSlanted.z), 2);
    const SurfacePoint from = point_at({0, 0, 1});
    EXPECT_NEAR(straight_transmittance(*scene, from, infinite_point(kSlanted)).x, expected, 1e-5);
    EXPECT_EQ(straight_transmittance(*scene, from, infinite_point(kSlanted), 1), Rgb(0.0)) << "two faces";
    const auto view = look_straight(*scene, from, kSlanted);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->end.point.site, Site::infinite);
    EXPECT_NEAR(view->transmittance.x, expected, 1e-5);
    // What is near is seen elsewhere than where it is.
    EXPECT_EQ(straight_transmittance(*scene, from, point_at({0, 0, -3})), Rgb(0.0));
}

/// Files have normals for flat things as well.
TEST(ClearGlass, IsFlatWhateverItsFileSaysOfNormalsUnlessTheyBend) {
    for (const float bend : {0.0f, 1e-5f, 0.1f}) {
        SceneDescription d;
        Shape& slab = d.shapes.emplace_back();
        TriangleMesh mesh;
        for (const float z : {0.0f, -0.1f}) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const Vec3& p : {Vec3(-5, -5, z), Vec3(5, -5, z), Vec3(5, 5, z), Vec3(-5, 5, z)})
                mesh.positions.push_back(p);
            for (const float x : {-bend, bend, bend, -bend})
                mesh.normals.push_back(Vec3(x, 0, z < 0 ? -1 : 1).normalized());
            if (z < 0)
                mesh.triangles.insert(mesh.triangles.end(),
                                      {{first, first + 2, first + 1}, {first, first + 3, first + 2}});
            else
                mesh.triangles.insert(mesh.triangles.end(),
                                      {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
        }
        slab.geometry = mesh;
        slab.material = make_glass(kIndex);
        d.emitters.push_back(make_constant_environment(Rgb(1.0)));
        const Scene scene(std::move(d));
        const double through = straight_transmittance(scene, point_at({0.3f, 0, 1}), infinite_point(kSlanted)).x;
        EXPECT_NEAR(through, bend < 0.01f ? std::pow(1 - reflectance(-kSlanted.z), 2) : 0.0, 1e-5) << bend;
    }
}

TEST(ClearGlass, OfAPaneLetsThroughWhatItDoesntReflect) {
    SceneMaker m = under_a_sky();
    m.rectangle({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, make_thin_dielectric(kIndex));
    m.sphere({0, 0, 3}, 1, make_thin_dielectric(kIndex)); // a bubble
    const auto scene = m.build();
    const double r = reflectance(-kSlanted.z), expected = 1 - 2 * r / (1 + r);
    const SurfacePoint from = point_at({0, 0, 1});
    EXPECT_NEAR(straight_transmittance(*scene, from, infinite_point(kSlanted)).x, expected, 1e-5);
    const SurfacePoint near = point_at(from.p + kSlanted * 3.0f);
    EXPECT_NEAR(straight_transmittance(*scene, from, near).x, expected, 1e-5);
    EXPECT_EQ(straight_transmittance(*scene, from, near, 0), Rgb(0.0));
    const double normal = reflectance(1), twice = std::pow(1 - 2 * normal / (1 + normal), 2);
    EXPECT_NEAR(straight_transmittance(*scene, from, point_at({0, 0, 5})).x, twice, 1e-5);
}

TEST(ClearGlass, IsNothingThatTurnsLightOrStopsIt) {
    for (const int kind : {0, 1, 2, 3, 4}) {
        SceneMaker m = under_a_sky();
        if (kind == 0) m.sphere({0, 0, 0}, 0.9f, make_glass(kIndex));
        if (kind == 1) m.rectangle({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, make_glass(kIndex)); // it is never left
        if (kind == 2)                                                                       // a wedge
            m.rectangle({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, make_glass(kIndex))
                .rectangle({-5, -5, -0.5f}, {0, 10, 0}, {10, 0, -0.5f}, make_glass(kIndex));
        if (kind == 3)
            m.rectangle({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, make_thin_dielectric(kIndex))
                .rectangle({-5, -5, -1}, {10, 0, 0}, {0, 10, 0}, make_diffuse(Rgb(0.5)));
        if (kind == 4) // a view ends where something shines
            m.rectangle({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, make_thin_dielectric(kIndex), Rgb(1.0));
        const auto scene = m.build();
        EXPECT_EQ(straight_transmittance(*scene, point_at({0, 0, 1}), infinite_point(kSlanted)), Rgb(0.0)) << kind;
    }
}

/// A room with a slab, a pane, a ball and a wedge of glass in the light of a sky, a sun and lamps on either side.
std::unique_ptr<Scene> room_of_glass() {
    SceneMaker m = test::room_with_a_window();
    const MaterialPtr glass = make_glass(kIndex);
    const MaterialPtr pane = make_thin_dielectric(kIndex, constant_texture(Rgb(0.9, 0.3, 0.1)));
    m.emitter(make_constant_environment(Rgb(1.0)));
    m.emitter(make_distant_emitter(Vec3(0.1f, -0.6f, 1).normalized(), Rgb(3.0), 10));
    m.rectangle({1, 2.4f, -1.5f}, {1, 0, 0}, {0, 0, 0.5f}, make_diffuse(Rgb(0.0)), Rgb(30.0));
    m.rectangle({0.5f, 2.45f, 1}, {0.3f, 0, 0}, {0, 0, 0.3f}, make_diffuse(Rgb(0.0)), Rgb(10.0));
    add_slab(m, {1, 1, -0.05f}, {1.4f, 1.8f, -0.02f}, glass);
    m.rectangle({1.4f, 1, -0.03f}, {0.4f, 0, 0}, {0, 0.8f, 0}, pane);
    m.sphere({0.6f, 0.5f, 1.2f}, 0.3f, glass);
    m.rectangle({1.8f, 0.4f, 0.8f}, {0.6f, 0, 0}, {0, 0, 0.6f}, glass);
    m.rectangle({1.8f, 0.5f, 0.8f}, {0, 0, 0.6f}, {0.6f, 0.2f, 0}, glass);
    m.camera({1.5f, 1.3f, 2.9f}, {1.5f, 0.9f, 0}, 70).window(32, 24);
    return m.build();
}

TEST(ClearGlass, IsLookedThroughWherePathsAreDirectLightAndNowhereElse) {
    struct Sink {
        const Scene& scene;
        int straight = 0, bent = 0, wrong = 0;

        static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
        void contribution(const EyeWalk& walk, const Vertex& x0, const Rgb& /*value*/, LightClass light) {
            std::size_t i = walk.size() - 1; // the vertex next to the light
            if (!walk[i].specular()) return;
            bool reflected = false; // perhaps to and fro in a slab: such light comes as if straight, too, but isn't
            for (; i > 0 && walk[i].specular(); --i) reflected = reflected || walk[i].event == Event::reflect;
            if (i == 0) return;                       // seen directly
            if (i != walk.d1 && i != walk.d2) return; // what lies behind doesn't matter to the class
            const bool direct = light == LightClass::direct || light == LightClass::second;
            const Vec3 w = direction(walk[i].point, walk[i + 1].point);
            // Of an emitter at infinity: the direction in which one would look. Mirrors show others beside where they
            // are.
            const bool infinite = x0.point.site == Site::infinite;
            const SurfacePoint end = infinite ? infinite_point(w) : x0.point;
            const bool beside = !infinite && (w - direction(walk[i].point, end)).length() > 1e-3f;
            const bool through = !beside && !reflected && !is_black(straight_transmittance(scene, walk[i].point, end));
            ++(direct ? straight : bent);
            wrong += direct != through ? 1 : 0;
        }
    };
    const auto scene = room_of_glass();
    Sink sink{*scene};
    for (int i = 0; i < 200'000; ++i) {
        Rng rng(1, StreamPurpose::test, static_cast<std::uint64_t>(i));
        trace_path(*scene, {static_cast<float>(rng.next()), static_cast<float>(rng.next())}, 8, rng, sink);
    }
    EXPECT_GT(sink.straight, 1000);
    EXPECT_GT(sink.bent, 200);
    EXPECT_EQ(sink.wrong, 0);
}

TEST(ClearGlass, LeavesLightThatComesThroughItDirectForTracersFromEitherEnd) {
    // Light that comes from a light's end knows the same of itself as the whole path: arrivals by where they lit first.
    struct Sink {
        int straight = 0, wrong = 0;
        Path path;
        bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& /*power*/, const LightPast& past) {
            if (v.bsdf.traits().finite && past.scatterings > 0 && !past.last) {
                const int lit = past.first_lit(to_light);
                straight += lit > 1 ? 1 : 0;
                wrong += lit != 1 && lit != past.scatterings + 1 ? 1 : 0;
            }
            return true;
        }
    };
    const auto scene = room_of_glass();
    Sink sink;
    for (int i = 0; i < 60'000; ++i) {
        Rng rng(2, StreamPurpose::test, static_cast<std::uint64_t>(i));
        trace_light_path(*scene, 8, rng, sink);
    }
    EXPECT_GT(sink.straight, 200);
    EXPECT_EQ(sink.wrong, 0);
}

/// Adds up what paths bring.
struct Blind {
    double sum = 0;
    static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(const EyeWalk& /*walk*/, const Vertex& /*x0*/, const Rgb& value, LightClass /*light*/) {
        sum += luminance(value);
    }
};
struct Seeing : Blind {
    using LooksThroughGlass = std::true_type;
};

/// A room behind a window that is clear in some of its places, and milk glass in the others.
std::unique_ptr<Scene> room_behind_milk_glass(double milk, std::unique_ptr<Emitter> light) {
    SceneMaker m = test::room_with_a_window();
    const auto milky = make_diffuse_transmission(constant_texture(Rgb(0.1)), constant_texture(Rgb(0.1)));
    m.rectangle({1, 1, -0.03f}, {1, 0, 0}, {0, 1, 0},
                make_mix(make_thin_dielectric(kIndex), milky, constant_texture(milk)));
    m.emitter(std::move(light)).camera({1.5f, 1.3f, 2.9f}, {1.5f, 0.9f, 0}, 70).window(32, 24);
    return m.build();
}

struct BothKinds {
    RunningStats blind{}, seeing{};
    double error() const { return std::hypot(blind.standard_error(), seeing.standard_error()); }
};
BothKinds trace_both(const Scene& scene, int depth, int paths) {
    BothKinds both;
    for (int i = 0; i < paths; ++i) {
        Rng a(3, StreamPurpose::test, static_cast<std::uint64_t>(i)),
            b(4, StreamPurpose::test, static_cast<std::uint64_t>(i));
        const auto place = [](Rng& rng) {
            return Vec2(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
        };
        Blind first;
        trace_path(scene, place(a), depth, a, first);
        both.blind.add(first.sum);
        Seeing second;
        trace_path(scene, place(b), depth, b, second);
        both.seeing.add(second.sum);
    }
    return both;
}

/// Both kinds of sinks find the same light, and with a limit on scatterings, too: faces count.
TEST(ClearGlass, BringsTheSameLightWhetherEmittersAreSampledThroughItOrNot) {
    const auto scene = room_of_glass();
    for (const int depth : {2, 3, 8}) {
        const BothKinds both = trace_both(*scene, depth, 100'000);
        EXPECT_NEAR(both.seeing.mean(), both.blind.mean(), 4 * both.error()) << depth;
        EXPECT_LT(both.error(), 0.1 * both.blind.mean()) << depth;
        EXPECT_LT(both.seeing.variance(), 0.8 * both.blind.variance()) << depth;
    }
}

/// A wide sun that comes from above, so that the camera doesn't see it and all light is that of the floor: found by
/// shadow rays and by others. At such angles a pane keeps a seventh of it back, which is more than 4 errors.
TEST(ClearGlass, TakesItsShareOfALightOnce) {
    const auto scene = room_behind_milk_glass(0, make_distant_emitter(Vec3(0.1f, -2, 1).normalized(), Rgb(3.0), 100));
    const BothKinds both = trace_both(*scene, 2, 1'000'000);
    EXPECT_NEAR(both.seeing.mean(), both.blind.mean(), 4 * both.error());
    EXPECT_LT(4 * both.error(), 0.09 * both.blind.mean());
}

/// Adds up what whole paths bring, and asks whether they bring anything as they are.
struct WholePaths {
    const Scene& scene;
    RunningStats light;
    double sum = 0;
    int through = 0, wrong = 0;

    void trace(Technique technique, std::uint64_t stream) {
        Rng rng(stream, StreamPurpose::test, static_cast<std::uint64_t>(light.count()));
        const Vec2 image(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
        sum = 0;
        trace_independent(technique, scene, image, {6, PathSet::stored}, rng, *this);
        light.add(sum);
    }
    template <class MakePath> void contribution(const Rgb& value, PhotonKind /*kind*/, const MakePath& make_path) {
        sum += luminance(value);
        Path path = make_path();
        through += path.x[1].specular() ? 1 : 0;
        evaluate(scene, path, PathSet::stored);
        wrong += path.target > 0 ? 0 : 1;
    }
};

/// Most of what lights the room is that the sun comes through the clear places, which no ray from the eye would meet.
TEST(ClearGlass, IsOnThePathsThatLookThroughIt) {
    const auto scene =
        room_behind_milk_glass(0.9, make_distant_emitter(Vec3(0.1f, -0.6f, 1).normalized(), Rgb(3.0), 0.5));
    WholePaths path{*scene, {}}, bidirectional{*scene, {}};
    for (int i = 0; i < 60'000; ++i) {
        path.trace(Technique::path, 5);
        bidirectional.trace(Technique::bidirectional, 6);
    }
    EXPECT_GT(path.through, 100);
    EXPECT_EQ(path.wrong, 0);
    const double error = std::hypot(path.light.standard_error(), bidirectional.light.standard_error());
    EXPECT_NEAR(path.light.mean(), bidirectional.light.mean(), 4 * error);
    EXPECT_LT(error, 0.05 * bidirectional.light.mean());
}

} // namespace
} // namespace keyhole
