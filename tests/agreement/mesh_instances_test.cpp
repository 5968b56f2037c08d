// Light in a room full of copies of meshes is what it is where each copy has a mesh of its own.
#include "methods/method.h"
#include "methods/render.h"
#include "scene/geometry.h"
#include "scene/textures/function_texture.h"
#include "support/agreement.h"
#include "support/mesh_copies.h"
#include "support/same_light.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// Copies of an object of three meshes: white, of glass, and full of holes.
/// @param columns of the first; it has as many triangles as their square
std::vector<Shape> copies_in_a_room(std::uint32_t columns) {
    const auto white = make_diffuse(Rgb(0.7)), red = make_diffuse(Rgb(0.7, 0.3, 0.2));
    const auto ball = [](const Imath::V3d& at, std::uint32_t around) {
        TriangleMesh mesh = test::dented_ball(around, around / 2);
        transform_mesh(mesh, test::moved({}, 0.5, at));
        return std::make_shared<const TriangleMesh>(std::move(mesh));
    };
    const std::array meshes{ball({0, 0, 0}, columns), ball({0.5, 0, 0}, columns * 3 / 4),
                            ball({0, 0.5, 0}, columns / 2)};
    const auto holes =
        function_texture<double>([](const SurfacePoint& p) { return std::fmod(8 * p.uv.x, 1.0f) < 0.5f ? 1.0 : 0.0; });
    std::vector<Shape> shapes;
    for (std::uint64_t i = 0; i < 12; ++i) {
        const auto place = std::make_shared<const ObjectToWorld>(
            test::moved(test::random_transform(i, i % 2 == 1), 0.8,
                        {0.6 * double(i % 4) - 0.9, 0.5 + 0.6 * double(i / 4), -0.6 + 0.3 * double(i % 3)}));
        shapes.push_back(test::instance_of(meshes[0], place, i % 2 == 0 ? white : red));
        shapes.push_back(test::instance_of(meshes[1], place, make_glass(1.5)));
        shapes.push_back(test::instance_of(meshes[2], place, red));
        shapes.back().alpha = holes;
    }
    return shapes;
}

constexpr std::uint32_t kColumns = 40;
/// For so many triangles that photon methods keep no tables of them.
constexpr std::uint32_t kManyColumns = 100;

std::unique_ptr<Scene> room(bool instances, std::uint32_t columns = kColumns) {
    test::SceneMaker m;
    m.room({-1.4f, 0, -1.5f}, {1.4f, 2.4f, 3}, make_diffuse(Rgb(0.6)));
    m.rectangle({-0.4f, 2.38f, 0.5f}, {0.8f, 0, 0}, {0, 0, 0.8f}, make_diffuse(Rgb(0.0)), Rgb(6.0));
    std::vector<Shape> copies = copies_in_a_room(columns);
    if (!instances) copies = test::without_instances(copies);
    for (Shape& s : copies) m.shape(std::move(s));
    m.camera({0, 1.2f, 2.9f}, {0, 1.1f, -1}, 50).window(48, 32);
    return m.build();
}

Settings base_settings() {
    Settings base;
    base.max_depth = 12;
    base.spp = 8;
    base.light_paths = 100'000;
    base.photons = 60'000;
    base.importons = 30'000;
    base.brightness_samples = 30'000;
    base.brightness_error = 0; // the mean of all runs' counts
    base.mutations = 300'000;
    base.chains = 200;
    base.cache_rays = 100;
    return base;
}

/// @param meshes of which bdpt draws the reference
void expect_light_of_meshes(Scene& copies, Scene& meshes, const std::vector<const char*>& methods) {
    const Settings base = base_settings();
    Settings reference = base;
    reference.method = &methods::bdpt;
    reference.spp = 20;
    reference.seed = 1000;
    const test::Blocks expected = test::render_blocks(meshes, reference, 8);
    for (Settings s : test::by_methods(base, methods)) {
        const bool photons = s.method->keeps_photons;
        if (!photons) s.spp = 20;
        const test::Disagreement d = test::compare(test::render_blocks(copies, s, photons ? 4 : 8), expected, 0.03);
        EXPECT_EQ(d.rejected, 0) << name_of(*s.method) << "\n" << d.report;
        EXPECT_NEAR(d.ratio, 1, std::max(0.03, 4 * d.ratio_error)) << name_of(*s.method);
        fmt::print("{}: ratio {:.4f} +- {:.4f}, worst {:.4f}\n", name_of(*s.method), d.ratio, d.ratio_error, d.worst);
    }
}

TEST(MeshInstances_Light, IsThatOfMeshesByEveryMethod) {
    expect_light_of_meshes(*room(true), *room(false), {"path", "bdpt", "ipm", "mps"});
}

TEST(MeshInstances_Light, IsThatOfMeshesWherePhotonsHaveNoTablesOfTriangles) {
    const auto copies = room(true, kManyColumns);
    EXPECT_GT(copies->triangle_count(), 150'000u);
    expect_light_of_meshes(*copies, *room(false, kManyColumns), {"ipm", "mps"});
}

/// By the same random numbers all but few paths are the same.
TEST(MeshInstances_Light, IsTheSamePathByPath) {
    Settings s;
    s.method = &methods::path;
    s.spp = 4;
    const auto copies = room(true), meshes = room(false);
    const RenderResult a = render(*copies, s, {}), b = render(*meshes, s, {});
    const Image &x = a.picture.layers.at("beauty"), &y = b.picture.layers.at("beauty");
    std::size_t alike = 0;
    for (std::size_t i = 0; i < x.data.size(); ++i)
        alike += std::abs(x.data[i] - y.data[i]) <= 1e-3f * std::abs(y.data[i]) ? 1 : 0;
    EXPECT_GT(double(alike), 0.95 * double(x.data.size()));
}

} // namespace
} // namespace keyhole
