// Lamps behind a grid and spots with an extent: how their light spreads about the normal.
#include "scene/emitters/emission_profile.h"

#include "core/error.h"
#include "scene/emitters/emitters.h"
#include "scene/load/load.h"
#include "support/scratch_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace keyhole {
namespace {

using testing::HasSubstr;

const std::vector<EmissionProfile>& profiles() {
    static const std::vector all{EmissionProfile(),
                                 EmissionProfile::grid(180),
                                 EmissionProfile::grid(100),
                                 EmissionProfile::grid(1),
                                 EmissionProfile::cone(40, 45),
                                 EmissionProfile::cone(0, 90),
                                 EmissionProfile::cone(30, 30),
                                 EmissionProfile::cone(0.2, 0.5)};
    return all;
}

/// Integral of value() times the cosine within an angle whose sine is that, by the midpoint rule.
double power_within(const EmissionProfile& profile, double sine2) {
    constexpr int kSteps = 20'000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += profile.value(std::sqrt(1 - (i + 0.5) / kSteps * sine2));
    return kPi * sine2 * sum / kSteps;
}

TEST(EmissionProfile, KnowsItsIntegral) {
    for (const EmissionProfile& profile : profiles()) {
        const double all = std::pow(std::sin(profile.reach()), 2);
        EXPECT_NEAR(profile.projected_solid_angle() / power_within(profile, all), 1, 2e-4);
        for (const double part : {0.1, 0.5, 0.9}) {
            EXPECT_NEAR(profile.share_within(part * all),
                        power_within(profile, part * all) / profile.projected_solid_angle(), 2e-4);
        }
    }
}

TEST(EmissionProfile, InvertsItsShares) {
    for (const EmissionProfile& profile : profiles())
        for (const double share : {0.0, 0.1, 0.5, 0.9, 0.999})
            EXPECT_NEAR(profile.share_within(profile.sine2_of_share(share)), share, 1e-9);
}

TEST(EmissionProfile, IsOneAlongTheNormalAndDarkBeyondItsReach) {
    for (const EmissionProfile& profile : profiles()) {
        EXPECT_EQ(profile.value(1), 1);
        const double beyond = std::min(1.01 * profile.reach(), kPi / 2);
        EXPECT_TRUE(profile.value(std::cos(beyond)) == 0 || profile.reach() == kPi / 2);
    }
    EXPECT_NEAR(EmissionProfile::grid(90).value(std::cos(std::atan(0.25))), 0.75, 1e-12);
    EXPECT_NEAR(EmissionProfile::cone(0, 60).value(0.75), 0.5, 1e-12);
}

/// A rectangle of 4 m^2 with that emission.
std::unique_ptr<SurfaceEmission> emission(const std::string& text) {
    const ScratchDirectory folder;
    const std::string file = folder.write(
        "lamp.yaml", "camera: {from: [0, 0, 4], to: [0, 0, 0]}\nshapes: [{type: rectangle, emission: " + text + "}]\n");
    auto scene = load_scene(file);
    return std::move(scene.description.shapes.front().emission);
}

std::string error_of(const std::string& text) {
    try {
        emission(text);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(EmissionProfile, IsReadAndKeepsThePower) {
    for (const char* text : {"{power: 3}", "{power: 3, spread: 60}", "{power: 3, angle: 20, falloff: 10}",
                             "{power: 3, angle: 40, two_sided: true}"}) {
        Shape lamp;
        lamp.geometry = TriangleMesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {}, {}, {{0, 1, 2}, {0, 2, 3}}};
        lamp.emission = emission(text);
        EXPECT_NEAR(make_area_emitter(lamp, 0)->power(), 3, 1e-5) << text;
    }
    EXPECT_EQ(emission("{radiance: 2, spread: 60}")->radiance.x, 2);
    EXPECT_NEAR(emission("{radiance: 2, angle: 20}")->profile.reach(), 20 * kPi / 180, 1e-12);
    EXPECT_NEAR(emission("{radiance: 2, angle: 20}")->profile.value(std::cos(15.5 * kPi / 180)), 1, 0.1);
}

TEST(EmissionProfile, RefusesWhatMakesNoSense) {
    EXPECT_THAT(error_of("{power: 3, spread: 0}"), HasSubstr("an angle across the light"));
    EXPECT_THAT(error_of("{power: 3, spread: 60, angle: 30}"), HasSubstr("'spread' beside 'angle'"));
    EXPECT_THAT(error_of("{power: 3, falloff: 30}"), HasSubstr("'falloff' without 'angle'"));
    EXPECT_THAT(error_of("{power: 3, angle: 30, falloff: 40}"), HasSubstr("an angle up to 'angle'"));
}

} // namespace
} // namespace keyhole
