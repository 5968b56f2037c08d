// Closed boxes of albedo rho whose walls emit 1 W/(m^2 sr): radiance is 1 / (1 - rho) everywhere, by every method.
#include "methods/method.h"
#include "methods/render.h"
#include "support/agreement.h"
#include "support/chance.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr double kRho = 0.5;

struct FurnaceCase {
    const char* name;
    std::unique_ptr<Scene> (*make)();
    bool caustics;
};

void PrintTo(const FurnaceCase& c, std::ostream* out) { *out << c.name; }

const FurnaceCase kFurnaces[] = {
    {"Diffuse", [] { return test::furnace(kRho); }, false},
    {"Varnished", [] { return test::varnished_furnace(kRho); }, true},
    {"WithoutLoss", [] { return test::furnace(kRho, true); }, true}, // a mirror and a glass ball that swallow nothing
    {"Patchy", [] { return test::patchy_furnace(kRho); }, true},
};

struct MethodCase {
    const char* method;
    int runs = 8;
    bool photons = false; ///< then indirect light is looked at alone where there is no caustic: direct light hides it
};

void PrintTo(const MethodCase& c, std::ostream* out) { *out << c.method; }

Settings settings(const std::string& method) {
    Settings s = test::settings_from("gather_rays=1 chains=100 light_paths=20k");
    s.method = &method_named(method);
    s.spp = s.method->samples_pixels ? 4 : 1;
    s.mutations = method == "mlt" ? 12'000 : method == "pssmlt" ? 20'000 : method == "mps" ? 140'000 : 40'000;
    // Photons of chains are right in the limit only, of many importons and of small lookups.
    s.photons = method == "mps" ? 25'000 : 10'000;
    s.importons = method == "mps" ? 40'000 : 20'000;
    s.brightness_samples = 10'000;
    if (method != "auto") s.cache_rays = 100; // what it decides by them would be noise
    return s;
}

class Furnace_HasItsClosedForm : public testing::TestWithParam<std::tuple<MethodCase, FurnaceCase>> {};

TEST_P(Furnace_HasItsClosedForm, InEveryBlock) {
    const auto& [method, furnace] = GetParam();
    const auto scene = furnace.make();

    const bool indirect = method.photons && !furnace.caustics;
    const double expected = 1 / (1 - kRho) - (indirect ? 1 + kRho : 0);
    const test::Blocks blocks =
        test::render_blocks(*scene, settings(method.method), method.runs, indirect ? "indirect" : "beauty");
    const auto n = static_cast<int>(blocks.size());
    double largest = 0;
    for (int b = 0; b < n; ++b) {
        const RunningStats& block = blocks[static_cast<std::size_t>(b)];
        EXPECT_TRUE(test::has_mean(block, expected, n)) << "block " << b;
        largest = std::max(largest, block.standard_error() / expected);
    }
    const double bound = test::most_errors(n, method.runs) * largest;
    fmt::print("{} {}: bound {:.4f}\n", method.method, furnace.name, bound);
    EXPECT_LT(bound, 0.08) << "power off by a tenth would go unnoticed";
}

std::string name_of(const testing::TestParamInfo<std::tuple<MethodCase, FurnaceCase>>& info) {
    return fmt::format("{}_{}", std::get<0>(info.param).method, std::get<1>(info.param).name);
}

const FurnaceCase kFoggy{"Foggy", [] { return test::foggy_furnace(kRho); }, true};
const FurnaceCase kForward{"Forward", test::forward_furnace, true};

INSTANTIATE_TEST_SUITE_P(Fog, Furnace_HasItsClosedForm,
                         testing::Combine(testing::Values(MethodCase{"path", 16}, MethodCase{"bdpt", 24},
                                                          MethodCase{"pssmlt"}, MethodCase{"mmlt", 32}),
                                          testing::Values(kFoggy)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Cloud, Furnace_HasItsClosedForm,
                         testing::Combine(testing::Values(MethodCase{"path", 16}, MethodCase{"bdpt", 24}),
                                          testing::Values(kForward)),
                         name_of);

INSTANTIATE_TEST_SUITE_P(Methods, Furnace_HasItsClosedForm,
                         testing::Combine(testing::Values(MethodCase{"path"}, MethodCase{"bdpt"}, MethodCase{"mlt", 16},
                                                          MethodCase{"pssmlt"}, MethodCase{"mmlt", 16},
                                                          MethodCase{"rjmlt", 16}, MethodCase{"mps", 8, true},
                                                          MethodCase{"ipm", 8, true}, MethodCase{"pm", 8, true},
                                                          MethodCase{"auto", 6}),
                                          testing::ValuesIn(kFurnaces)),
                         name_of);

} // namespace
} // namespace keyhole
