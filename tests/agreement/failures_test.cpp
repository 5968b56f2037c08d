// Leaving failed proposals out of a chain makes another picture; the other treatments do not.
#include "core/statistics.h"
#include "methods/method.h"
#include "support/chance.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A blind: the left half of the picture shows strips of light with gaps as wide, narrower than a small step, the right
/// half a sheet of light. Proposals fail next to gaps only.
std::unique_ptr<Scene> blind() {
    const auto black = make_diffuse(Rgb(0.0));
    test::SceneMaker maker;
    constexpr int strips = 40;
    constexpr float width = 1.0f / strips;
    for (int i = 0; i < strips; ++i)
        maker.rectangle({-1 + width * static_cast<float>(i), -1, 0}, {width / 2, 0, 0}, {0, 2, 0}, black, Rgb(1.0));
    return maker.rectangle({0, -1, 0}, {1, 0, 0}, {0, 2, 0}, black, Rgb(1.0))
        .camera({0, 0, 2}, {0, 0, 0}, 40)
        .window(64, 48)
        .build();
}

/// Brightness of the left half over that of the right one.
double left_over_right(Scene& scene, const Settings& settings) {
    const Picture picture = render(scene, settings, {}).picture;
    const Image& image = picture.layers.at("beauty");
    double left = 0, right = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) (x < image.width / 2 ? left : right) += image.at(x, y)[1];
    return left / right;
}

RunningStats ratio(Failures failures) {
    const auto scene = blind();
    Settings s = test::settings_from(
        "method=pssmlt builder=path max_depth=1 brightness_samples=20k chains=200 mutations=100k p_large=0.1");
    s.failures = failures;
    RunningStats ratio;
    for (s.seed = 1; s.seed <= 8; ++s.seed) ratio.add(left_over_right(*scene, s));
    return ratio;
}

double exact_ratio() {
    const auto scene = blind();
    Settings s = test::settings_from("method=path max_depth=1 spp=256");
    return left_over_right(*scene, s);
}

TEST(FailedProposals, LeftOutDarkenWhereTheyAreMany) {
    const RunningStats r = ratio(Failures::exclude);
    const double bias = r.mean() / exact_ratio() - 1;
    RecordProperty("bias", std::to_string(bias));
    EXPECT_LT(bias, -0.1) << "bias " << bias << " +- " << r.standard_error();
}

TEST(FailedProposals, TreatedExactlyChangeNothing) {
    const double exact = exact_ratio();
    EXPECT_NEAR(exact, 0.5, 0.02);
    for (const Failures failures : {Failures::reject, Failures::exclude_large, Failures::delay}) {
        const RunningStats r = ratio(failures);
        EXPECT_TRUE(test::has_mean(r, exact, 3, 0.005 * exact)) << word_of(failures);
        EXPECT_LT(r.standard_error(), 0.02 * exact) << word_of(failures);
    }
}

} // namespace
} // namespace keyhole
