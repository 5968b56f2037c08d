// Lamps that shine and can't be hit: only sampling their points finds their light, and all methods find the same.
#include "methods/method.h"
#include "scene/emitters/emitters.h"
#include "support/same_light.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

Settings base() {
    return test::settings_from(
        "max_depth=8 spp=2 brightness_samples=10k importons=15k mutations=30k light_paths=30k photons=15k chains=50");
}

void expect_same_as_by_path(Scene& scene, const std::vector<const char*>& methods, std::int64_t spp = 16) {
    Settings path = base();
    path.method = &methods::path;
    path.spp = spp;
    test::expect_same_light(scene, path, test::by_methods(base(), methods), 8);
}

TEST(InvisibleLamp_Light, IsTheSameByEveryMethod) {
    expect_same_as_by_path(*test::invisible_lamp_box(), {"bdpt", "mlt", "pssmlt", "mmlt", "rjmlt", "pm", "ipm", "mps"});
}

TEST(NarrowBeams_Light, IsTheSameByEveryMethod) {
    expect_same_as_by_path(*test::narrow_beams_box(), {"bdpt", "mlt", "pssmlt", "mmlt", "rjmlt", "pm", "ipm", "mps"},
                           200);
}

/// Were the lamp seen it would be a dot as bright as the whole picture, but only where sub-paths are joined to the eye.
TEST(PointInView_Light, IsTheSameByEveryMethod) {
    test::SceneMaker m;
    m.room({-1, 0, -1}, {1, 2, 3}, make_diffuse(Rgb(0.6)))
        .emitter(make_point_emitter({0.3f, 1.2f, 0.5f}, Rgb(4.0)))
        .camera({0, 1, 2.9f}, {0, 0.95f, -1}, 50)
        .window(48, 32);
    expect_same_as_by_path(*m.build(), {"bdpt", "mlt", "mmlt", "ipm"});
}

} // namespace
} // namespace keyhole
