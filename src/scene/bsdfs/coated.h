// A dielectric coat over a metal, as lacquer, or over a Lambertian base, as varnish.
#pragma once

#include "scene/bsdfs/coat.h"
#include "scene/bsdfs/fresnel.h"
#include "scene/scattering.h"

namespace keyhole {

/// Light reflects at the coat, or refracts into it, meets the metal, and comes out:
///
///     f = f_coat + T(i) T(o) f_metal(i', o') / (eta^2 (1 - F B))
///
/// with directions i', o' inside, T what the coat lets through one way, F the metal's reflectance and B the coat's
/// reflectance from below. Exact where both are smooth. Approximate elsewhere: B is the smaller one of the two
/// directions', which keeps energy from being made; light that a rough metal throws past the critical angle is lost (up
/// to a fifth of all); and a rough coat refracts as a smooth one over a metal that is rougher by what the coat adds to
/// the slopes (within 12 % of a walk through the layers). Reciprocal. The same from both sides.
class CoatedConductorBsdf {
  public:
    /// Roughness along the tangent and across it; both 0: smooth.
    struct Roughness {
        float x, y;
        bool smooth() const { return x == 0; }
    };

    /// `metal` is relative to the medium outside the coat. `interface` must outlive the BSDF.
    CoatedConductorBsdf(const CoatInterface& interface, Roughness coat, double thickness, const ComplexIndex& metal,
                        Roughness base);

    BsdfTraits traits() const {
        return {.finite = !base_.smooth(), .delta = coat_.smooth(), .glossy = !base_.smooth()};
    }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const;
    double pdf(const Vec3& from, const Vec3& to) const;
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const;
    Rgb albedo(const Vec3& to_eye) const;

  private:
    double alpha() const { return std::sqrt(coat_.x * coat_.y); }
    double coat_probability(double cosine) const;
    LocalVec refract(const LocalVec& w) const;
    std::optional<LocalVec> sample_base(const LocalVec& w, double u0, double u1) const;
    Rgb eval_base(const LocalVec& i, const LocalVec& o) const;

    const CoatInterface* interface_;
    ComplexIndex metal_; // relative to the coat
    Roughness coat_, base_;
    float thickness_;
};

/// Light reflects at the coat, or goes in, scatters from the base any number of times with reflections from below the
/// coat in between, and comes out:
///
///     f = f_coat + T(i) T(o) rho / (pi eta^2 (1 - rho R))
///
/// T is what the coat lets through one way and R what it sends back of diffuse light from below (Saunderson 1942;
/// Weidlich and Wilkie 2007). Reciprocal; exact but for the way through an absorbing rough coat. Where the coat is
/// smooth its reflection is a delta lobe. The same from both sides.
class CoatedDiffuseBsdf {
  public:
    /// `alpha_x` and `alpha_y` are both 0 for a smooth coat. `interface` must outlive the BSDF.
    CoatedDiffuseBsdf(const CoatInterface& interface, const Rgb& reflectance, double alpha_x, double alpha_y,
                      double thickness);

    BsdfTraits traits() const {
        const bool diffuse = base_.x + base_.y + base_.z > 0;
        return {.finite = diffuse || !smooth(), .delta = smooth(), .diffuse = diffuse, .glossy = !smooth()};
    }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const;
    double pdf(const Vec3& from, const Vec3& to) const;
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const;
    Rgb albedo(const Vec3& to_eye) const;

    /// What has been through the coat follows from irradiance E alone, but for the weight of each direction in that:
    /// T(o) <T> rho / (pi eta^2 (1 - rho R)) times E, and the weight is T(i) / <T>, with <T> the mean of T over the
    /// hemisphere, by cosine.
    Rgb diffuse_reflectance(const Vec3& to_eye) const;
    double diffuse_weight(const Vec3& to_light) const;
    /// The coat's reflection.
    CoatedDiffuseBsdf glossy_part() const;
    CoatedDiffuseBsdf widened(double alpha) const;
    double glossy_albedo(const Vec3& from) const;
    double glossy_probability(const Vec3& from) const;

  private:
    bool smooth() const { return alpha_x_ == 0; }
    double alpha() const { return std::sqrt(alpha_x_ * alpha_y_); }
    double through(double cosine) const;
    double mean_through() const { return interface_->mean_through(alpha(), thickness_); }
    double coat_probability(double cosine) const;

    const CoatInterface* interface_;
    StoredRgb base_;    // rho / (pi eta^2 (1 - rho R))
    float base_albedo_; // of light that is in already, until it leaves; mean of the primaries
    float alpha_x_, alpha_y_, thickness_;
};

} // namespace keyhole
