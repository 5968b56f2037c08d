// Gather rays of visible points that are aimed at hot spots: the same light with less noise.
#include "core/statistics.h"
#include "gather/fill_cache.h"
#include "gather/final_gather.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A glossy room of 4 m; close to one wall a small lamp shines on a white card.
std::unique_ptr<Scene> glossy_room_with_a_bright_card() {
    const auto value = [](double x) { return constant_texture(x); };
    const auto gloss = make_coated_diffuse(constant_texture(Rgb(0.3)), value(0.5), value(0.5), 1.8, value(0));
    test::SceneMaker m;
    m.room({0, 0, 0}, {4, 4, 4}, gloss)
        .rectangle({3.5f, 3.5f, 0.2f}, {0.1f, 0, 0}, {0, 0.1f, 0}, make_diffuse(Rgb(0.8)))
        // Faces the card at a distance of 15 cm.
        .rectangle({3.53f, 3.53f, 0.35f}, {0, 0.04f, 0}, {0.04f, 0, 0}, make_diffuse(Rgb(0.0)), Rgb(100.0))
        .camera({0.5f, 3, 3.5f}, {3, 0, 1}, 60)
        .window(64, 64);
    return m.build();
}

class AimedGather : public testing::Test {
  protected:
    RunningStats indirect(const IrradianceCache* cache, const HotSpots* spots) const {
        const FinalGather gather(rays_, cache, spots, {.light = 1, .rays = 1});
        RunningStats sum;
        for (std::uint64_t i = 0; i < 100'000; ++i) {
            Rng rng(7, StreamPurpose::test, i);
            const double x = rng.next(), y = rng.next();
            sum.add(luminance(gather.sample({static_cast<float>(x), static_cast<float>(y)}, rng).indirect));
        }
        return sum;
    }

    std::unique_ptr<Scene> scene_ = glossy_room_with_a_bright_card();
    GatherRays rays_{*scene_, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 24};
    HotSpots spots_{rays_, 1 << 16, 1, {}};
};

TEST_F(AimedGather, BringsTheSameWithoutRecords) {
    ASSERT_GE(spots_.size(), 1u);
    const RunningStats aimed = indirect(nullptr, &spots_), blind = indirect(nullptr, nullptr);
    EXPECT_TRUE(test::same_mean(aimed, blind));
    EXPECT_LT(aimed.variance(), blind.variance() / 4);
}

TEST_F(AimedGather, BringsTheSameToGlossyParts) {
    const IrradianceCache cache = fill_cache(rays_, spots_, {}, {});
    const RunningStats aimed = indirect(&cache, &spots_), blind = indirect(&cache, nullptr);
    EXPECT_TRUE(test::same_mean(aimed, blind));
    EXPECT_LT(aimed.variance(), blind.variance() / 2);
}

} // namespace
} // namespace keyhole
