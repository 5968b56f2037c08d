// The ceiling on the memory of photons holds, by what was allocated, and thins without bias.
#include "methods/method.h"
#include "methods/photons/memory_plan.h"
#include "methods/render.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

Settings settings_for(const char* method, std::int64_t memory) {
    Settings s = test::settings_from(
        "spp=1 gather_rays=1 brightness_samples=20k mutations=60k light_paths=60k importons=100k chain_share=0.5");
    s.method = &method_named(method);
    s.photon_memory = memory;
    return s;
}

class PhotonMemory_StaysUnderItsCeiling : public testing::TestWithParam<const char*> {};

TEST_P(PhotonMemory_StaysUnderItsCeiling, AtEverySize) {
    for (const bool specular : {false, true}) {
        for (const std::int64_t kib : {256, 1024, 4096, 16384}) {
            SCOPED_TRACE(testing::Message() << kib << " KiB" << (specular ? ", with caustics" : ""));
            const auto scene = specular ? test::mirror_glass_box() : test::diffuse_box();
            scene->set_window({24, 16, 0});
            const RenderStats stats = render(*scene, settings_for(GetParam(), kib * 1024), {}).stats;
            EXPECT_LE(stats.photon_bytes, static_cast<std::uint64_t>(kib) * 1024);
            const auto photons = stats.photons_global + stats.photons_caustic;
            EXPECT_GT(photons, 1000u);
            // Small budgets are used up: a photon, its index and its part of the direct irradiance take 30 bytes, and
            // the importance map takes its share.
            if (kib == 256) {
                EXPECT_GT(photons * 30, 256u * 1024 / 4);
            }
        }
    }
}

TEST_P(PhotonMemory_StaysUnderItsCeiling, AndSaysWhatIsHeld) {
    const auto scene = test::mirror_glass_box();
    scene->set_window({24, 16, 0});
    const Settings s = settings_for(GetParam(), std::int64_t{1} << 30);
    const RenderStats stats = render(*scene, s, {}).stats;
    const std::uint64_t most = most_photon_bytes(s, method_named(GetParam()).importance, 2);
    EXPECT_LE(stats.photon_bytes, most);
    EXPECT_LE(most, 128u << 20) << "a tenth of the ceiling: that is what so little work can fill";
    // A photon takes 32 bytes, 24 more for lookups where there is room; an importon no more.
    const auto kept = stats.photons_global + stats.photons_caustic + stats.importons;
    EXPECT_LE(stats.photon_bytes, 64 * kept + (1 << 20));
}

INSTANTIATE_TEST_SUITE_P(Methods, PhotonMemory_StaysUnderItsCeiling, testing::Values("mps", "ipm", "pm", "cps"),
                         [](const auto& info) { return std::string(info.param); });

TEST(PhotonMemory, IsPlannedByTheWorkWhereThatFillsLess) {
    Settings s = settings_for("ipm", std::int64_t{1} << 44);
    const auto most = [&] { return most_photon_bytes(s, methods::ipm.importance, 2); };
    const std::uint64_t little = most();
    EXPECT_LT(little, 128u << 20);
    s.light_paths *= 10;
    EXPECT_GT(most(), 5 * little);
    s.photon_memory = 1 << 20;
    EXPECT_EQ(most(), 1u << 20);
    s.photons = 1000;
    s.importons = 1000;
    EXPECT_LT(most(), 1u << 19);
}

TEST(PhotonMemory, IsForLookupsWherePhotonsLeaveRoom) {
    const Settings s = settings_for("ipm", 1 << 20); // of which 20,000 photons take two thirds
    EXPECT_EQ(memory_for_lookups(s, 25'000, 6000), 0u);
    EXPECT_GE(memory_for_lookups(s, 15'000, 4000), 12u * 4000);
}

} // namespace
} // namespace keyhole
