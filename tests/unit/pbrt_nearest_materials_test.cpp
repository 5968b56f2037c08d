// Materials of pbrt's format that we have no model of: each becomes the nearest of ours, which is said.
#include "core/rng.h"
#include "scene/warp.h"
#include "support/pbrt_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

SurfacePoint upright() {
    SurfacePoint p;
    p.ng = p.ns = {0, 0, 1};
    return p;
}

/// What a material reflects of a white sky, seen from the direction of cosine `mu`.
Rgb reflectance(const Material& material, float mu) {
    constexpr int kSteps = 200;
    const Bsdf bsdf = material.bsdf(upright());
    const Vec3 eye(std::sqrt(1 - mu * mu), 0, mu);
    Rgb sum(0.0);
    for (int i = 0; i < kSteps * kSteps; ++i) { // cells of the same share of the hemisphere, by cosine
        const double square = (i / kSteps + 0.5) / kSteps, phi = 2 * kPi * (i % kSteps + 0.5) / kSteps;
        const double radius = std::sqrt(square);
        sum += bsdf.eval(Vec3(radius * std::cos(phi), radius * std::sin(phi), std::sqrt(1 - square)), eye);
    }
    sum *= kPi / (kSteps * kSteps);
    if (const auto mirror = bsdf.delta(eye, Event::reflect)) sum += mirror->coefficient;
    return sum;
}

std::string error_of(const std::string& world) { return pbrt_error(world + kPbrtTriangle); }

Rgb base_of(const std::string& parameters) {
    const PbrtScene s("Material \"hair\" " + parameters + " " + kPbrtTriangle);
    EXPECT_STREQ(s.shape().material->kind(), "principled");
    // What is left of a diffuse lobe far from the mirror's direction.
    const Vec3 w(0, 0, 1);
    return s.shape().material->bsdf(upright()).diffuse_reflectance(w) * kPi;
}

/// A direction about the unit vector `n`, by its cosine.
Vec3 cosine_about(const Vec3& n, Rng& rng) {
    const double u0 = rng.next(), u1 = rng.next();
    return Frame(n).to_world(cosine_hemisphere(u0, u1));
}

/// A walk of light, diffuse as it comes, into a half-space: the share that comes out again. `scatter(w)` is a direction
/// after one along `w`; -z is down.
template <class Scatter> double walked_albedo(double single_scattering_albedo, const Scatter& scatter) {
    Rng rng(4, StreamPurpose::test, 0);
    double sum = 0;
    constexpr int kWalks = 40'000;
    for (int i = 0; i < kWalks; ++i) {
        double depth = 0, weight = 1;
        Vec3 w = -cosine_about({0, 0, 1}, rng);
        for (;;) {
            depth -= static_cast<double>(w.z) * -std::log(1 - rng.next());
            if (depth < 0) sum += weight;
            if (depth < 0) break;
            weight *= single_scattering_albedo;
            if (weight < 0.05 && rng.next() > 0.5) break;
            if (weight < 0.05) weight *= 2;
            w = scatter(w, rng);
        }
    }
    return sum / kWalks;
}

void expect_ratio(const Rgb& a, const Rgb& b, double ratio, double tolerance = 1e-6) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], ratio, tolerance * ratio) << c;
}

TEST(PbrtHair, BecomesAPrincipledOneWhichIsSaid) {
    const PbrtScene s("Material \"hair\" \"float eumelanin\" 0.3 \"float alpha\" 2 \"float beta_m\" 0.25 " +
                      kPbrtTriangle);
    EXPECT_STREQ(s.shape().material->kind(), "principled");
    EXPECT_THAT(s.warnings, ElementsAre(HasSubstr("scene.pbrt:4:1: Material \"hair\": the material 'hair' becomes a "
                                                  "principled one of its colour")));
    const PbrtScene twice("Material \"hair\" " + kPbrtTriangle + "Material \"hair\" " + kPbrtTriangle);
    EXPECT_EQ(twice.warnings.size(), 1u);
}

