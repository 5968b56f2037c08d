// Photons that stand for more visible power than so many can tell of: rare ones are cut off, and others left alone.
#include "photon_energy.h"

#include "photonmap/emission.h"
#include "photonmap/power.h"
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

Photon of_power(const Rgb& power, bool caustic = false) {
    return {Vec3(0), Vec3(0, 1, 0), Vec3(0, 1, 0), power, {.caustic = caustic}};
}

TEST(OutlyingPower, IsCutToWhatTheOthersAllow) {
    constexpr std::size_t kPhotons = 10'000;
    std::vector<Photon> photons(kPhotons, of_power(Rgb(1.0)));
    EXPECT_EQ(cut_outlying_power(photons), 0);
    // One is brighter by far than all others together: it is not to raise the bound that it is cut by.
    photons[17] = of_power(Rgb(1e6, 2e6, 0), true);
    const double power = luminance(photons[17].power());
    const double lost = cut_outlying_power(photons), bound = 2 * std::sqrt(kPhotons);
    const double left = luminance(photons[17].power());
    EXPECT_NEAR(left, bound, 0.05 * bound);
    EXPECT_NEAR(lost, (power - left) / (power + kPhotons - 1), 1e-6);
    EXPECT_NEAR(photons[17].power()[1] / photons[17].power()[0], 2, 0.02) << "another hue";
    EXPECT_TRUE(photons[17].caustic());
    EXPECT_EQ(photons[16], of_power(Rgb(1.0)));
}

TEST(OutlyingPower, IsNoneWhereItIsFrequent) {
    std::vector<Photon> photons(10'000, of_power(Rgb(1.0)));
    for (std::size_t i = 0; i < photons.size(); i += 100) photons[i] = of_power(Rgb(150.0));
    const std::vector<Photon> before = photons;
    EXPECT_EQ(cut_outlying_power(photons), 0);
    EXPECT_EQ(photons, before);
    std::vector<Photon> none;
    EXPECT_EQ(cut_outlying_power(none), 0);
}

} // namespace
} // namespace keyhole
