// Varnished rooms: what photons and cached irradiance make of diffuse and glossy parts is what paths make of the whole.
#include "methods/method.h"
#include "support/agreement.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

namespace keyhole {
namespace {

struct CoatCase {
    const char* method;
    double alpha;
    bool cache;
};

void PrintTo(const CoatCase& c, std::ostream* out) {
    *out << c.method << " alpha " << c.alpha << (c.cache ? " cached" : " not cached");
}

std::string name_of(const CoatCase& c) {
    return fmt::format("{}_{}_{}", c.method, c.alpha > 0 ? "rough" : "smooth", c.cache ? "cached" : "gathered");
}

/// By paths from both ends, once for all cases of a scene.
const test::Blocks& reference(double alpha) {
    static std::map<double, test::Blocks> known;
    auto found = known.find(alpha);
    if (found != known.end()) return found->second;
    Settings s;
    s.method = &methods::bdpt;
    s.spp = 200;
    s.seed = 1000;
    return known.emplace(alpha, test::render_blocks(*test::varnished_box(alpha), s, 4)).first->second;
}

class Coats_AgreeWithPaths : public testing::TestWithParam<CoatCase> {};

TEST_P(Coats_AgreeWithPaths, BlockByBlock) {
    const CoatCase& c = GetParam();
    Settings s;
    s.method = &method_named(c.method);
    s.spp = c.cache ? 8 : 4;
    s.irradiance_cache = c.cache;
    s.brightness_samples = 100'000;
    s.importons = 100'000;
    s.mutations = 200'000;
    s.light_paths = 200'000;
    s.photons = 60'000;
    const test::Disagreement d =
        test::compare(test::render_blocks(*test::varnished_box(c.alpha), s, 4), reference(c.alpha), 0.03);
    fmt::print("{}: ratio {:.4f}, worst {:.4f}, largest error {:.4f}\n", name_of(c), d.ratio, d.worst, d.largest_error);
    EXPECT_EQ(d.rejected, 0) << d.report << "mean brightness ratio " << d.ratio;
    EXPECT_NEAR(d.ratio, 1, 0.02);
    EXPECT_LT(d.largest_error, 0.06) << "too noisy to tell";
}

INSTANTIATE_TEST_SUITE_P(Boxes, Coats_AgreeWithPaths,
                         testing::Values(CoatCase{"ipm", 0, true}, CoatCase{"ipm", 0, false}, CoatCase{"mps", 0, true},
                                         CoatCase{"ipm", 0.2, true}, CoatCase{"ipm", 0.2, false},
                                         CoatCase{"mps", 0.2, true}, CoatCase{"mps", 0.2, false}),
                         [](const auto& info) { return name_of(info.param); });

} // namespace
} // namespace keyhole
