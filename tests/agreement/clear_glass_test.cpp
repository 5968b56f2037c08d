// Rooms with glass in the window: light that comes straight through is direct light for methods with photon maps and
// for path tracing, and counts once. Bidirectional path tracing knows nothing of it.
#include "methods/method.h"
#include "scene/emitters/emitters.h"
#include "scene/geometry.h"
#include "scene/load/load_mesh.h"
#include "support/same_light.h"
#include "support/settings_from.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace keyhole {
namespace {

/// Two faces so far apart [m] before the window, which lean by 7 degrees, with the normals that a file would have.
TriangleMesh leaning_slab(float thick) {
    TriangleMesh mesh = make_box({0, 0, 0}, {1, 1, thick - 0.001f});
    mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 8); // all but those along z
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    std::fill(mesh.normals.end() - 4, mesh.normals.end(), Vec3(0, 0, -1));
    const double lean = 7 * kPi / 180;
    transform_mesh(mesh, Imath::M44d().setEulerAngles(Imath::V3d(-lean, 0, 0)) *
                             Imath::M44d().setTranslation(Imath::V3d(0.9, 0.9, -double(thick))));
    return mesh;
}

/// A glossy floor, a mirror, a sky and a large sun; outside, a lamp. `thick`: of the glass [m]; 0: a pane.
std::unique_ptr<Scene> glazed_room(float thick) {
    test::SceneMaker m = test::room_with_a_window();
    const auto value = [](double x) { return constant_texture(x); };
    m.rectangle({0, 0.01f, 0}, {0, 0, 3}, {3, 0, 0},
                make_coated_diffuse(constant_texture(Rgb(0.5, 0.4, 0.3)), value(0.15), value(0.15), 1.5, value(0)));
    m.rectangle({2.99f, 0.5f, 0.6f}, {0, 0, 1.2f}, {0, 1, 0}, make_mirror(Rgb(0.9)));
    if (thick > 0) {
        m.shape({.geometry = leaning_slab(thick), .material = make_glass(1.5), .emission = nullptr});
    } else {
        m.rectangle({0.9f, 0.9f, -0.001f}, {1, 0, 0}, {0, 1, 0}, make_thin_dielectric(1.5));
    }
    m.emitter(make_constant_environment(Rgb(3.0, 4.0, 5.0)));
    m.emitter(make_distant_emitter(Vec3(0.2f, -0.6f, 0.75f).normalized(), Rgb(12.0), 20));
    m.rectangle({1, 2.6f, -1.5f}, {1, 0, 0}, {0, 0, 0.8f}, make_diffuse(Rgb(0.0)), Rgb(20.0));
    m.camera({2.7f, 1.5f, 2.8f}, {0.8f, 0.7f, 0.4f}, 60).window(48, 32);
    return m.build();
}

TEST(GlazedRoom_Light, IsTheSameByEveryMethod) {
    Settings base = test::settings_from("spp=4 brightness_samples=20k importons=15k mutations=50k light_paths=40k "
                                        "photons=20k chains=200 cache_rays=100");
    base.max_depth = 24; // with photons the faces of glass don't count for it
    for (const float thick : {0.0f, 0.02f}) {
        SCOPED_TRACE(thick);
        Settings paths = base;
        paths.method = &methods::bdpt;
        paths.spp = 64;
        std::vector<Settings> others = test::by_methods(base, {"path", "mlt", "ipm", "mps"});
        others[0].spp = 32;
        others[1].spp = 16;
        test::expect_same_light(*glazed_room(thick), paths, others, 4);
    }
}

} // namespace
} // namespace keyhole
