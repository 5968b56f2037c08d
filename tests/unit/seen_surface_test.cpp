// The layers `albedo` and `normal` mean the same by every method.
#include "methods/render.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <array>

namespace keyhole {
namespace {

/// Means over the quarters of the picture, channel by channel.
using Quarters = std::array<std::array<double, 3>, 4>;

Quarters quarters(const Image& image) {
    Quarters sums{};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                sums[static_cast<std::size_t>(2 * (2 * y / image.height) + 2 * x / image.width)][c] +=
                    4.0 * image.at(x, y)[c] / (image.width * image.height);
    return sums;
}

Picture picture_by(Scene& scene, const char* method) {
    Settings s = test::settings_from("spp=64 max_depth=8 brightness_samples=2k importons=2k light_paths=4k photons=2k "
                                     "gather_rays=1 irradiance_cache=false chains=10 mutations=1k");
    s.method = &method_named(method);
    return render(scene, s, {}).picture;
}

class SeenSurface : public testing::TestWithParam<const char*> {};

TEST_P(SeenSurface, IsTheSameAsByPathTracing) {
    const auto scene = test::mirror_glass_box();
    const Picture reference = picture_by(*scene, "path"), picture = picture_by(*scene, GetParam());
    for (const char* layer : {"albedo", "normal"}) {
        const Quarters expected = quarters(reference.layers.at(layer)), found = quarters(picture.layers.at(layer));
        for (std::size_t q = 0; q < found.size(); ++q)
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(found[q][c], expected[q][c], 0.01) << layer << ", quarter " << q << ", channel " << c;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, SeenSurface, testing::Values("bdpt", "mlt", "ipm"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
