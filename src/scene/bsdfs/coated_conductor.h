// Lacquer: a dielectric coat over a metal.
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

} // namespace keyhole
