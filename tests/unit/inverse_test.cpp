// Inverse mappings: numbers found for a choice make that choice again.
#include "sampling/paths/walk.h"
#include "sampling/primary/reversible_jump.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// Says these numbers.
class Script final : public SampleSource {
  public:
    template <std::size_t N>
    explicit Script(const std::array<double, N>& numbers) : numbers_(numbers.begin(), numbers.end()) {}
    double next() override { return numbers_.at(i_++); }

  private:
    std::vector<double> numbers_;
    std::size_t i_ = 0;
};

Vertex vertex_with(const Bsdf::Model& model) {
    Vertex v;
    v.point.ng = v.point.ns = Vec3(0.36f, 0.48f, 0.8f);
    v.point.tangent = Vec3(0.8f, -0.6f, 0);
    v.bsdf = Bsdf(v.point, model);
    return v;
}

void expect_round_trips(const Bsdf::Model& model, float tolerance) {
    Vertex v = vertex_with(model);
    Rng rng(1, StreamPurpose::test, 0);
    int made = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 back = Vec3(static_cast<float>(rng.next() - 0.3), static_cast<float>(rng.next() - 0.2),
                               static_cast<float>(rng.next() + 0.1))
                              .normalized();
        const auto sample = v.bsdf.sample(back, rng);
        if (!sample) continue;
        v.event = sample->event;
        const auto numbers = invert_bsdf(v, back, sample->to, rng);
        ASSERT_TRUE(numbers);
        for (const double u : *numbers) EXPECT_TRUE(u >= 0 && u < 1);
        Script script(*numbers);
        const auto again = v.bsdf.sample(back, script);
        ASSERT_TRUE(again);
        EXPECT_EQ(again->event, sample->event);
        EXPECT_LT((again->to - sample->to).length(), tolerance);
        ++made;
    }
    EXPECT_GT(made, 1000);
}

TEST(Inverse, OfBsdfsMakesTheDirectionAgain) {
    expect_round_trips(DiffuseBsdf{Rgb(0.5)}, 1e-3f);
    expect_round_trips(MirrorBsdf{Rgb(0.5)}, 1e-6f);
    expect_round_trips(GlassBsdf{1.5}, 1e-6f);
    expect_round_trips(RoughConductorBsdf{{}, 0.2f, 0.4f}, 1e-3f);
}

TEST(Inverse, OfBsdfsFindsTheNumbersThemselvesWhereOnlyTheyDo) {
    const Vec3 back = Vec3(0.1f, 0.5f, 0.9f).normalized();
    Rng rng(1, StreamPurpose::test, 0);
    for (const Bsdf::Model& model :
         {Bsdf::Model(DiffuseBsdf{Rgb(0.5)}), Bsdf::Model(RoughConductorBsdf{{}, 0.3f, 0.2f})})
        for (int i = 0; i < 500; ++i) {
            Vertex v = vertex_with(model);
            const std::array numbers{rng.next(), rng.next(), rng.next()};
            Script script(numbers);
            const auto sample = v.bsdf.sample(back, script);
            if (!sample) continue;
            const auto found = invert_bsdf(v, back, sample->to, rng);
            ASSERT_TRUE(found);
            EXPECT_NEAR((*found)[0], numbers[0], 1e-4);
            const double turn = std::abs((*found)[1] - numbers[1]);
            EXPECT_LT(std::min(turn, 1 - turn) * std::sqrt(numbers[0]), 1e-4);
        }
}

TEST(Inverse, IsMissingWhereNoneIsKnown) {
    Rng rng(1, StreamPurpose::test, 0);
    const Vertex v = vertex_with(RoughDielectricBsdf{1.5f, 0.2f, 0.2f});
    EXPECT_FALSE(invert_bsdf(v, {0, 0, 1}, {0, 0.6f, 0.8f}, rng));
    const auto scene = test::point_light_box();
    const EmitterInverse inverse(*scene);
    EXPECT_FALSE(inverse.point(sample_emitter(*scene, rng)->vertex.point, rng));
}

/// Of points and rays that the emitters of a scene make; how many had an inverse.
int expect_made_again(const Scene& scene) {
    const EmitterInverse inverse(scene);
    Rng rng(1, StreamPurpose::test, 0);
    int inverted = 0;
    for (int i = 0; i < 500; ++i) {
        const SurfacePoint point = sample_emitter(scene, rng)->vertex.point;
        const auto numbers = inverse.point(point, rng);
        EXPECT_EQ(numbers.has_value(), !scene.shapes()[point.shape].emission->two_sided);
        if (!numbers) continue;
        ++inverted;
        Script script(*numbers);
        const SurfacePoint again = sample_emitter(scene, script)->vertex.point;
        EXPECT_EQ(again.emitter, point.emitter);
        EXPECT_EQ(again.primitive, point.primitive);
        EXPECT_LT((again.p - point.p).length(), 1e-5f);
        const Emitter& emitter = scene.emitter(point.emitter);
        const EmitterRay ray = emitter.sample_ray(point, rng);
        Script ray_script(inverse.ray(point, ray.w));
        EXPECT_LT((emitter.sample_ray(point, ray_script).w - ray.w).length(), 1e-3f);
    }
    return inverted;
}

TEST(Inverse, OfEmittersMakesPointAndRayAgain) {
    EXPECT_EQ(expect_made_again(*test::furnace(0.5)), 500); // six walls that emit
    EXPECT_GT(expect_made_again(*test::narrow_beams_box()), 300);
}

} // namespace
} // namespace keyhole
