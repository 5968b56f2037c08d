// A BSDF's finite part is its diffuse part and its glossy part, and nothing besides.
#include "bsdf_cases.h"
#include "scene/bsdfs/wide_lobe.h"
#include "scene/warp.h"
#include "support/chi_squared.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace keyhole::test {
namespace {

double largest_of(const Rgb& c) { return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}); }

double probability_of_finite(const Bsdf& bsdf, const Vec3& from) {
    double p = 1;
    for (const Event e : {Event::reflect, Event::transmit})
        if (const auto d = bsdf.delta(from, e)) p -= d->probability;
    return p;
}

/// What irradiance is to give, if light from a direction had the weight that is planted there in place of w.
template <class Weight> double mean_weight(const Vec3& side, const Weight& weight) {
    return kInvPi * integrate_sphere([&](const Vec3& to_light) {
               return to_light.z * side.z > 0 ? weight(to_light) * std::abs(static_cast<double>(to_light.z)) : 0.0;
           });
}

TEST(Bsdf_Parts, TraitsSayWhatThereIs) {
    for (const BsdfCase& c : bsdf_cases()) {
        SCOPED_TRACE(c.name);
        const BsdfTraits t = bsdf_of(c).traits(), rest = bsdf_of(c).glossy_part().traits();
        EXPECT_EQ(t.finite, t.diffuse || t.glossy);
        EXPECT_EQ(rest.glossy, t.glossy);
        EXPECT_FALSE(rest.diffuse);
        for (const Vec3& look : looks()) {
            EXPECT_EQ(largest_of(bsdf_of(c).diffuse_reflectance(look)) > 0, t.diffuse);
            if (t.finite) {
                EXPECT_EQ(bsdf_of(c).glossy_albedo(look) > 0, t.glossy);
            }
        }
    }
}

TEST(Bsdf_Parts, AddUpToTheWhole) {
    for (const BsdfCase& c : bsdf_cases()) {
        SCOPED_TRACE(c.name);
        const Bsdf bsdf = bsdf_of(c), rest = bsdf.glossy_part();
        Rng rng(11, StreamPurpose::test, 0);
        for (int i = 0; i < 5000; ++i) {
            const double u0 = rng.next(), u1 = rng.next(), u2 = rng.next(), u3 = rng.next();
            const Vec3 a = uniform_sphere(u0, u1), b = uniform_sphere(u2, u3);
            Rgb sum = rest.eval(a, b);
            if (a.z * b.z > 0) sum += bsdf.diffuse_reflectance(b) * bsdf.diffuse_weight(a);
            const Rgb whole = bsdf.eval(a, b);
            EXPECT_LE(largest_of(sum - whole), 1e-5 * largest_of(whole) + 1e-9) << a << b;
        }
    }
}

TEST(Bsdf_Parts, EvenLightIsReflectedByIrradianceAlone) {
    for (const BsdfCase& c : bsdf_cases()) {
        const Bsdf bsdf = bsdf_of(c), rest = bsdf.glossy_part();
        if (!bsdf.traits().diffuse) continue;
        for (const Vec3& look : looks()) {
            SCOPED_TRACE(c.name + " from z = " + std::to_string(look.z));
            const double reflected = integrate_sphere([&](const Vec3& to_light) {
                return (bsdf.eval(to_light, look) - rest.eval(to_light, look)).y *
                       std::abs(static_cast<double>(to_light.z));
            });
            EXPECT_NEAR(reflected / (kPi * bsdf.diffuse_reflectance(look).y), 1, 2e-3);
            EXPECT_NEAR(mean_weight(look, [&](const Vec3& w) { return bsdf.diffuse_weight(w); }), 1, 2e-3);
        }
    }
}

