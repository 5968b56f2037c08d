// Scenes without geometry are pictures of their environment, by every method.
#include "core/error.h"
#include "methods/render.h"
#include "scene/emitters/emitters.h"
#include "scene/load/load.h"
#include "support/scratch_directory.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

class EmptyScene_ShowsItsEnvironment : public testing::TestWithParam<const char*> {};

TEST_P(EmptyScene_ShowsItsEnvironment, Everywhere) {
    for (const float far : {0.0f, 1e6f}) {
        test::SceneMaker m;
        m.emitter(make_constant_environment(Rgb(0.5, 0.25, 1.0)));
        m.emitter(make_point_emitter({far, 2, 0}, Rgb(1.0))); // which nothing shows
        m.camera({far, 1, 2}, {far, 1, 0}, 40).window(16, 12);
        const auto scene = m.build();
        Settings s = test::settings_from("spp=4 brightness_samples=5k importons=5k mutations=20k photons=5k");
        s.method = &method_named(GetParam());
        const Picture picture = render(*scene, s, {}).picture;
        const Image& image = picture.layers.at("beauty");
        double sum = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const float* p = image.at(x, y);
                ASSERT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
                EXPECT_NEAR(p[0], 0.5, 0.3);
                EXPECT_NEAR(p[0] / p[1], 2, 1e-3);
                sum += p[2];
            }
        EXPECT_NEAR(sum / (image.width * image.height), 1, 0.02);
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, EmptyScene_ShowsItsEnvironment,
                         testing::Values("auto", "path", "bdpt", "mlt", "pssmlt", "mmlt", "rjmlt", "pm", "ipm", "mps"),
                         [](const auto& info) { return std::string(info.param); });

TEST(EmptyScene, OfNothingAtAllIsRefused) {
    test::SceneMaker m;
    m.emitter(make_point_emitter({0, 2, 0}, Rgb(1.0)));
    EXPECT_THROW(m.build(), InputError);
}

TEST(EmptyScene, IsReadFromBothFormats) {
    const ScratchDirectory d;
    const std::string yaml = d.write("s.yaml", "camera: {from: [0, 0, 3], to: [0, 0, 0]}\n"
                                               "emitters: [{type: environment, radiance: 2}]\n");
    const std::string pbrt = d.write("s.pbrt", "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n");
    for (const std::string& path : {yaml, pbrt}) {
        const Scene scene(load(path).description);
        EXPECT_EQ(scene.emitters().size(), 1u);
        EXPECT_TRUE(scene.trace(scene.camera().eye(0.5, 0.5), {0, 0, 1}).has_value());
    }
}

} // namespace
} // namespace keyhole
