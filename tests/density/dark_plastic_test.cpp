// PrincipledBsdf over a black base: its gloss alone, beside Fresnel's equations and integrals over GGX's microfacets.
#include "scene/bsdf.h"
#include "scene/warp.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole::test {
namespace {

/// Fresnel's equations by the angles of incidence and refraction, for unpolarised light.
double fresnel(double cosine, double eta) {
    const double in = std::acos(std::min(1.0, cosine)), out = std::asin(std::sin(in) / eta);
    if (in < 1e-6) return std::pow((eta - 1) / (eta + 1), 2);
    const double s = std::sin(in - out) / std::sin(in + out), p = std::tan(in - out) / std::tan(in + out);
    return (s * s + p * p) / 2;
}

double index_of(double f0) { return (1 + std::sqrt(f0)) / (1 - std::sqrt(f0)); }

/// What GGX's facets of a roughness reflect in a direction of this cosine under a sky of radiance 1, once each.
class Facets {
  public:
    Facets(double alpha, double cosine) : alpha_(alpha), o_(std::sqrt(1 - cosine * cosine), 0, cosine) {}

    /// Sum of `value`(light, cosine to the facet, BRDF without a Fresnel term) times the light's cosine, by midpoints
    /// of equal shares of the facets' projected area.
    template <class Value> double integral(const Value& value) const {
        constexpr int kSlopes = 400, kAzimuths = 200;
        double sum = 0;
        for (int i = 0; i < kSlopes; ++i)
            for (int j = 0; j < kAzimuths; ++j) {
                const double s = (i + 0.5) / kSlopes, tan2 = alpha_ * alpha_ * s / (1 - s);
                const double z = 1 / std::sqrt(1 + tan2), r = std::sqrt(tan2) * z, phi = kPi * (j + 0.5) / kAzimuths;
                const LocalVec h(r * std::cos(phi), r * std::sin(phi), z);
                const double c = o_.dot(h);
                const LocalVec l = h * (2 * c) - o_;
                if (!(c > 0) || !(l.z > 0)) continue;
                const double density = std::pow(alpha_ / (z * z * (alpha_ * alpha_ + tan2)), 2) * kInvPi;
                const double brdf = density * masking(l) / (4 * l.z * o_.z);
                sum += value(l, c, brdf) * l.z * 4 * c / (density * z);
            }
        return sum / (kSlopes * kAzimuths);
    }

    const LocalVec& out() const { return o_; }

  private:
    double lambda(const LocalVec& w) const {
        const double slope = alpha_ * std::sqrt(1 - w.z * w.z) / w.z;
        return (std::sqrt(1 + slope * slope) - 1) / 2;
    }
    double masking(const LocalVec& l) const { return 1 / (1 + lambda(o_) + lambda(l)); }

    double alpha_;
    LocalVec o_;
};

PrincipledParameters black(double specular, double alpha) {
    PrincipledParameters p;
    p.base_color = Rgb(0.0);
    p.specular = specular;
    p.alpha_x = p.alpha_y = alpha;
    return p;
}

constexpr double kCosines[] = {1, 0.8, 0.5, 0.3, 0.15};

TEST(DarkPlastic_Gloss, ReflectsASkyAsFresnelsEquationsSay) {
    for (const double roughness : {0.1, 0.5, 0.8})
        for (const double specular : {0.02, 0.04, 0.08})
            for (const double cosine : kCosines) {
                const double alpha = roughness * roughness;
                const PrincipledBsdf model(black(specular, alpha));
                const Facets facets(alpha, cosine);
                const double exact = facets.integral(
                    [&](const LocalVec&, double c, double brdf) { return brdf * fresnel(c, index_of(specular)); });
                const double found = facets.integral(
                    [&](const LocalVec& l, double, double) { return model.eval(Vec3(l), Vec3(facets.out())).y; });
                EXPECT_NEAR(found / exact, 1, 0.01) << roughness << ' ' << specular << ' ' << cosine;
                EXPECT_NEAR(model.glossy_albedo(Vec3(facets.out())) / exact, 1, 0.02)
                    << "by the table, " << roughness << ' ' << specular << ' ' << cosine;
            }
}

TEST(DarkPlastic_Coat, ReflectsASkyAsFresnelsEquationsSay) {
    for (const double alpha : {0.01, 0.3})
        for (const double cosine : kCosines) {
            PrincipledParameters p = black(0, 0.25);
            p.coat = 1;
            p.coat_alpha = alpha;
            const PrincipledBsdf model(p);
            const Facets facets(alpha, cosine);
            const double exact =
                facets.integral([&](const LocalVec&, double c, double brdf) { return brdf * fresnel(c, 1.5); });
            const double found = facets.integral(
                [&](const LocalVec& l, double, double) { return model.eval(Vec3(l), Vec3(facets.out())).y; });
            EXPECT_NEAR(found / exact, 1, 0.01) << alpha << ' ' << cosine;
            EXPECT_NEAR(model.glossy_albedo(Vec3(facets.out())) / exact, 1, 0.02) << alpha << ' ' << cosine;
        }
}

double mirrored_share(const PrincipledParameters& p, double cosine) {
    const auto lobe = PrincipledBsdf(p).delta(spherical(cosine, 0.4), Event::reflect);
    return lobe ? lobe->coefficient.y : 0;
}

TEST(DarkPlastic_Smooth, ReflectsByFresnelsEquations) {
    PrincipledParameters coat = black(0, 0.25);
    coat.coat = 1;
    for (const double cosine : {1.0, 0.9, 0.7, 0.5, 0.3, 0.1, 0.03}) {
        for (const double specular : {0.002, 0.01, 0.04, 0.08, 0.2})
            EXPECT_NEAR(mirrored_share(black(specular, 0), cosine), fresnel(cosine, index_of(specular)), 1e-4)
                << specular << ' ' << cosine;
        EXPECT_NEAR(mirrored_share(coat, cosine), fresnel(cosine, 1.5), 1e-4) << cosine;
    }
}

/// Of an index above 3, which nothing clear has, as much along the normal as it says, and no less elsewhere.
TEST(DarkPlastic_Smooth, RisesTowardsTheHorizonForAnyIndex) {
    for (const double specular : {0.3, 0.6, 0.95, 1.0}) {
        double last = mirrored_share(black(specular, 0), 1);
        EXPECT_NEAR(last, specular, 1e-4);
        for (const double cosine : {0.9, 0.7, 0.5, 0.3, 0.1, 0.01}) {
            const double here = mirrored_share(black(specular, 0), cosine);
            EXPECT_GE(here, last - 1e-4);
            EXPECT_LE(here, 1);
            last = here;
        }
    }
}

/// Schlick's approximation is right within 2 % of metals, and differs from what dielectrics have.
TEST(DarkPlastic_Smooth, LeavesMetalToSchlick) {
    PrincipledParameters p = black(0.04, 0);
    p.base_color = Rgb(0.6);
    for (const double metallic : {0.25, 1.0})
        for (const double cosine : {0.8, 0.5, 0.1}) {
            p.metallic = metallic;
            const double metal = 0.6 + 0.4 * std::pow(1 - cosine, 5);
            EXPECT_NEAR(mirrored_share(p, cosine), (1 - metallic) * fresnel(cosine, 1.5) + metallic * metal, 1e-4);
        }
}

} // namespace
} // namespace keyhole::test