/// The transmittance along the normal, or that towards the eye, in place of the mean: the test above would see it.
TEST(Bsdf_Parts, OtherWeightsWouldBeSeen) {
    const auto coat = CoatInterface::of(1.5);
    const Bsdf bsdf(Frame(), CoatedDiffuseBsdf(*coat, Rgb(1.0), 0, 0, 0));
    const double normal = bsdf.diffuse_weight({0, 0, 1});
    EXPECT_GT(std::abs(mean_weight({0, 0, 1}, [&](const Vec3& w) { return bsdf.diffuse_weight(w) / normal; }) - 1),
              0.04);
    const auto squared = [&](const Vec3& w) { return bsdf.diffuse_weight(w) * bsdf.diffuse_weight(w); };
    EXPECT_GT(std::abs(mean_weight({0, 0, 1}, squared) - 1), 0.01);
}

/// How far irradiance alone may lead astray, as docs/gather.md has it.
TEST(Bsdf_Parts, WeightsOfSmoothGlassAreBounded) {
    const auto coat = CoatInterface::of(1.5);
    const Bsdf bsdf(Frame(), CoatedDiffuseBsdf(*coat, Rgb(0.5), 0, 0, 0));
    for (double cosine = 0.01; cosine <= 1; cosine += 0.01) {
        const double w = bsdf.diffuse_weight(spherical(cosine, 0.3));
        EXPECT_LT(w, 1.058);
        if (cosine > 0.5) {
            EXPECT_GT(w, 0.999);
        }
        if (cosine > 0.3) {
            EXPECT_GT(w, 0.85);
        }
    }
}

/// That the finite part of what `of` makes of each case is drawn from as its pdf says.
template <class Of> void expect_samples_follow_pdf(const Of& of, std::uint64_t stream) {
    const int tests = static_cast<int>(bsdf_cases().size() * looks().size());
    for (const BsdfCase& c : bsdf_cases())
        for (const Vec3& from : looks()) {
            const Bsdf part = of(bsdf_of(c));
            if (!part.traits().finite) continue;
            SCOPED_TRACE(c.name + " from z = " + std::to_string(from.z));
            const auto sample = [&](SampleSource& source) -> std::optional<Vec3> {
                const auto s = part.sample(from, source);
                if (!s || is_specular(s->event)) return std::nullopt;
                return s->to;
            };
            const auto pdf = [&](const Vec3& to) { return part.pdf(from, to); };
            EXPECT_GT(direction_histogram(sample, pdf, stream++).p_value(), sidak_threshold(tests));
        }
}

TEST(Bsdf_GlossyPart, SampleFollowsPdf) {
    expect_samples_follow_pdf([](const Bsdf& bsdf) { return bsdf.glossy_part(); }, 1000);
}

TEST(Bsdf_GlossyPart, IsDrawnFromWithTheProbabilityThatIsSaid) {
    for (const BsdfCase& c : bsdf_cases())
        for (const Vec3& from : looks()) {
            const Bsdf bsdf = bsdf_of(c), rest = bsdf.glossy_part();
            if (!bsdf.traits().diffuse) continue;
            SCOPED_TRACE(c.name + " from z = " + std::to_string(from.z));
            const double p = bsdf.glossy_probability(from), finite = probability_of_finite(bsdf, from);
            for (const Vec3& to : looks()) {
                if (!(from.z * to.z > 0)) continue;
                const double cosine = std::abs(static_cast<double>(to.z)) * kInvPi;
                const double mixed = p * rest.pdf(from, to) + (1 - p) * cosine;
                EXPECT_NEAR(bsdf.pdf(from, to), finite * mixed, 1e-9 + 1e-6 * mixed);
            }
        }
}

/// What comes of light along `from`, in whatever direction it goes on, by samples of the finite part.
RunningStats albedo(const Bsdf& bsdf, const Vec3& from) {
    Rng rng(12, StreamPurpose::test, 0);
    RunningStats sum;
    for (int i = 0; i < 20000; ++i) {
        const auto s = bsdf.sample(from, rng);
        const bool lost = !s || is_specular(s->event);
        sum.add(lost ? 0 : bsdf.eval(s->to, from).y * std::abs(static_cast<double>(s->to.z)) / bsdf.pdf(from, s->to));
    }
    return sum;
}

