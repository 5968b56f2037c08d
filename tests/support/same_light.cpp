#include "support/same_light.h"

#include "methods/method.h"
#include "support/agreement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace keyhole::test {
namespace {

/// What density estimates and interpolation may be off by, beside noise.
constexpr double kTolerance = 0.03;

} // namespace

std::vector<Settings> by_methods(const Settings& settings, const std::vector<const char*>& methods) {
    std::vector<Settings> all(methods.size(), settings);
    for (std::size_t i = 0; i < methods.size(); ++i) all[i].method = &method_named(methods[i]);
    return all;
}

void expect_same_light(Scene& scene, Settings reference, const std::vector<Settings>& settings, int runs) {
    scene.set_window({48, 32, 0});
    reference.seed = 1000; // far from the others' seeds
    const Blocks expected = render_blocks(scene, reference, runs);
    for (const Settings& s : settings) {
        const auto name = name_of(*s.method);
        const Disagreement d = compare(render_blocks(scene, s, runs), expected, kTolerance);
        EXPECT_EQ(d.rejected, 0) << fmt::format("{}\n{}mean brightness ratio {}", name, d.report, d.ratio);
        EXPECT_NEAR(d.ratio, 1, std::max(kTolerance, 4 * d.ratio_error)) << name;
        fmt::print("{}: ratio {:.4f} +- {:.4f}, worst {:.4f}, largest error {:.4f}\n", name, d.ratio, d.ratio_error,
                   d.worst, d.largest_error);
    }
}

} // namespace keyhole::test
