// What physics asks of every model: reciprocity, and no more light out than in.
#include "bsdf_cases.h"
#include "scene/warp.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

#include <complex>

namespace keyhole::test {
namespace {

double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }
Rgb abs_of(const Rgb& c) { return {std::abs(c.x), std::abs(c.y), std::abs(c.z)}; }

TEST(Bsdf_Eval, IsReciprocalUpToTheSquaredIndex) {
    for (const BsdfCase& c : bsdf_cases()) {
        SCOPED_TRACE(c.name);
        const Bsdf bsdf = bsdf_of(c);
        Rng rng(1, StreamPurpose::test, 0);
        double sum = 0;
        for (int i = 0; i < 20000; ++i) {
            const double u0 = rng.next(), u1 = rng.next(), u2 = rng.next(), u3 = rng.next();
            const Vec3 a = uniform_sphere(u0, u1), b = uniform_sphere(u2, u3);
            const double na = index_on_side(c, a), nb = index_on_side(c, b);
            const Rgb ab = bsdf.eval(a, b) / (nb * nb), ba = bsdf.eval(b, a) / (na * na);
            EXPECT_LE(largest(ab - ba), 1e-4 * largest(ab) + 1e-12) << a << b;
            sum += largest(ab);
        }
        EXPECT_EQ(sum > 0, bsdf.traits().finite);
    }
}

TEST(Bsdf_Delta, LeadsBackWithTheSameCoefficient) {
    for (const BsdfCase& c : bsdf_cases()) {
        SCOPED_TRACE(c.name);
        const Bsdf bsdf = bsdf_of(c);
        int found = 0;
        for (const Vec3& from : looks()) {
            for (const Event e : {Event::reflect, Event::transmit}) {
                const auto there = bsdf.delta(from, e);
                if (!there) continue;
                ++found;
                const auto back = bsdf.delta(there->to, e);
                ASSERT_TRUE(back);
                EXPECT_LT((back->to - from).length(), 1e-5);
                EXPECT_LT(largest(back->coefficient - there->coefficient), 1e-5);
                EXPECT_NEAR(back->eta * there->eta, 1, 1e-12);
                EXPECT_EQ(e == Event::transmit, there->to.z * from.z < 0);
                EXPECT_NEAR(there->eta, index_on_side(c, there->to) / index_on_side(c, from), 1e-6);
            }
        }
        EXPECT_EQ(found > 0, bsdf.traits().delta);
    }
}

/// Light of one channel that the finite part shows in direction `to_eye` when as much comes from everywhere as a closed
/// room of one temperature holds.
double finite_furnace(const BsdfCase& c, const Vec3& to_eye, int channel) {
    const Bsdf bsdf = bsdf_of(c);
    return integrate_sphere([&](const Vec3& to_light) {
        const double ratio = index_on_side(c, to_light) / index_on_side(c, to_eye);
        return bsdf.eval(to_light, to_eye)[channel] * std::abs(to_light.z) * ratio * ratio;
    });
}

/// The same of green light, with delta lobes.
double furnace(const BsdfCase& c, const Vec3& to_eye) {
    double sum = finite_furnace(c, to_eye, 1);
    for (const Event e : {Event::reflect, Event::transmit})
        if (const auto d = bsdf_of(c).delta(to_eye, e)) sum += d->coefficient.y;
    return sum;
}

TEST(Bsdf_WhiteFurnace, GivesNothingAwayAndMakesNothing) {
    for (const BsdfCase& c : bsdf_cases()) {
        for (const Vec3& look : looks()) {
            SCOPED_TRACE(c.name + " from z = " + std::to_string(look.z));
            const double seen = furnace(c, look);
            EXPECT_LT(seen, 1.01);
            if (c.conserves) {
                EXPECT_GT(seen, 0.99);
            }
        }
    }
}

TEST(Bsdf_Albedo, IsWhatTheFinitePartSendsToTheEyeInEvenLight) {
    for (const BsdfCase& c : bsdf_cases())
        for (const Vec3& look : looks()) {
            const Rgb albedo = bsdf_of(c).albedo(look);
            for (int channel = 0; channel < 3; ++channel) {
                SCOPED_TRACE(c.name + " from z = " + std::to_string(look.z) + ", channel " + std::to_string(channel));
                EXPECT_GE(albedo[channel], 0);
                EXPECT_LE(albedo[channel], 1);
                EXPECT_NEAR(albedo[channel], finite_furnace(c, look, channel), 0.055);
            }
        }
}

/// So that neither filters nor eyes find edges on a flat surface.
TEST(Bsdf_Albedo, HasNoStepsAcrossAFlatSurface) {
    for (const BsdfCase& c : bsdf_cases())
        for (const double side : {1.0, -1.0}) {
            SCOPED_TRACE(c.name + (side > 0 ? " from above" : " from below"));
            constexpr int kSteps = 180; // of half a degree
            const auto seen = [&](int i) {
                const double angle = 0.5 * kPi * (i - 0.5) / kSteps, across = 0.7 * angle;
                return bsdf_of(c).albedo(Vec3(std::sin(angle) * std::cos(across), std::sin(angle) * std::sin(across),
                                              side * std::cos(angle)));
            };
            for (int i = 2; i <= kSteps; ++i) EXPECT_LT(largest(abs_of(seen(i) - seen(i - 1))), 0.1) << i;
        }
}

/// The textbook's formulas, in complex numbers.
double fresnel_oracle(double cos_i, std::complex<double> n) {
    const auto cos_t = std::sqrt(1.0 - (1 - cos_i * cos_i) / (n * n));
    const auto s = (cos_i - n * cos_t) / (cos_i + n * cos_t), p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
    return (std::norm(s) + std::norm(p)) / 2;
}

TEST(Fresnel_Conductor, AgreesWithComplexArithmetic) {
    for (const double cosine : {0.0, 0.05, 0.4, 0.8, 1.0}) {
        for (const auto n : {std::complex(0.2, 3.9), std::complex(1.5, 0.0), std::complex(1.0, 0.7)}) {
            const Rgb r = fresnel_conductor(cosine, {Rgb(n.real()), Rgb(n.imag())});
            EXPECT_NEAR(r.x, fresnel_oracle(cosine, n), 1e-6) << cosine << ' ' << n;
        }
        EXPECT_NEAR(fresnel_dielectric(cosine, 1.5).reflectance, fresnel_oracle(cosine, 1.5), 1e-12);
    }
}

} // namespace
} // namespace keyhole::test
