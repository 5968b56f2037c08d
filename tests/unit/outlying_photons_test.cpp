// Photons that stand for more visible power than so many can tell of: rare ones are cut off, and others left alone.
#include "photon_energy.h"

#include "photonmap/emission.h"
#include "scene/emitters/emitters.h"
#include "support/test_scenes.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using namespace energy_test;

EmittedPhotons emit(const Scene& scene, std::int64_t paths, bool cut) {
    const SurfacePatches patches(scene);
    const Rule rule{.depth = 6};
    const Guides guides = make_guides(scene, rule, 1, patches);
    return emit_photons(scene, guides.both(),
                        {.paths = paths, .photons = 1 << 20, .rule = rule.storage(), .seed = 3, .cut_outliers = cut},
                        {});
}

double power_of(const EmittedPhotons& photons) {
    double sum = 0;
    for (const Photon& p : photons.global.main_photons) sum += luminance(p.power());
    return sum;
}

TEST(OutlyingPhotons, AreNoneWhereAllAreAlike) {
    const auto scene = test::diffuse_box();
    const EmittedPhotons cut = emit(*scene, 20'000, true);
    EXPECT_EQ(cut.cut, 0);
    EXPECT_EQ(power_of(cut), power_of(emit(*scene, 20'000, false)));
}

TEST(OutlyingPhotons, LoseWhatIsTooMuchUntilThereAreEnough) {
    // Of a sky all around few paths come through the window, some of them from far off with the power of thousands.
    auto m = test::room_with_a_window();
    m.rectangle({-40, -2, -80}, {0, 0, 79.9f}, {80, 0, 0}, make_diffuse(Rgb(0.6)));
    m.emitter(make_constant_environment(Rgb(1)));
    m.rectangle({1, 2.49f, 1}, {1, 0, 0}, {0, 0, 1}, make_diffuse(Rgb(0)), Rgb(1)); // and a dim lamp
    m.camera({1.5f, 1.3f, 2.9f}, {1.5f, 1.2f, 0}, 60).window(32, 24);
    const auto scene = m.build();
    const EmittedPhotons few = emit(*scene, 20'000, true), many = emit(*scene, 1'000'000, true);
    EXPECT_GT(few.cut, 0.05);
    EXPECT_LT(power_of(few), power_of(emit(*scene, 20'000, false)));
    EXPECT_LT(many.cut, few.cut / 2) << "it is for want of paths that light is lost";
}

} // namespace
} // namespace keyhole
