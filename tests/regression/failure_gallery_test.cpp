// Scenes where methods fail: every method is right there, or says that it isn't. docs/failures.md has the matrix.
#include "core/error.h"
#include "core/statistics.h"
#include "methods/method.h"
#include "methods/render.h"
#include "scene/load/load.h"
#include "scene/load/yaml/user_path_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace keyhole {
namespace {

/// The mean luminance of the whole picture [W/(m^2 sr)], from bidirectional path tracing and, where it can find all
/// light, path tracing, with 200,000 samples or more of either; 24 x 16 pixels.
struct Case {
    const char* scene;
    double mean;
    double bound = 0.15; ///< of the relative error
};

constexpr Case kCases[] = {
    {"keyhole", 0.00634, 0.2}, {"thin_wall", 0.00297},  {"tiny_caustic", 1.850}, {"islands", 0.0895},
    {"many_lights", 2.500},    {"sun_glass", 0.528},    {"sds", 1.000},          {"grazing", 0.3715},
    {"furnace", 10},           {"stadium", 3.256},      {"coplanar", 0.7845},    {"scale_one", 0.6654},
    {"scale_small", 0.6654},   {"scale_large", 0.6654}, {"inside_glass", 1.746}, {"no_light", 0, 0},
    {"unseen_light", 0, 0},    {"black", 0.2388},       {"all_mirror", 0.2761},  {"one_pixel", 0.632}};

double mean_luminance(const Picture& picture) {
    const Image& beauty = picture.layers.at("beauty");
    double sum = 0;
    for (std::size_t i = 0; i < beauty.data.size(); i += 3)
        sum += luminance(Rgb(beauty.data[i], beauty.data[i + 1], beauty.data[i + 2]));
    return sum / static_cast<double>(beauty.data.size() / 3);
}

RenderResult make(const Case& c, const std::vector<std::string>& more, const UserPathFile& user_paths = {}) {
    std::vector<std::string> settings{"spp=8",           "mutations=20k",     "chains=64",
                                      "light_paths=20k", "importons=10k",     "brightness_samples=10k",
                                      "cache_rays=100",  "photon_memory=2MiB"};
    settings.insert(settings.end(), more.begin(), more.end());
    LoadedScene loaded = load(fmt::format("{}/scenes/failures/{}.yaml", KEYHOLE_SOURCE_DIR, c.scene), settings);
    if (loaded.description.window.width > 1) {
        loaded.description.window.width = 24;
        loaded.description.window.height = 16;
    }
    Scene scene(std::move(loaded.description));
    return render(scene, loaded.settings, {}, user_paths);
}

class FailureGallery : public testing::TestWithParam<Case> {};

TEST_P(FailureGallery, EveryMethodIsRightOrSaysThatItIsNot) {
    const Case& c = GetParam();
    std::string line = fmt::format("| {} |", c.scene);
    for (const Method* each : all_methods()) {
        const std::string_view method = each->name;
        const RenderResult result = make(c, {fmt::format("method={}", method)});
        const double mean = mean_luminance(result.picture);
        ASSERT_TRUE(std::isfinite(mean)) << method;
        const bool right = std::abs(mean - c.mean) <= c.bound * c.mean, alarmed = !result.stats.warnings.empty();
        EXPECT_TRUE(right || alarmed) << method << ": " << mean << " instead of " << c.mean << ", and no word of it";
        line += right ? alarmed ? " right, alarmed |" : " right |" : alarmed ? " alarmed |" : " **wrong** |";
    }
    // For the page in the docs.
    std::cout << line << "\n";
}

INSTANTIATE_TEST_SUITE_P(Scenes, FailureGallery, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.scene); });

/// Whoever sees the hole can say so.
TEST(FailureGallery_Keyhole, IsOpenedByAUserPath) {
    const Case& c = kCases[0];
    const UserPathFile paths = load_user_paths(KEYHOLE_SOURCE_DIR "/userpaths/keyhole.yaml");
    for (const char* method : {"auto", "ipm", "mps", "mlt"}) {
        RunningStats mean; // a single one is known to 10 to 30 %
        for (int seed = 1; seed <= 3; ++seed) {
            const RenderResult result = make(c,
                                             {fmt::format("method={}", method), fmt::format("seed={}", seed),
                                              "light_paths=200k", "importons=100k", "spp=16", "mutations=150k",
                                              "brightness_error=0", "chains=400", "brightness_samples=20k"},
                                             paths);
            mean.add(mean_luminance(result.picture));
            if (seed > 1) continue; // the map is near the bound below which it counts as sparse
            for (const std::string& w : result.stats.warnings)
                EXPECT_TRUE(w.find("photon") == std::string::npos || result.stats.method == "mps")
                    << method << ": " << w;
        }
        EXPECT_NEAR(mean.mean(), c.mean, 0.15 * c.mean + 2 * mean.standard_error()) << method;
    }
}

} // namespace
} // namespace keyhole