TEST(PbrtHair, HasTheColourThatItsAbsorptionStandsFor) {
    const Rgb given = base_of("\"rgb reflectance\" [ 0.6 0.3 0.1 ]");
    EXPECT_GT(given.x, given.y);
    EXPECT_GT(given.y, given.z);
    expect_ratio(base_of("\"rgb color\" [ 0.6 0.3 0.1 ]"), given, 1);
    // Chiang et al. 2016, eq. 9: sigma_a = (ln C / D(beta_n))^2, D(0.3) = 5.8887...
    const double b = 0.3, d = 5.969 - 0.215 * b + 2.532 * b * b - 10.73 * b * b * b + 5.574 * std::pow(b, 4) +
                              0.245 * std::pow(b, 5);
    const auto sigma = [](double color, double steepness) { return std::pow(std::log(color) / steepness, 2); };
    expect_ratio(base_of(fmt::format("\"rgb sigma_a\" [ {} {} {} ]", sigma(0.6, d), sigma(0.3, d), sigma(0.1, d))),
                 given, 1, 1e-4);
    const double d1 = 5.969 - 0.215 + 2.532 - 10.73 + 5.574 + 0.245;
    expect_ratio(base_of(fmt::format("\"float beta_n\" 1 \"rgb sigma_a\" [ {} {} {} ]", sigma(0.6, d1), sigma(0.3, d1),
                                     sigma(0.1, d1))),
                 given, 1, 1e-4);
    expect_ratio(base_of("\"rgb sigma_a\" [ 2 2 2 ]"),
                 base_of(fmt::format("\"rgb reflectance\" [ {0} {0} {0} ]", std::exp(-d * std::sqrt(2)))), 1,
                 1e-4); // above 1
    // Melanin absorbs by its concentration.
    expect_ratio(base_of("\"float eumelanin\" 0.5 \"float pheomelanin\" 0.2"),
                 base_of("\"rgb sigma_a\" [ 0.2469 0.4285 0.895 ]"), 1, 1e-6);
    expect_ratio(base_of("\"float pheomelanin\" 1"), base_of("\"rgb sigma_a\" [ 0.187 0.4 1.05 ]"), 1);
    expect_ratio(base_of(""), base_of("\"float eumelanin\" 1.3"), 1);
}

/// Many diffuse hairs, each of which catches light where it faces it, reflect the colour as a whole.
TEST(PbrtHair, HasItsColourAsAWhole) {
    const auto off_a_ball = [](const Vec3& w, Rng& rng) { return cosine_about(cosine_about(-w, rng), rng); };
    // What the gloss takes of the diffuse part is not lost.
    const Rgb albedo = base_of("\"rgb reflectance\" [ 0.8 0.4 0.05 ]") / base_of("\"rgb reflectance\" [ 1 1 1 ]");
    EXPECT_NEAR(walked_albedo(albedo.x, off_a_ball), 0.8, 0.02);
    EXPECT_NEAR(walked_albedo(albedo.y, off_a_ball), 0.4, 0.02);
    EXPECT_NEAR(walked_albedo(albedo.z, off_a_ball), 0.05, 0.01);
    const Rgb ends = base_of("\"rgb reflectance\" [ 1 0 0 ]");
    EXPECT_NEAR(ends.y, 0, 1e-6);
}

TEST(PbrtHair, ReadsTextures) {
    const std::string texture = "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [ 0.2 0.5 0.7 ]\n"
                                "Texture \"m\" \"float\" \"constant\" \"float value\" 0.5\n";
    const auto base = [&](const std::string& parameters) {
        const PbrtScene s(texture + "Material \"hair\" " + parameters + " " + kPbrtTriangle);
        return s.shape().material->bsdf(upright()).diffuse_reflectance({0, 0, 1}) * kPi;
    };
    expect_ratio(base("\"texture sigma_a\" \"t\""), base_of("\"rgb sigma_a\" [ 0.2 0.5 0.7 ]"), 1);
    expect_ratio(base("\"texture eumelanin\" \"m\""), base_of("\"float eumelanin\" 0.5"), 1);
}

TEST(PbrtHair, IsAsGlossyAsItsRoughnessSays) {
    const auto peak = [](const std::string& parameters) {
        const PbrtScene s("Material \"hair\" \"rgb reflectance\" [ 0 0 0 ] " + parameters + " " + kPbrtTriangle);
        const Vec3 w = Vec3(0.5f, 0, 1).normalized(), mirrored(-w.x, 0, w.z);
        return s.shape().material->bsdf(upright()).eval(w, mirrored).x;
    };
    EXPECT_GT(peak("\"float beta_m\" 0.2"), 2 * peak("\"float beta_m\" 0.4"));
    EXPECT_GT(peak("\"float eta\" 1.8"), 1.5 * peak("")) << "1.55 is the default";
    EXPECT_NEAR(peak("\"float eta\" 1.55"), peak(""), 1e-9);
    EXPECT_THAT(error_of("Material \"hair\" \"float beta_m\" -1 "), HasSubstr("found -1 as 'beta_m'"));
}

