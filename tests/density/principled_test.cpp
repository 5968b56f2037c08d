// PrincipledBsdf: what it reflects of a sky that is white all around.
#include "scene/bsdf.h"
#include "scene/bsdfs/fresnel.h"
#include "scene/warp.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole::test {
namespace {

/// Green light seen along a direction of this cosine and azimuth under a sky of radiance 1.
double albedo(const PrincipledParameters& p, double cosine, double azimuth = 0.4) {
    const PrincipledBsdf model(p);
    const Vec3 to_eye = spherical(cosine, azimuth);
    double sum =
        integrate_sphere([&](const Vec3& w) { return model.eval(w, to_eye).y * std::abs(static_cast<double>(w.z)); });
    if (const auto d = model.delta(to_eye, Event::reflect)) sum += d->coefficient.y;
    return sum;
}

PrincipledParameters white(double metallic, double alpha_x, double alpha_y) {
    PrincipledParameters p;
    p.base_color = Rgb(1.0);
    p.metallic = metallic;
    p.alpha_x = alpha_x;
    p.alpha_y = alpha_y;
    return p;
}

TEST(Principled_WhiteFurnace, LosesLessThanTwoPercentOfWhite) {
    for (const double metallic : {0.0, 0.5, 1.0})
        for (const double alpha : {0.0, 0.02, 0.1, 0.25, 0.5, 1.0})
            for (const double cosine : {1.0, 0.7, 0.3, 0.1})
                EXPECT_NEAR(albedo(white(metallic, alpha, alpha), cosine), 1, 0.02)
                    << "metallic " << metallic << ", alpha " << alpha << ", cosine " << cosine;
}

TEST(Principled_WhiteFurnace, OfAnisotropicMetalLosesLittle) {
    for (const double azimuth : {0.0, 0.8, kPi / 2})
        for (const double cosine : {1.0, 0.6, 0.25})
            EXPECT_NEAR(albedo(white(1, 0.4, 0.1), cosine, azimuth), 1, 0.04) << azimuth << ' ' << cosine;
}

TEST(Principled_WhiteFurnace, MakesNoLightWithCoatAndSheen) {
    for (const double metallic : {0.0, 1.0})
        for (const double coat : {0.0, 0.25, 1.0})
            for (const double coat_alpha : {0.0, 0.3})
                for (const double sheen : {0.0, 1.0})
                    for (const double cosine : {1.0, 0.5, 0.1}) {
                        PrincipledParameters p = white(metallic, 0.25, 0.25);
                        p.coat = coat;
                        p.coat_alpha = coat_alpha;
                        p.sheen = sheen;
                        const double seen = albedo(p, cosine);
                        EXPECT_LT(seen, 1.01) << metallic << coat << coat_alpha << sheen << cosine;
                        EXPECT_GT(seen, 0.95) << metallic << coat << coat_alpha << sheen << cosine;
                    }
}

TEST(Principled_BaseColor, IsWhatIsSeenOfTheBase) {
    PrincipledParameters p = white(0, 0.25, 0.25);
    for (const double rho : {0.1, 0.5, 0.8}) {
        p.base_color = Rgb(0.0);
        const double gloss = albedo(p, 0.8);
        p.base_color = Rgb(rho);
        EXPECT_NEAR(albedo(p, 0.8) - gloss, rho * (1 - gloss), 0.005) << rho;
    }
}

TEST(Principled_Specular, ZeroLeavesALambertianSurface) {
    PrincipledParameters p = white(0, 0.25, 0.25);
    p.base_color = Rgb(0.6);
    p.specular = 0;
    const PrincipledBsdf model(p);
    for (const double cosine : {0.9, 0.2})
        EXPECT_NEAR(model.eval(spherical(cosine, 0), spherical(0.5, 2)).x, 0.6 * kInvPi, 1e-4);
}

TEST(Principled_Tints, ColourWhatTheySay) {
    PrincipledParameters p = white(0, 0, 0);
    p.base_color = Rgb(0.5, 0.25, 0.0);
    p.specular = 0.05;
    const auto reflected = [&] { return PrincipledBsdf(p).delta(Vec3(0, 0, 1), Event::reflect)->coefficient; };
    EXPECT_NEAR(reflected().z, 0.05, 1e-4);
    p.specular_tint = 1;
    EXPECT_NEAR(reflected().x, 0.05, 1e-4);
    EXPECT_NEAR(reflected().y, 0.025, 1e-4);
    EXPECT_NEAR(reflected().z, 0, 1e-4);
    p.metallic = 1;
    EXPECT_NEAR(reflected().y, 0.25, 1e-4);
}

TEST(GlossyAlbedo_Table, AgreesWithIntegrals) {
    for (const double alpha : {0.05, 0.33, 0.8})
        for (const double cosine : {0.95, 0.42, 0.12}) {
            const Vec3 to_eye = spherical(cosine, 0);
            const LocalVec o(to_eye);
            const Ggx ggx{alpha, alpha};
            const auto albedo = [&](const auto& reflectance) {
                return integrate_sphere([&](const Vec3& w) {
                    if (!(w.z > 0)) return 0.0;
                    const LocalVec i(w), h = half_vector(i, o);
                    return ggx.reflection(i, o, h) * w.z * reflectance(o.dot(h));
                });
            };
            const double whole = albedo([](double) { return 1.0; }), schlick = albedo(schlick_weight);
            for (const double root : {0.0, 0.13, 0.2, 0.48, 0.9}) {
                const GgxAlbedo at = ggx_albedo(cosine, alpha, root);
                EXPECT_NEAR(at.whole, whole, 4e-3);
                EXPECT_NEAR(at.schlick, schlick, 4e-3);
                EXPECT_NEAR(at.dielectric, albedo(DielectricWeight(root)), 4e-3) << root;
            }
        }
    for (const double cosine : {0.95, 0.42, 0.12}) {
        const Vec3 o = spherical(cosine, 0);
        const auto lobe = [&](const Vec3& w) {
            return w.z > 0 ? w.z * schlick_weight(std::sqrt(std::max(0.0, (1.0 + o.dot(w)) / 2))) : 0.0;
        };
        EXPECT_NEAR(sheen_albedo(cosine), integrate_sphere(lobe), 2e-3);
    }
}

} // namespace
} // namespace keyhole::test
