#include "photonmap/photon.h"

#include "core/rng.h"
#include "core/statistics.h"
#include "scene/warp.h"
#include "support/chance.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

Rng make_rng(std::uint64_t index) { return {1, StreamPurpose::test, index}; }

double angle_in_degrees(const Vec3& a, const Vec3& b) {
    return std::atan2(static_cast<double>(a.cross(b).length()), static_cast<double>(a.dot(b))) * 180 / kPi;
}

template <class Int> double largest_error_in_degrees() {
    Rng rng = make_rng(0);
    double largest = 0;
    for (int i = 0; i < 300'000; ++i) {
        const Vec3 v = uniform_sphere(rng.next(), rng.next());
        largest = std::max(largest, angle_in_degrees(v, OctahedralVector<Int>(v).decode()));
    }
    return largest;
}

TEST(OctahedralVector, KeepsItsPromisedErrors) {
    EXPECT_LT(largest_error_in_degrees<std::int16_t>(), 0.0037);
    EXPECT_LT(largest_error_in_degrees<std::int8_t>(), 0.95);
}

TEST(OctahedralVector, KeepsAxesExactly) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {-1.0f, 1.0f}) {
            Vec3 v(0);
            v[axis] = sign;
            EXPECT_EQ(OctahedralVector<std::int8_t>(v).decode(), v);
            EXPECT_EQ(OctahedralVector<std::int16_t>(v).decode(), v);
        }
    }
}

TEST(SharedExponentRgb, RoundsWithinItsBoundAndWithoutBias) {
    Rng rng = make_rng(1);
    RunningStats error[3];
    for (int i = 0; i < 300'000; ++i) {
        const double magnitude = std::pow(10.0, 36 * rng.next() - 22);
        const Rgb c = Rgb(rng.next(), rng.next(), rng.next()) * magnitude;
        const SharedExponentRgb stored(c, static_cast<unsigned>(i % 32));
        const Rgb back = stored.decode();
        ASSERT_EQ(stored.marks(), static_cast<unsigned>(i % 32));
        const double largest = std::max({c.x, c.y, c.z});
        for (int k = 0; k < 3; ++k) {
            const double e = (back[k] - c[k]) / largest;
            ASSERT_LE(std::abs(e), 0x1p-12);
            error[k].add(e);
        }
    }
    for (const RunningStats& e : error) EXPECT_TRUE(test::has_mean(e, 0, 3));
}

TEST(SharedExponentRgb, HandlesTheEndsOfItsRange) {
    const auto round_trip = [](double x) { return SharedExponentRgb(Rgb(x, 0, 0)).decode().x; };
    EXPECT_EQ(round_trip(0.0), 0.0);
    EXPECT_EQ(round_trip(1.0), 1.0);
    EXPECT_EQ(round_trip(0x1p-79), 0x1p-79);
    EXPECT_EQ(round_trip(0x1p-300), 0.0);
    EXPECT_EQ(round_trip(0x1p46), 0x1p46);
    EXPECT_NEAR(round_trip(0x1p300) / 0x1p47, 1.0, 1e-3);
    // All mantissa bits set: rounds up into the next exponent.
    EXPECT_EQ(round_trip(std::nextafter(2.0, 0.0)), 2.0);
}

TEST(Photon, StaysACausticOneWhateverItsPower) {
    for (const bool caustic : {false, true}) {
        Photon photon(Vec3(0), {0, 0, 1}, {0, 0, 1}, Rgb(0.0), {.caustic = caustic});
        EXPECT_EQ(photon.caustic(), caustic);
        EXPECT_TRUE(is_black(photon.power()));
        photon.set_power(Rgb(1, 2, 3));
        EXPECT_EQ(photon.caustic(), caustic);
        EXPECT_EQ(photon.power().z, 3);
    }
}

TEST(Photon, KnowsByHowManyVerticesItsWayMayBeLonger) {
    for (int spare = 0; spare < 10; ++spare) {
        Photon photon(Vec3(0), {0, 0, 1}, {0, 0, 1}, Rgb(1.0), {.caustic = spare % 2 > 0, .spare = spare});
        photon.set_power(Rgb(0.5));
        EXPECT_EQ(photon.spare(), std::min(spare, PhotonPast::kMostSpare));
        EXPECT_EQ(photon.caustic(), spare % 2 > 0);
        EXPECT_FALSE(photon.behind());
        for (int longer = 0; longer < 12; ++longer)
            EXPECT_EQ(photon.reaches(longer), spare >= longer || spare >= PhotonPast::kMostSpare) << spare << longer;
    }
}

TEST(Photon, KnowsWhichSideOfTheSurfaceTheLightCameTo) {
    const Vec3 up(0, 0, 1), slanted = Vec3(1, 2, 3).normalized();
    Photon above(Vec3(0), up, slanted, Rgb(1.0)), below(Vec3(0), -up, slanted, Rgb(1.0), {.caustic = true});
    EXPECT_FALSE(above.behind());
    below.set_power(Rgb(0.0));
    EXPECT_TRUE(below.behind());
    EXPECT_TRUE(below.caustic());
}

TEST(Photon, TurnsItsNormalToTheSideOfTheLight) {
    const Vec3 up(0, 0, 1), slanted = Vec3(1, 2, 3).normalized();
    EXPECT_EQ(Photon(Vec3(0), up, slanted, Rgb(1.0)).normal().decode(), up);
    EXPECT_EQ(Photon(Vec3(0), -up, slanted, Rgb(1.0)).normal().decode(), up);
    EXPECT_EQ(Photon(Vec3(0), up, -slanted, Rgb(1.0)).normal().decode(), -up);
}

} // namespace
} // namespace keyhole
