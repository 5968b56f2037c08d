// Where few of many rays bring most: balls around it, and nowhere else.
#include "core/rng.h"
#include "gather/spots/bright_balls.h"
#include "support/chance.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// Rays that all see something at 4 m in a cube of 4 m, each of radiance 1, but for what is added.
class Samples {
  public:
    explicit Samples(int count = 4000) {
        for (int i = 0; i < count; ++i) all_.push_back({anywhere(4, Vec3(0)), 4, 1});
    }
    Samples& add(int count, const Vec3& centre, float width, double radiance) {
        for (int i = 0; i < count; ++i) all_.push_back({anywhere(width, centre - Vec3(width / 2)), 4, radiance});
        return *this;
    }
    BrightBalls balls() const { return find_bright_balls(all_); }

  private:
    Vec3 anywhere(float width, const Vec3& corner) {
        const double x = rng_.next(), y = rng_.next(), z = rng_.next();
        return corner + Vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)) * width;
    }

    Rng rng_{1, StreamPurpose::test, 0};
    std::vector<RadianceSample> all_;
};

TEST(BrightBalls, AreNoneWhereAllIsAlike) {
    const BrightBalls found = Samples().balls();
    EXPECT_TRUE(found.balls.empty());
    EXPECT_EQ(found.left, 1);
}

TEST(BrightBalls, AreNoneWhereWhatIsBrightIsFarAndWide) {
    EXPECT_TRUE(Samples().add(12, Vec3(2), 4, 300).balls().balls.empty());
}

TEST(BrightBalls, HaveWhatBelongsTogetherInOne) {
    const BrightBalls found = Samples().add(40, {2, 2.7f, 1}, 0.2f, 300).balls();
    ASSERT_EQ(found.balls.size(), 1u);
    EXPECT_LT((found.balls[0].centre - Vec3(2, 2.7f, 1)).length(), 0.05f);
    EXPECT_GT(found.balls[0].radius, 0.1f);
    EXPECT_LT(found.balls[0].radius, 0.2f);
    EXPECT_GT(found.balls[0].share, 0.99);
    // A ball of r at a distance d fills r^2 / (2 d^2) of all directions.
    EXPECT_LT(found.left, 0.01);
}

TEST(BrightBalls, ArePartedWhereWhatIsBrightStandsApart) {
    const BrightBalls found = Samples().add(30, {1, 1, 1}, 0.2f, 300).add(30, {3, 1, 1}, 0.2f, 200).balls();
    ASSERT_EQ(found.balls.size(), 2u);
    EXPECT_LT((found.balls[0].centre - Vec3(1)).length(), 0.1f) << "the brighter one comes first";
    EXPECT_LT((found.balls[1].centre - Vec3(3, 1, 1)).length(), 0.1f);
    EXPECT_NEAR(found.balls[0].share / found.balls[1].share, 2.25, 0.01);
}

TEST(BrightBalls, LeaveOutRaysThatMeetSomethingBrightByThemselves) {
    const BrightBalls found =
        Samples().add(30, {1, 1, 1}, 0.2f, 300).add(1, {3, 3, 1}, 0.1f, 300).add(1, {3, 1, 3}, 0.1f, 300).balls();
    ASSERT_EQ(found.balls.size(), 1u);
    EXPECT_LT((found.balls[0].centre - Vec3(1)).length(), 0.1f);
    EXPECT_LT(found.balls[0].radius, 0.3f);
    EXPECT_GT(found.left, 2.0 / 32) << "what the two bring is left";
}

TEST(BrightBalls, AreWiderAroundFewerFindings) {
    const BrightBalls few = Samples().add(5, {1, 1, 1}, 0.2f, 300).balls();
    const BrightBalls many = Samples().add(500, {1, 1, 1}, 0.2f, 300).balls();
    ASSERT_EQ(few.balls.size(), 1u);
    ASSERT_EQ(many.balls.size(), 1u);
    EXPECT_TRUE((few.balls[0].centre - Vec3(1)).length() + 0.1f < few.balls[0].radius);
    EXPECT_LT(many.balls[0].radius, 0.2f);
    EXPECT_TRUE(Samples().add(3, {1, 1, 1}, 0.2f, 300).balls().balls.empty()) << "three may be anywhere";
}

TEST(BrightBalls, FillSomeDirectionsWhereAllWasFoundAtOnePlace) {
    const BrightBalls found = Samples().add(30, {1, 1, 1}, 0, 300).balls();
    ASSERT_EQ(found.balls.size(), 1u);
    EXPECT_GT(found.balls[0].radius, 0);
}

} // namespace
} // namespace keyhole
