// What chains in primary sample space deposit.
#include "core/parallel.h"
#include "sampling/primary/primary_chains.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

// Without large steps on their own account each step deposits F b / I with weights that add up to 1: its luminance is
// b, whatever the path. So nothing may be lost or told twice where candidates become states, techniques change, or a
// round ends.
TEST(PrimaryChains, DepositTheBrightnessWithEveryStep) {
    const auto scene = test::mirror_glass_box();
    const BuilderContext builders{scene.get(), 8};
    const EmitterInverse inverses(*scene);
    const PrimaryStartOptions options{.samples = 5000, .seed = 1};
    for (const auto* method : {"pssmlt", "mmlt", "rjmlt"})
        for (const Failures failures : {Failures::reject, Failures::exclude_large, Failures::delay}) {
            const bool changes = std::string_view(method) == "rjmlt";
            PrimaryStart start = std::string_view(method) == "pssmlt"
                                     ? PrimaryStart::whole(make_bidirectional_builder(builders), options, {})
                                     : PrimaryStart::by_length(builders, changes ? &inverses : nullptr, options, {});
            with_threads(1, [&] {
                PrimaryChains chains(start.choose_seeds(30, 0), 1, false);
                for (int round = 0; round < 3; ++round) {
                    const double brightness = chains.brightness();
                    double luminances = 0;
                    chains.advance({failures, 0.3}, 100, {},
                                   [&](const Splat& s, double factor) { luminances += luminance(s.value) * factor; });
                    const double expected = 100.0 * static_cast<double>(chains.size()) * brightness;
                    EXPECT_NEAR(luminances, expected, 1e-9 * expected) << method;
                }
                EXPECT_EQ(chains.changes().accepted > 0, changes);
            });
        }
}

// Whoever stops a render doesn't wait for the end of a round; what chains have found by then is a shorter one.
TEST(PrimaryChains, EndAnywhereInARoundWhereTheyAreStopped) {
    const auto scene = test::mirror_glass_box();
    PrimaryStart start = PrimaryStart::by_length({scene.get(), 8}, nullptr, {.samples = 5000, .seed = 1}, RunContext{});
    PrimaryChains chains(start.choose_seeds(30, 0), 1, false);
    const double brightness = chains.brightness();
    StopToken stop;
    RunContext context;
    context.stop = &stop;
    double luminances = 0;
    with_threads(1, [&] {
        const std::int64_t done =
            chains.advance({Failures::exclude_large, 0.3}, 100'000, context, [&](const Splat& s, double factor) {
                stop.request();
                luminances += luminance(s.value) * factor;
            });
        EXPECT_LT(done, 100);
        EXPECT_EQ(chains.steps(), done);
        const double expected = static_cast<double>(done * chains.size()) * brightness;
        EXPECT_NEAR(luminances, expected, 1e-9 * expected);
        EXPECT_EQ(chains.advance({Failures::exclude_large, 0.3}, 1, context), 1);
    });
}

// Numbers written where the other technique doesn't read them lead to another path. That is found out only where they
// are read: moves would be made one way and refused the other, and one technique starved.
TEST(PrimaryChains, ChangeTechniquesOnlyWhereTheWayBackIsThere) {
    const struct {
        const char* light;
        std::unique_ptr<Scene> scene;
    } cases[] = {{"area", test::mirror_glass_box()},
                 {"point", test::point_light_box()},
                 {"spot", test::spot_scene()},
                 {"distant", test::distant_light_scene()},
                 {"sky", test::sky_box()}};
    for (const auto& c : cases) {
        const EmitterInverse inverses(*c.scene);
        PrimaryStart start =
            PrimaryStart::by_length({c.scene.get(), 8}, &inverses, {.samples = 20'000, .seed = 1}, RunContext{});
        with_threads(1, [&] {
            PrimaryChains chains(start.choose_seeds(30, 0), 1, false);
            chains.advance({Failures::reject, 0.3}, 2000, {}, [](const Splat&, double) {});
            const ChangeCounts counts = chains.changes();
            EXPECT_GE(counts.accepted, std::string_view(c.light) == "area" ? 100u : 0u) << c.light;
            EXPECT_LE(counts.drifted * 200, counts.accepted) << c.light;
        });
    }
}

} // namespace
} // namespace keyhole