/// An interface without any jump of the index lets everything through, but for what the coat's tables round.
TEST(PbrtSubsurface, ReflectsWhatItsMediumSendsBack) {
    const auto anywhere = [](const Vec3& /*w*/, Rng& rng) {
        const auto z = static_cast<float>(1 - 2 * rng.next()), phi = static_cast<float>(2 * kPi * rng.next());
        return Vec3(std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z);
    };
    for (const double albedo : {0.5, 0.9, 0.99}) {
        const PbrtScene s(fmt::format("Material \"subsurface\" \"float eta\" 1.0001 \"rgb sigma_s\" [ {0} {0} {0} ] "
                                      "\"rgb sigma_a\" [ {1} {1} {1} ] ",
                                      3 * albedo, 3 * (1 - albedo)) +
                          kPbrtTriangle);
        EXPECT_STREQ(s.shape().material->kind(), "coated_diffuse");
        EXPECT_NEAR(reflectance(*s.shape().material, 0.8f).x, walked_albedo(albedo, anywhere), 0.015) << albedo;
        EXPECT_THAT(s.warnings, ElementsAre(HasSubstr("scene.pbrt:4:1: Material \"subsurface\": the material "
                                                      "'subsurface' becomes a coateddiffuse")));
    }
}

TEST(PbrtSubsurface, ReadsAllThatPbrtDoes) {
    const auto seen = [](const std::string& parameters) {
        const PbrtScene s("Material \"subsurface\" " + parameters + " " + kPbrtTriangle);
        return reflectance(*s.shape().material, 0.8f);
    };
    const Rgb milk = seen("");
    expect_ratio(seen("\"string name\" \"Wholemilk\""), milk, 1);
    expect_ratio(seen("\"rgb sigma_s\" [ 2.55 3.21 3.77 ] \"rgb sigma_a\" [ 0.0011 0.0024 0.014 ] \"float scale\" 7"),
                 milk, 1);
    expect_ratio(seen("\"rgb sigma_s\" [ 5.1 6.42 7.54 ] \"rgb sigma_a\" [ 0.0011 0.0024 0.014 ] \"float g\" 0.5"),
                 milk, 1);
    const Rgb ketchup = seen("\"string name\" \"Ketchup\"");
    EXPECT_GT(ketchup.x, 2 * ketchup.y);
    expect_ratio(seen("\"string name\" \"Spectralon\""), Rgb(1.0), 1, 0.01);
    EXPECT_THAT(error_of("Material \"subsurface\" \"string name\" \"Wholemilc\" "),
                HasSubstr("did you mean 'Wholemilk'?"));
    EXPECT_THAT(error_of("Material \"subsurface\" \"rgb sigma_a\" [ 1 1 1 ] "),
                HasSubstr("found 'sigma_a' alone, expected 'sigma_a' and 'sigma_s'"));
    EXPECT_GT(seen("\"float eta\" 1.8 \"rgb reflectance\" [ 0 0 0 ]").x, 1.5 * seen("\"rgb reflectance\" [ 0 0 0 ]").x);
}

/// Of what gets through the interface the reflectance comes out: F + (1 - F) R.
TEST(PbrtSubsurface, ReflectancesAreThoseOfLightThatGotIn) {
    const double mu = 0.8, f = fresnel_dielectric(mu, 1.33).reflectance;
    for (const std::string kind : {"\"subsurface\" \"rgb reflectance\"", "\"kdsubsurface\" \"rgb Kd\""}) {
        const PbrtScene s("Material " + kind + " [ 0.7 0.2 1 ] \"rgb mfp\" [ 2 3 4 ] " + kPbrtTriangle);
        const Rgb seen = reflectance(*s.shape().material, static_cast<float>(mu));
        EXPECT_NEAR(seen.x, f + (1 - f) * 0.7, 0.01);
        EXPECT_NEAR(seen.y, f + (1 - f) * 0.2, 0.01);
        EXPECT_NEAR(seen.z, 1, 0.01);
        EXPECT_EQ(s.warnings.size(), 1u);
    }
}

TEST(PbrtMeasured, BecomesGreyWhichIsSaidOfEachFile) {
    const std::string measured = "Material \"measured\" \"string filename\" ";
    const PbrtScene s(measured + "\"silk.bsdf\" " + kPbrtTriangle + measured + "\"silk.bsdf\" " + kPbrtTriangle +
                      measured + "\"tin.bsdf\" " + kPbrtTriangle +
                      "Material \"fourier\" \"string bsdffile\" \"a.bsdf\" " + kPbrtTriangle);
    EXPECT_STREQ(s.shape(2).material->kind(), "principled");
    EXPECT_NEAR(reflectance(*s.shape().material, 0.8f).x, 0.5, 0.05);
    EXPECT_THAT(s.warnings,
                ElementsAre(HasSubstr("scene.pbrt:4:1: Material \"measured\": the material 'measured' becomes "
                                      "a principled one of reflectance 0.5 and roughness 0.5: the measured "
                                      "reflection in 'silk.bsdf' is not read"),
                            HasSubstr("tin.bsdf"), HasSubstr("a.bsdf")));
}

} // namespace
} // namespace keyhole
