// Meshes whose files have normals for flat things as well, as exporters write them: rounded, and turned with the thing.
#include "sampling/paths/clear_glass.h"
#include "sampling/paths/path_tracer.h"
#include "scene/bsdfs/fresnel.h"
#include "scene/emitters/emitters.h"
#include "scene/geometry.h"
#include "scene/load/load_mesh.h"
#include "support/mesh_copies.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace keyhole {
namespace {

constexpr double kIndex = 1.5, kAlbedo = 0.7, kIrradiance = 5;
const Vec3 kSunlight = Vec3(0.1f, -1, -0.2f).normalized();

/// How a file may write a normal.
struct Writing {
    const char* name;
    std::function<Vec3(const Imath::V3d& normal, Rng& rng)> write;
};

Vec3 rounded(const Imath::V3d& n, double unit) {
    return Vec3(Imath::V3d(std::round(n.x / unit), std::round(n.y / unit), std::round(n.z / unit)) * unit);
}

Vec3 off(const Imath::V3d& n, double by, Rng& rng) {
    const auto [x, y, z] = rng.take<3>();
    return Vec3(n + Imath::V3d(2 * x - 1, 2 * y - 1, 2 * z - 1) * by);
}

std::vector<Writing> writings() {
    return {{"float", [](const auto& n, Rng&) { return Vec3(n); }},
            {"off by 1e-7", [](const auto& n, Rng& rng) { return off(n, 1e-7, rng); }},
            {"off by 1e-6", [](const auto& n, Rng& rng) { return off(n, 1e-6, rng); }},
            {"off by 1e-5", [](const auto& n, Rng& rng) { return off(n, 1e-5, rng); }},
            {"four digits", [](const auto& n, Rng&) { return rounded(n, 1e-4); }},
            {"digits of means", [](const auto& n, Rng& rng) { return rounded(Imath::V3d(off(n, 1e-6, rng)), 1e-4); }},
            {"8 bits", [](const auto& n, Rng&) { return rounded(n, 1.0 / 127); }},
            {"inwards", [](const auto& n, Rng&) { return Vec3(-n); }},
            {"long", [](const auto& n, Rng&) { return Vec3(n * 1.7); }}};
}

/// A slab of glass 4 mm thick and 2 m wide, 1 m above the floor, turned about z. Its six faces have corners of their
/// own.
TriangleMesh slab(double tilt, const Writing& writing) {
    Rng rng(1, StreamPurpose::test, 0);
    const auto turned = [a = tilt * kPi / 180](const Imath::V3d& v) {
        return Imath::V3d(std::cos(a) * v.x - std::sin(a) * v.y, std::sin(a) * v.x + std::cos(a) * v.y, v.z);
    };
    TriangleMesh mesh = make_box({-1, 0, -1}, {1, 1, 1});
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        Imath::V3d normal(0.0), p(mesh.positions[i]);
        normal[static_cast<int>(i / 8)] = i % 8 < 4 ? 1 : -1;
        mesh.normals.push_back(writing.write(turned(normal), rng));
        p.y *= 0.004;
        mesh.positions[i] = Vec3(turned(p) + Imath::V3d(0, 1, 0));
    }
    return mesh;
}

/// Share of the sun that comes through it.
double transmittance(double tilt) {
    const double a = tilt * kPi / 180, cosine = Imath::V3d(kSunlight).dot({std::sin(a), -std::cos(a), 0});
    const double passed = 1 - fresnel_dielectric(std::abs(cosine), kIndex).reflectance;
    return passed * passed;
}

constexpr std::array kTilts{0, 1, 2, 3, 5, 7, 10, 12, 15, 18, 20, 24, 26, 28, 30, 33, 36, 40, 50, 60};

/// The two as one mesh, the second one 3 m aside.
TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : other.positions) mesh.positions.push_back(p + Vec3(3, 1, 3));
    mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
    mesh.uvs.clear();
    for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
    return mesh;
}

std::unique_ptr<Scene> floor_below(Geometry glass) {
    test::SceneMaker m;
    m.shape({.geometry = std::move(glass), .material = make_glass(kIndex), .emission = nullptr});
    m.rectangle({-0.5f, 0, 0.5f}, {1, 0, 0}, {0, 0, -1}, make_diffuse(Rgb(kAlbedo)));
    m.emitter(make_distant_emitter(kSunlight, Rgb(kIrradiance), 0));
    m.camera({0, 0.05f, 0.01f}, {0, 0, 0}, 100).window(8, 8);
    return m.build();
}

/// Whether the sun comes through in full, wherever it meets the triangles, from some places of the floor.
void expect_clear(const Scene& scene, double transmittance) {
    Rng rng(2, StreamPurpose::test, 0);
    SurfacePoint from;
    from.site = Site::point;
    for (int i = 0; i < 50; ++i) {
        const auto [x, z] = rng.take<2>();
        from.p = {float(0.2 * x - 0.1), 0, float(0.2 * z - 0.1)};
        const double through = straight_transmittance(scene, from, infinite_point(-kSunlight)).x;
        ASSERT_NEAR(through, transmittance, 1e-4) << i;
    }
}

TEST(ClearGlassWithNormals, LetsTheSunThroughHoweverItIsTilted) {
    const TriangleMesh ball = test::dented_ball(8, 6);
    for (const Writing& writing : writings())
        for (const double tilt : kTilts) {
            SCOPED_TRACE(testing::Message() << writing.name << ", " << tilt << " degrees");
            expect_clear(*floor_below(slab(tilt, writing)), transmittance(tilt));
            expect_clear(*floor_below(joined(slab(tilt, writing), ball)), transmittance(tilt));
        }
}