void expect_as_bright(const WideLobe& wide, const Bsdf& narrow, const Vec3& from) {
    constexpr double kLoss = 0.03;
    const RunningStats before = albedo(narrow, from), after = albedo(wide.bsdf, from);
    const double noise = 4 * std::hypot(before.standard_error(), wide.scale * after.standard_error());
    EXPECT_NEAR(wide.scale * after.mean(), before.mean(), kLoss * before.mean() + noise);
}

/// What a rough metal sends below the surface by single reflections is made up for on average over directions; what a
/// coat loses, for each.
TEST(Bsdf_WideLobe, ReflectsAsMuch) {
    constexpr double kAlpha = 0.2;
    for (const BsdfCase& c : bsdf_cases())
        for (const Vec3& from : looks()) {
            const Bsdf rest = bsdf_of(c).glossy_part();
            const WideLobe wide = wide_lobe(rest, kAlpha, from);
            EXPECT_EQ(wide.bsdf.traits().delta, rest.traits().delta);
            if (!rest.traits().finite || !(std::abs(from.z) > 0.4f)) continue;
            SCOPED_TRACE(c.name + " from z = " + std::to_string(from.z));
            expect_as_bright(wide, rest, from);
        }
}

TEST(Bsdf_WideLobe, OfACoatReflectsAsMuchAtGrazingAngles) {
    const auto coat = CoatInterface::of(1.5);
    for (const double alpha : {0.01, 0.05, 0.15})
        for (const double cosine : {0.05, 0.1, 0.2, 0.4}) {
            SCOPED_TRACE(fmt::format("roughness {}, cosine {}", alpha, cosine));
            const Bsdf narrow = Bsdf(Frame(), CoatedDiffuseBsdf(*coat, Rgb(0.5), alpha, alpha, 0)).glossy_part();
            const Vec3 from = spherical(cosine, 0.3);
            expect_as_bright(wide_lobe(narrow, 0.2, from), narrow, from);
        }
}

TEST(Bsdf_Widened, IsNowhereBrighterThanItsRoughnessAllows) {
    const Bsdf narrow(Frame(), RoughConductorBsdf{{Rgb(1.5), Rgb(4.0)}, 0.01f, 0.4f});
    const Vec3 from = spherical(0.8, 0.3), mirrored(-from.x, -from.y, from.z);
    const Bsdf both(Frame(), RoughConductorBsdf{{Rgb(1.5), Rgb(4.0)}, 0.2f, 0.4f});
    EXPECT_NEAR(narrow.widened(0.2).eval(mirrored, from).y / both.eval(mirrored, from).y, 1, 0.05);
    EXPECT_EQ(narrow.widened(0.005).eval(mirrored, from), narrow.eval(mirrored, from));
    EXPECT_LT(both.eval(mirrored, from).y, 0.1 * narrow.eval(mirrored, from).y);
}

TEST(Bsdf_Widened, LeavesDiffusePartsAndSmoothLobes) {
    for (const BsdfCase& c : bsdf_cases()) {
        const Bsdf bsdf = bsdf_of(c), wide = bsdf.widened(0.3);
        const Vec3 from = spherical(0.7, 1);
        SCOPED_TRACE(c.name);
        EXPECT_EQ(wide.diffuse_reflectance(from), bsdf.diffuse_reflectance(from));
        for (const Event e : {Event::reflect, Event::transmit}) {
            const auto before = bsdf.delta(from, e), after = wide.delta(from, e);
            ASSERT_EQ(before.has_value(), after.has_value());
            if (before) {
                EXPECT_EQ(before->coefficient, after->coefficient);
            }
        }
    }
}

TEST(Bsdf_Widened, SampleFollowsPdf) {
    expect_samples_follow_pdf([](const Bsdf& bsdf) { return bsdf.glossy_part().widened(0.3); }, 5000);
}

} // namespace
} // namespace keyhole::test
