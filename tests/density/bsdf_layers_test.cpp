// Coated models beside what they stand for: light walking between the interface and the base until it is out.
#include "scene/bsdf.h"
#include "scene/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

constexpr double kEta = 1.5;
constexpr int kBins = 6;

/// Light that leaves, by bins of equal projected solid angle; and all of it.
struct Outgoing {
    std::array<double, kBins> bins{};
    double all = 0;

    void add(double cosine, double weight) {
        bins[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(cosine * cosine * kBins)))] += weight;
        all += weight;
    }
};

double abs_cosine(const Vec3& w) { return std::abs(static_cast<double>(w.z)); }

/// Walks of power 1 that come along `from`: light travels with the walk, so that each step weighs the share of power
/// that goes on.
template <class Interface, class Base>
Outgoing walk(const Interface& interface, const Base& base, const Vec3& from, double thickness, int walks) {
    Outgoing out;
    Rng rng(2, StreamPurpose::test, 0);
    const auto draw = [&](const auto& model, const Vec3& back, double& weight) -> std::optional<Vec3> {
        const double u0 = rng.next(), u1 = rng.next(), u2 = rng.next();
        const auto s = model.sample(back, u0, u1, u2);
        if (!s) return std::nullopt;
        if (is_specular(s->event)) {
            weight *= model.delta(back, s->event)->coefficient.x / s->pdf;
        } else {
            weight *= model.eval(back, s->to).x * abs_cosine(s->to) / s->pdf;
        }
        return s->to;
    };
    for (int i = 0; i < walks; ++i) {
        double weight = 1;
        Vec3 back = from;
        for (int depth = 0; depth < 100; ++depth) {
            const auto w = draw(interface, back, weight);
            if (!w) break;
            if (w->z > 0) {
                out.add(w->z, weight / walks);
                break;
            }
            weight *= std::exp(-thickness / abs_cosine(*w));
            const auto up = draw(base, -*w, weight);
            if (!up || !(weight > 1e-6)) break;
            weight *= std::exp(-thickness / abs_cosine(*up));
            back = -*up;
        }
    }
    return out;
}

/// The same of a model by its samples.
template <class Model> Outgoing scatter_once(const Model& model, const Vec3& from, int samples) {
    Outgoing out;
    Rng rng(4, StreamPurpose::test, 0);
    for (int i = 0; i < samples; ++i) {
        const double u0 = rng.next(), u1 = rng.next(), u2 = rng.next();
        const auto s = model.sample(from, u0, u1, u2);
        if (!s) continue;
        const double weight = is_specular(s->event) ? model.delta(from, s->event)->coefficient.x / s->pdf
                                                    : model.eval(from, s->to).x * abs_cosine(s->to) / s->pdf;
        out.add(s->to.z, weight / samples);
    }
    return out;
}

/// Compares totals and bins; the latter within a share of the mean bin.
void expect_alike(const Outgoing& model, const Outgoing& truth, double total_error, double bin_error) {
    EXPECT_NEAR(model.all / truth.all, 1, total_error);
    for (std::size_t i = 0; i < kBins; ++i)
        EXPECT_NEAR(model.bins[i], truth.bins[i], bin_error * truth.all / kBins) << "bin " << i;
}

Vec3 look(double cosine) { return spherical(cosine, 0.4); }

class CoatAt : public testing::TestWithParam<double> {};

TEST_P(CoatAt, SmoothOverDiffuseIsExact) {
    const CoatInterface coat(kEta);
    for (const double rho : {0.2, 0.8}) {
        for (const double thickness : {0.0, 0.01, 0.3}) {
            SCOPED_TRACE(testing::Message() << "reflectance " << rho << ", thickness " << thickness);
            const CoatedDiffuseBsdf model(coat, Rgb(rho), 0, 0, thickness);
            expect_alike(scatter_once(model, look(GetParam()), 200'000),
                         walk(GlassBsdf{kEta}, DiffuseBsdf{Rgb(rho)}, look(GetParam()), thickness, 400'000), 0.01,
                         0.04);
        }
    }
}

TEST_P(CoatAt, RoughOverDiffuseIsNearlyExact) {
    const CoatInterface coat(kEta);
    for (const float alpha : {0.1f, 0.3f, 0.6f}) {
        SCOPED_TRACE(testing::Message() << "alpha " << alpha);
        const CoatedDiffuseBsdf model(coat, Rgb(0.5), alpha, alpha, 0.01);
        expect_alike(
            scatter_once(model, look(GetParam()), 200'000),
            walk(RoughDielectricBsdf{kEta, alpha, alpha}, DiffuseBsdf{Rgb(0.5)}, look(GetParam()), 0.01, 400'000), 0.02,
            0.05);
    }
}

const ComplexIndex kMetal{Rgb(0.2), Rgb(3.9)};
const ComplexIndex kMetalInCoat{Rgb(0.2 / kEta), Rgb(3.9 / kEta)};

TEST_P(CoatAt, SmoothOverSmoothConductorIsExact) {
    const CoatInterface coat(kEta);
    const CoatedConductorBsdf model(coat, {0, 0}, 0.05, kMetal, {0, 0});
    expect_alike(scatter_once(model, look(GetParam()), 1000),
                 walk(GlassBsdf{kEta}, ConductorBsdf{kMetalInCoat}, look(GetParam()), 0.05, 400'000), 0.005, 0.01);
}

TEST_P(CoatAt, SmoothOverRoughConductorLosesLessThanAQuarter) {
    const CoatInterface coat(kEta);
    for (const float alpha : {0.05f, 0.15f}) {
        SCOPED_TRACE(testing::Message() << "alpha " << alpha);
        const CoatedConductorBsdf model(coat, {0, 0}, 0.01, kMetal, {alpha, alpha});
        const double share =
            scatter_once(model, look(GetParam()), 200'000).all /
            walk(GlassBsdf{kEta}, RoughConductorBsdf{kMetalInCoat, alpha, alpha}, look(GetParam()), 0.01, 400'000).all;
        EXPECT_GT(share, 0.77);
        EXPECT_LT(share, 1.01);
    }
}

TEST_P(CoatAt, RoughOverSmoothConductorIsNear) {
    const CoatInterface coat(kEta);
    for (const float alpha : {0.05f, 0.15f}) {
        SCOPED_TRACE(testing::Message() << "alpha " << alpha);
        const CoatedConductorBsdf model(coat, {alpha, alpha}, 0.01, kMetal, {0, 0});
        const double share =
            scatter_once(model, look(GetParam()), 200'000).all /
            walk(RoughDielectricBsdf{kEta, alpha, alpha}, ConductorBsdf{kMetalInCoat}, look(GetParam()), 0.01, 400'000)
                .all;
        EXPECT_NEAR(share, 1, 0.12);
    }
}

INSTANTIATE_TEST_SUITE_P(Angles, CoatAt, testing::Values(0.95, 0.6, 0.25));

} // namespace
} // namespace keyhole
