// The same scene, settings and seed make the same picture, bit for bit, on any number of threads.
#include "core/parallel.h"
#include "methods/render.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

class Picture_IsTheSameOnAnyNumberOfThreads : public testing::TestWithParam<const char*> {};

TEST_P(Picture_IsTheSameOnAnyNumberOfThreads, BitForBit) {
    Settings settings = test::settings_from(
        "adaptive=true brightness_error=0.05 importons=20k chains=100 mutations=20k light_paths=20k");
    settings.method = &method_named(GetParam());
    settings.spp = 18;                   // more than a pilot
    settings.brightness_samples = 5'000; // more than one round of them
    settings.photons = 4'000;            // fewer than the chains would store: the ceiling is part of the test
    std::vector<Picture> pictures;
    for (const int threads : {1, 2, 3}) {
        with_threads(threads, [&] {
            const auto scene = test::mirror_glass_box();
            pictures.push_back(render(*scene, settings, {}).picture);
        });
    }
    for (const auto& [name, image] : pictures[0].layers)
        for (std::size_t i = 1; i < pictures.size(); ++i)
            EXPECT_EQ(image.data, pictures[i].layers.at(name).data) << name << " with " << i + 1 << " threads";
}

INSTANTIATE_TEST_SUITE_P(Methods, Picture_IsTheSameOnAnyNumberOfThreads,
                         testing::Values("mps", "ipm", "pm", "cps", "mlt", "path", "bdpt", "pssmlt", "mmlt", "rjmlt"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