/// Adds up what paths bring.
struct Light {
    using LooksThroughGlass = std::true_type;
    double sum = 0;
    static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(const EyeWalk& /*walk*/, const Vertex& /*x0*/, const Rgb& value, LightClass /*light*/) {
        sum += luminance(value);
    }
};

TEST(ClearGlassWithNormals, LightsTheFloorBelowHoweverItIsTilted) {
    const Writing writing = writings().front();
    for (const double tilt : kTilts) {
        const auto scene = floor_below(slab(tilt, writing));
        Light light;
        constexpr int kPaths = 200, kDepth = 3; // by the floor and two faces: of light that is reflected up again, none
        for (int i = 0; i < kPaths; ++i) {
            Rng rng(3, StreamPurpose::test, static_cast<std::uint64_t>(i));
            const auto [x, y] = rng.take<2>();
            trace_path(*scene, {static_cast<float>(x), static_cast<float>(y)}, kDepth, rng, light);
        }
        const double expected = kAlbedo / kPi * kIrradiance * -kSunlight.y * transmittance(tilt);
        EXPECT_NEAR(light.sum / kPaths, expected, 0.001 * expected) << tilt;
    }
}

TEST(ClearGlassWithNormals, LetsTheSunThroughCopies) {
    const Imath::M44d askew = Imath::M44d().setEulerAngles(Imath::V3d(0, 0, 0.5));
    TriangleMesh mesh = joined(slab(0, writings()[3]), test::dented_ball(8, 6));
    transform_mesh(mesh, askew);
    const SharedMesh shared(std::move(mesh));
    for (const Imath::V3d& scale : {Imath::V3d(1, 1, 1), Imath::V3d(-1, 1, 1), Imath::V3d(2, 1, -3)}) {
        SCOPED_TRACE(scale);
        const Geometry copy =
            shared.placed(std::make_shared<const ObjectToWorld>(askew.inverse() * Imath::M44d().setScale(scale)));
        ASSERT_TRUE(std::holds_alternative<MeshInstance>(copy));
        expect_clear(*floor_below(copy), transmittance(0));
        expect_clear(*floor_below(flattened(std::get<MeshInstance>(copy))), transmittance(0));
    }
}

TEST(FlatTriangles, AreToldFromOthersOfTheirMeshInEveryCopy) {
    constexpr std::uint32_t kFlat = 12; // of the slab
    for (const Writing& writing : writings()) {
        SCOPED_TRACE(writing.name);
        const SharedMesh shared(joined(slab(28, writing), test::dented_ball(30, 20)));
        const std::vector<bool>& flat = shared.mesh().flat;
        ASSERT_EQ(flat.size(), shared.mesh().triangles.size());
        for (std::uint64_t seed = 0; seed < 4; ++seed) {
            const auto place = std::make_shared<const ObjectToWorld>(test::random_transform(seed, seed % 2 == 1));
            const Shape copy{.geometry = shared.placed(place), .material = nullptr, .emission = nullptr};
            for (std::uint32_t t = 0; t < flat.size(); ++t) {
                const SurfacePoint p = triangle_point(copy, t, 0.2f, 0.5f);
                EXPECT_EQ(flat[t], t < kFlat) << t;
                EXPECT_EQ(p.ns == p.ng, t < kFlat) << t;
            }
        }
    }
}

/// Part of a sphere of radius 1, of facets so wide.
TriangleMesh patch(double width) {
    constexpr std::uint32_t kSide = 5;
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= kSide; ++j)
        for (std::uint32_t i = 0; i <= kSide; ++i) {
            mesh.normals.emplace_back(Imath::V3d(i * width, 0.3 + j * width, 1).normalized());
            mesh.positions.push_back(mesh.normals.back());
        }
    append_grid(mesh, 0, kSide, kSide);
    return mesh;
}

TEST(FlatTriangles, AreNoneOfACurvedSurfaceHoweverFine) {
    for (const double width : {1e-2, 1e-3, 5e-4}) {
        TriangleMesh mesh = patch(width);
        mark_flat_triangles(mesh);
        EXPECT_EQ(mesh.normals.size(), mesh.positions.size()) << width;
        EXPECT_TRUE(mesh.flat.empty()) << width;
        EXPECT_FALSE(is_flat_in_part(mesh)) << width;
    }
}

/// Where rounding of positions turns a face by a thousandth.
TEST(FlatTriangles, MayBeThinAndFarAway) {
    TriangleMesh strip = make_parallelogram({0, 0, 0}, {0, 1, 0}, {1e-3f, 0, 0});
    strip.normals.assign(strip.positions.size(), {0, 0, -1});
    transform_mesh(strip, Imath::M44d().setEulerAngles(Imath::V3d(0.3, 0.5, 0.7)) *
                              Imath::M44d().setTranslation(Imath::V3d(11, 12, 13)));
    EXPECT_GT((triangle_point(strip, 0, 0.3f, 0.3f).ng - strip.normals[0]).length(), 1e-4f);
    mark_flat_triangles(strip);
    EXPECT_TRUE(strip.normals.empty());
}

/// Normals that say something else than the positions are someone's will.
TEST(FlatTriangles, DontHaveNormalsThatLeanOrBend) {
    for (const bool bend : {false, true}) {
        TriangleMesh mesh = make_parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        const float by = bend ? 1e-3f : 2e-2f;
        for (const Vec3& p : mesh.positions)
            mesh.normals.push_back(Vec3(bend && p.x > 0 ? -by : by, 0, 1).normalized());
        mark_flat_triangles(mesh);
        EXPECT_EQ(mesh.normals.size(), 4u) << bend;
        EXPECT_TRUE(mesh.flat.empty()) << bend;
    }
}

} // namespace
} // namespace keyhole
