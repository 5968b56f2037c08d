// Lamps that a narrow lobe shows by way of glass, L S+ D S* E: gather rays find the large ones, and photons bring the
// others. Each path counts once, and what is mirrored is as sharp as the lobe and not as blurred as photons lie.
#include "methods/method.h"
#include "scene/emitters/emitters.h"
#include "support/agreement.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::MaterialPtr;

FloatTexture value(double x) { return constant_texture(x); }

MaterialPtr marble(double alpha) {
    return make_coated_diffuse(constant_texture(Rgb(0.6)), value(alpha), value(alpha), 1.5, value(0));
}

MaterialPtr brushed(double alpha) { return make_conductor(constant_texture(Rgb(0.8)), value(alpha), value(alpha)); }

MaterialPtr clearcoat(double alpha) {
    return make_principled({constant_texture(Rgb(0.5, 0.3, 0.2)), value(0), value(0.4), value(0.4), value(0.04),
                            value(0), value(0), value(1), value(alpha), value(0), value(0)});
}

/// A counter that mirrors two balls and a block of glass, which stand above it.
test::SceneMaker counter(const MaterialPtr& top) {
    test::SceneMaker m;
    m.rectangle({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, top)
        .sphere({-0.5f, 0.35f, -0.6f}, 0.2f, make_glass(1.5))
        .sphere({0, 0.35f, -0.6f}, 0.2f, make_glass(1.5))
        .box({0.3f, 0.05f, -0.8f}, {0.9f, 0.8f, -0.6f}, make_glass(1.5))
        .camera({0, 0.6f, 2}, {0, 0, 0}, 30)
        .window(48, 32);
    return m;
}

/// What shines through the glass.
enum class Lamp { panel, small_and_panel, sky, small };

std::unique_ptr<Scene> lit(const MaterialPtr& top, Lamp lamp) {
    test::SceneMaker m = counter(top);
    const MaterialPtr black = make_diffuse(Rgb(0.0));
    if (lamp == Lamp::panel || lamp == Lamp::small_and_panel)
        m.rectangle({-1, 0.05f, -1.2f}, {2, 0, 0}, {0, 1, 0}, black, Rgb(3.0));
    // A lamp too small to count as large, which bidirectional paths find nevertheless.
    if (lamp == Lamp::small_and_panel)
        m.rectangle({-0.35f, 0.25f, -1.1f}, {0.2f, 0, 0}, {0, 0.2f, 0}, black, Rgb(20.0));
    if (lamp == Lamp::small) m.rectangle({-0.3f, 0.3f, -1.2f}, {0.3f, 0, 0}, {0, 0.3f, 0}, black, Rgb(30.0));
    if (lamp == Lamp::sky) m.emitter(make_constant_environment(Rgb(1.0, 1.2, 1.5)));
    return m.build();
}

struct LobeCase {
    const char* name;
    MaterialPtr (*top)(double alpha);
    double alpha;
    Lamp lamp;
    double largest_error; ///< of a block of the caustic layer where it is bright; 0: photons bring it, noise is theirs
};

void PrintTo(const LobeCase& c, std::ostream* out) { *out << c.name; }

Settings settings(const char* method, bool cache) {
    Settings s = test::settings_from(
        "spp=16 brightness_samples=10k brightness_error=0 importons=20k mutations=60k light_paths=40k "
        "photons=20k chains=200 cache_rays=100 gather_coverage=false");
    s.method = &method_named(method);
    s.irradiance_cache = cache;
    return s;
}

class NarrowLobes_ShowLamps : public testing::TestWithParam<LobeCase> {};

TEST_P(NarrowLobes_ShowLamps, BlockByBlock) {
    const LobeCase& c = GetParam();
    const auto scene = lit(c.top(c.alpha), c.lamp);
    Settings paths = settings("bdpt", false);
    paths.spp = 96;
    paths.seed = 1000;
    const test::Blocks reference = test::render_blocks(*scene, paths, 6, "caustic");
    double brightest = 0;
    for (const auto& block : reference) brightest = std::max(brightest, block.mean());
    for (const auto& [method, cache] : {std::pair("ipm", true), std::pair("ipm", false), std::pair("mps", true)}) {
        const test::Blocks found = test::render_blocks(*scene, settings(method, cache), 4, "caustic");
        const test::Disagreement d = test::compare(found, reference, 0.03);
        double error = 0, off = 0, sum = 0, variance = 0, expected = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double e2 = found[i].standard_error() * found[i].standard_error() +
                              reference[i].standard_error() * reference[i].standard_error();
            sum += found[i].mean();
            expected += reference[i].mean();
            variance += e2;
            if (reference[i].mean() < 0.2 * brightest) continue;
            error = std::max(error, found[i].standard_error() / reference[i].mean());
            off = std::max(off, std::abs(found[i].mean() - reference[i].mean()) / std::sqrt(e2));
        }
        fmt::print("{} {}{}: ratio {:.4f} +- {:.4f}, worst {:.4f}, error where it is bright {:.4f}, off {:.1f}\n",
                   c.name, method, cache ? ", cached" : "", sum / expected, std::sqrt(variance) / expected, d.worst,
                   error, off);
        EXPECT_EQ(d.rejected, 0) << method << "\n" << d.report;
        EXPECT_LT(std::abs(sum - expected), 4 * std::sqrt(variance)) << method;
        // What chains leave of the diffuse part's caustics is noisier than that.
        if (std::string_view(method) == "mps") continue;
        EXPECT_TRUE(c.largest_error == 0 || error < c.largest_error) << method << ": " << error;
    }
}

INSTANTIATE_TEST_SUITE_P(Counters, NarrowLobes_ShowLamps,
                         testing::Values(LobeCase{"marble", marble, 0.02, Lamp::panel, 0.05},
                                         LobeCase{"wide", marble, 0.09, Lamp::panel, 0.05},
                                         LobeCase{"broad", marble, 0.2, Lamp::panel, 0},
                                         LobeCase{"brushed", brushed, 0.03, Lamp::panel, 0.05},
                                         LobeCase{"clearcoat", clearcoat, 0.02, Lamp::panel, 0.05},
                                         LobeCase{"two_lamps", marble, 0.02, Lamp::small_and_panel, 0.05},
                                         LobeCase{"small", marble, 0.02, Lamp::small, 0.05},
                                         LobeCase{"sky", marble, 0.02, Lamp::sky, 0.05}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace keyhole
