// What a surface scatters of photons that fell on another facet of a smooth mesh.
#include "gather/photon_reflection.h"

#include "photon_support.h"
#include "sampling/paths/measure.h"
#include "sampling/paths/walk.h"
#include "scene/material.h"
#include "scene/warp.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

using namespace photon_test;

Vec3 tilted(float degrees) {
    const float angle = degrees * static_cast<float>(kPi) / 180;
    return {std::sin(angle), 0, std::cos(angle)};
}

/// Rough metal, so that the BSDF isn't the same for all directions.
struct Facet {
    Vertex v;
    Vec3 to_eye = Vec3(-0.3f, 0.4f, 1).normalized();

    explicit Facet(float shading_degrees)
        : material_(make_conductor(constant_texture(Rgb(0.8)), constant_texture(0.6), constant_texture(0.6))) {
        SurfacePoint p;
        p.site = Site::surface;
        p.ng = {0, 0, 1};
        p.ns = tilted(shading_degrees);
        p.material = material_.get();
        v = make_vertex(p);
    }

  private:
    MaterialPtr material_;
};

constexpr int kDirections = 400'000;

/// Weights of photons that arrive as from an even sky on a facet so tilted: mean times pi is what they make of it.
RunningStats weights_of_photons(const Facet& facet, float degrees, Rng& rng) {
    const Frame frame(tilted(degrees));
    const PhotonReflection reflected(facet.v, facet.to_eye, 0);
    RunningStats weights;
    for (int i = 0; i < kDirections; ++i) {
        const auto [u0, u1] = rng.take<2>();
        const Photon photon({0, 0, 0}, frame.n, frame.to_world(cosine_hemisphere(u0, u1)), Rgb(1.0));
        weights.add(kPi * luminance(reflected(photon)));
    }
    return weights;
}

/// The same integral over the directions before that facet, by uniform ones: BSDF times the shading cosine.
RunningStats integral(const Facet& facet, float degrees, Rng& rng) {
    const Vec3 normal = tilted(degrees);
    RunningStats values;
    for (int i = 0; i < kDirections; ++i) {
        const auto [u0, u1] = rng.take<2>();
        const Vec3 w = facing(uniform_sphere(u0, u1), normal);
        const double cosine = std::abs(static_cast<double>(facet.v.bsdf.shading_normal().dot(w)));
        values.add(2 * kPi * luminance(facet.v.bsdf.finite(w, facet.to_eye).value) * cosine);
    }
    return values;
}

TEST(PhotonReflection, HasTheShadingCosineWhateverFacetThePhotonFellOn) {
    Rng rng = make_rng(1);
    const Facet facet(20);
    for (const float degrees : {0.0f, 20.0f, -15.0f}) {
        const RunningStats photons = weights_of_photons(facet, degrees, rng), sky = integral(facet, degrees, rng);
        EXPECT_NEAR(photons.mean(), sky.mean(),
                    4 * std::hypot(photons.standard_error(), sky.standard_error()) + 0.01 * sky.mean())
            << "on a facet at " << degrees << " degrees";
    }
}

/// A photon along the plane of the facet that is looked at, which fell on its own at 30 degrees.
TEST(PhotonReflection, MakesNoSpeckOfLightAlongTheFacet) {
    const Facet facet(20);
    const Vec3 w(0.99999f, 0, 1e-4f);
    const Photon photon({0, 0, 0}, tilted(60), w.normalized(), Rgb(1.0));
    const double f = luminance(facet.v.bsdf.finite(photon.direction(), facet.to_eye).value);
    ASSERT_GT(f, 0);
    EXPECT_LT(luminance(PhotonReflection(facet.v, facet.to_eye, 0)(photon)), f);
    EXPECT_GT(luminance(PhotonReflection(facet.v, facet.to_eye, 0)(photon)), 0.1 * f);
}

TEST(PhotonReflection, IsTheBsdfWithoutShadingNormals) {
    const Facet facet(0);
    const Photon photon({0, 0, 0}, {0, 0, 1}, Vec3(0.9f, 0, 0.1f).normalized(), Rgb(1.0));
    const double f = luminance(facet.v.bsdf.finite(photon.direction(), facet.to_eye).value);
    ASSERT_GT(f, 0);
    EXPECT_DOUBLE_EQ(luminance(PhotonReflection(facet.v, facet.to_eye, 0)(photon)), f);
}

} // namespace
} // namespace keyhole
