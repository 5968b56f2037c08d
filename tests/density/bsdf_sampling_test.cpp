// What sample() draws, pdf() knows.
#include "bsdf_cases.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole::test {
namespace {

void for_all(const std::function<void(const BsdfCase&, const Bsdf&, const Vec3&, std::uint64_t)>& check) {
    std::uint64_t stream = 0;
    for (const BsdfCase& c : bsdf_cases()) {
        for (const Vec3& from : looks()) {
            SCOPED_TRACE(c.name + " from z = " + std::to_string(from.z));
            check(c, bsdf_of(c), from, stream++);
        }
    }
}

int number_of_tests() { return static_cast<int>(bsdf_cases().size() * looks().size()); }

double delta_probability(const Bsdf& bsdf, const Vec3& from) {
    double p = 0;
    for (const Event e : {Event::reflect, Event::transmit})
        if (const auto d = bsdf.delta(from, e)) p += d->probability;
    return p;
}

TEST(Bsdf_SampleFollowsPdf, AllModels) {
    for_all([](const BsdfCase&, const Bsdf& bsdf, const Vec3& from, std::uint64_t stream) {
        if (!bsdf.traits().finite) return;
        const auto sample = [&](SampleSource& source) -> std::optional<Vec3> {
            const auto s = bsdf.sample(from, source);
            if (!s || is_specular(s->event)) return std::nullopt;
            return s->to;
        };
        const Histogram h = direction_histogram(
            sample, [&](const Vec3& to) { return bsdf.pdf(from, to); }, stream);
        EXPECT_GT(h.p_value(), sidak_threshold(number_of_tests()));
    });
}

TEST(Bsdf_PdfIntegratesToOne, WhereNothingIsAbsorbed) {
    for_all([](const BsdfCase& c, const Bsdf& bsdf, const Vec3& from, std::uint64_t) {
        const double finite = integrate_sphere([&](const Vec3& to) { return bsdf.pdf(from, to); });
        const double all = finite + delta_probability(bsdf, from);
        EXPECT_LT(all, 1 + 1e-3);
        if (c.draws_always) {
            EXPECT_NEAR(all, 1, 1e-3);
        }
    });
}

TEST(Bsdf_DeltaProbabilities, AreThoseOfSample) {
    for_all([](const BsdfCase&, const Bsdf& bsdf, const Vec3& from, std::uint64_t stream) {
        if (!bsdf.traits().delta) return;
        constexpr int kSamples = 20000;
        int reflected = 0, transmitted = 0;
        Rng rng(3, StreamPurpose::test, stream);
        for (int i = 0; i < kSamples; ++i) {
            const auto s = bsdf.sample(from, rng);
            if (!s || !is_specular(s->event)) continue;
            ++(s->event == Event::reflect ? reflected : transmitted);
            const auto d = bsdf.delta(from, s->event);
            ASSERT_TRUE(d);
            EXPECT_LT((d->to - s->to).length(), 1e-6);
            EXPECT_DOUBLE_EQ(d->probability, s->pdf);
        }
        const auto expect_share = [&](int count, Event e) {
            const auto d = bsdf.delta(from, e);
            const double p = d ? d->probability : 0;
            EXPECT_NEAR(count, kSamples * p, 5 * std::sqrt(kSamples * p * (1 - p)) + 1e-6);
        };
        expect_share(reflected, Event::reflect);
        expect_share(transmitted, Event::transmit);
    });
}

/// With the radiance scaling of light from side i to side o taken out, so that white means 1.
Rgb scattered(const BsdfCase& c, const Bsdf& bsdf, const Vec3& to_light, const Vec3& to_eye) {
    const double ratio = index_on_side(c, to_light) / index_on_side(c, to_eye);
    return bsdf.eval(to_light, to_eye) * (ratio * ratio);
}

TEST(Bsdf_SamplesWeigh, EvalCosineOverPdfAndNoMoreThanTheBound) {
    for_all([](const BsdfCase& c, const Bsdf& bsdf, const Vec3& from, std::uint64_t stream) {
        Rng rng(5, StreamPurpose::test, stream);
        for (int i = 0; i < 5000; ++i) {
            const auto s = bsdf.sample(from, rng);
            if (!s) {
                EXPECT_FALSE(c.draws_always);
                continue;
            }
            EXPECT_NEAR(s->to.length(), 1, 1e-5);
            if (is_specular(s->event)) continue;
            EXPECT_NEAR(s->pdf, bsdf.pdf(from, s->to), 1e-4 * s->pdf);
            const Rgb weight = scattered(c, bsdf, s->to, from) * (std::abs(s->to.z) / s->pdf);
            ASSERT_TRUE(is_finite(weight));
            ASSERT_GE(std::min({weight.x, weight.y, weight.z}), 0);
            ASSERT_LE(std::max({weight.x, weight.y, weight.z}), c.most_weight);
        }
    });
}

} // namespace
} // namespace keyhole::test
