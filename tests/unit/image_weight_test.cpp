// Weights of pixels: dark parts of a picture count as much as bright ones.
#include "sampling/paths/image_weight.h"

#include "core/statistics.h"
#include "sampling/paths/path_tracer.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace keyhole {
namespace {

TEST(ImageWeight, IsTheReciprocalOfBrightnessWithinBounds) {
    ImageWeight::Cells luminance;
    luminance.fill(2);
    luminance[ImageWeight::index({0.1f, 0.1f})] = 1;
    luminance[ImageWeight::index({0.5f, 0.9f})] = 4;
    luminance[ImageWeight::index({0.9f, 0.1f})] = 0;
    luminance[ImageWeight::index({0.9f, 0.9f})] = 1e6;
    const ImageWeight weight(luminance);
    const double grey = weight({0.3f, 0.3f});
    EXPECT_DOUBLE_EQ(weight({0.1f, 0.1f}), 2 * grey);
    EXPECT_DOUBLE_EQ(weight({0.5f, 0.9f}), grey / 2);
    EXPECT_DOUBLE_EQ(weight({0.9f, 0.1f}), ImageWeight::kMost);
    EXPECT_DOUBLE_EQ(weight({0.9f, 0.9f}), 1 / ImageWeight::kMost);
    EXPECT_DOUBLE_EQ(weight({-0.01f, 1.01f}), weight({0, 1})) << "outside the window its border counts";
}

TEST(ImageWeight, SaysNothingOfABlackPicture) {
    const ImageWeight weight(ImageWeight::Cells{});
    EXPECT_EQ(weight({0.5f, 0.5f}), 1.0);
}

/// Sums of luminance over the blocks of a picture.
struct BlockSums {
    static constexpr int kAcross = 4;
    std::vector<double> sums = std::vector<double>(std::size_t{kAcross} * kAcross, 0.0);
    const ImageWeight* weight;
    Vec2 image{0, 0};

    bool arrival(const EyeWalk&, const Rgb&, int) { return true; }
    void contribution(const EyeWalk&, const Vertex&, const Rgb& value, LightClass) {
        const auto cell = [](float x) { return static_cast<std::size_t>(x * kAcross); };
        sums[cell(image.y) * kAcross + cell(image.x)] +=
            luminance(value) * (weight != nullptr ? (*weight)(image) : 1.0);
    }
    /// Of the brightest block to the darkest.
    double contrast() const {
        const auto [least, most] = std::ranges::minmax_element(sums);
        return *most / *least;
    }
};

TEST(ImageWeight, EvensOutAPicture) {
    const auto scene = test::two_rooms(0.5f);
    const ImageWeight weight = measure_image_weight(*scene, 8, 1, {});
    BlockSums plain{.weight = nullptr}, weighted{.weight = &weight};
    for (std::uint64_t i = 0; i < 160'000; ++i) {
        for (BlockSums* sums : {&plain, &weighted}) {
            Rng rng(2, StreamPurpose::test, i);
            sums->image = Vec2(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
            trace_path(*scene, sums->image, 8, rng, *sums);
        }
    }
    EXPECT_GT(plain.contrast(), 4);
    EXPECT_LT(weighted.contrast(), 2);
}

} // namespace
} // namespace keyhole
