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

} // namespace
} // namespace keyhole
