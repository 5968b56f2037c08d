#include "scene/bsdfs/coated.h"

#include "scene/bsdfs/fresnel.h"
#include "scene/warp.h"

#include <algorithm>

namespace keyhole {
namespace {

/// A microfacet of slope s turns refracted light by (1 - 1/eta) s inside, on the way in and again on the way out; one
/// of the metal by 2 s, once. Variances of independent slopes add.
float widened(float base, float coat, double eta) {
    const double turn = 1 - 1 / eta;
    return static_cast<float>(std::sqrt(base * base + turn * turn * coat * coat / 2));
}

} // namespace

CoatedConductorBsdf::CoatedConductorBsdf(const CoatInterface& interface, Roughness coat, double thickness,
                                         const ComplexIndex& metal, Roughness base)
    : interface_(&interface), coat_(coat), base_(base), thickness_(static_cast<float>(thickness)) {
    const double eta = interface.eta();
    metal_ = {Rgb(metal.eta) / eta, Rgb(metal.k) / eta};
    if (coat.smooth()) return;
    // Never smooth under a rough coat: even where the coat adds nothing, because its index is 1.
    const auto least = static_cast<float>(kSmoothAlpha);
    base_ = {std::max(least, widened(base.x, coat.x, eta)), std::max(least, widened(base.y, coat.y, eta))};
}

LocalVec CoatedConductorBsdf::refract(const LocalVec& w) const {
    return {w.x / interface_->eta(), w.y / interface_->eta(), interface_->refracted(w.z)};
}

double CoatedConductorBsdf::coat_probability(double cosine) const {
    const double coat = interface_->reflectance(cosine, alpha()), in = interface_->transmittance(cosine, alpha());
    const Rgb metal = fresnel_conductor(interface_->refracted(cosine), metal_);
    const double way = interface_->attenuation(cosine, thickness_);
    const double base = in * in * way * way * (metal.x + metal.y + metal.z) / 3;
    return coat + base > 0 ? coat / (coat + base) : 1.0;
}

Rgb CoatedConductorBsdf::eval_base(const LocalVec& i, const LocalVec& o) const {
    const LocalVec in = refract(i), out = refract(o);
    if (!(in.z > 0) || !(out.z > 0)) return Rgb(0.0);
    const LocalVec h = half_vector(in, out);
    const double below_i = interface_->reflectance(i.z, alpha()), below_o = interface_->reflectance(o.z, alpha());
    const double through = interface_->transmittance(i.z, alpha()) * interface_->transmittance(o.z, alpha());
    const double ways = interface_->attenuation(i.z, thickness_) * interface_->attenuation(o.z, thickness_);
    const double below = std::min(below_i, below_o) * ways;
    const double lobe =
        through * ways * Ggx{base_.x, base_.y}.reflection(in, out, h) / (interface_->eta() * interface_->eta());
    Rgb f = fresnel_conductor(out.dot(h), metal_);
    for (int k = 0; k < 3; ++k) f[k] *= lobe / (1 - f[k] * below);
    return f;
}

Rgb CoatedConductorBsdf::eval(const Vec3& to_light, const Vec3& to_eye) const {
    if (!(to_light.z * to_eye.z > 0) || base_.smooth()) return Rgb(0.0);
    const LocalVec i = upper(to_light), o = upper(to_eye);
    Rgb f = eval_base(i, o);
    if (!coat_.smooth()) {
        const LocalVec h = half_vector(i, o);
        f += Rgb(fresnel_dielectric(o.dot(h), interface_->eta()).reflectance *
                 Ggx{coat_.x, coat_.y}.reflection(i, o, h));
    }
    return f;
}

double CoatedConductorBsdf::pdf(const Vec3& from, const Vec3& to) const {
    if (!(from.z * to.z > 0) || base_.smooth()) return 0;
    const LocalVec w = upper(from), v = upper(to), in = refract(w), out = refract(v);
    const double coat = coat_probability(w.z);
    double p = 0;
    if (in.z > 0 && out.z > 0) {
        const double jacobian = v.z / (interface_->eta() * interface_->eta() * out.z);
        p = (1 - coat) * Ggx{base_.x, base_.y}.reflection_pdf(in, out) * jacobian;
    }
    return coat_.smooth() ? p : p + coat * Ggx{coat_.x, coat_.y}.reflection_pdf(w, v);
}

std::optional<LocalVec> CoatedConductorBsdf::sample_base(const LocalVec& w, double u0, double u1) const {
    const LocalVec in = refract(w);
    if (!(in.z > 0)) return std::nullopt;
    const auto out = Ggx{base_.x, base_.y}.sample_reflection(in, u0, u1);
    if (!out) return std::nullopt;
    const double eta = interface_->eta(), z2 = 1 - eta * eta * (1 - out->z * out->z);
    if (!(z2 > 0)) return std::nullopt;
    return LocalVec(out->x * eta, out->y * eta, std::sqrt(z2));
}

std::optional<BsdfSample> CoatedConductorBsdf::sample(const Vec3& from, double u0, double u1, double u2) const {
    if (from.z == 0) return std::nullopt;
    const LocalVec w = upper(from);
    if (base_.smooth()) return BsdfSample{mirrored(from), Event::reflect, 1.0};
    const double coat = coat_probability(w.z);
    if (u2 < coat && coat_.smooth()) return BsdfSample{mirrored(from), Event::reflect, coat};
    const auto up = u2 < coat ? Ggx{coat_.x, coat_.y}.sample_reflection(w, u0, u1) : sample_base(w, u0, u1);
    if (!up) return std::nullopt;
    const Vec3 to = on_side_of(from, *up);
    return finite_sample(to, pdf(from, to));
}

std::optional<DeltaScatter> CoatedConductorBsdf::delta(const Vec3& from, Event event) const {
    if (event != Event::reflect || !coat_.smooth()) return std::nullopt;
    const double cosine = std::abs(static_cast<double>(from.z)), coat = interface_->reflectance(cosine, 0);
    const double probability = base_.smooth() ? 1.0 : coat_probability(cosine);
    if (!(probability > 0)) return std::nullopt;
    Rgb coefficient(coat);
    if (base_.smooth()) {
        const double way = interface_->attenuation(cosine, thickness_), ways = way * way;
        const Rgb metal = fresnel_conductor(interface_->refracted(cosine), metal_);
        for (int k = 0; k < 3; ++k)
            coefficient[k] += (1 - coat) * (1 - coat) * ways * metal[k] / (1 - metal[k] * coat * ways);
    }
    return DeltaScatter{mirrored(from), coefficient, probability, 1.0};
}

Rgb CoatedConductorBsdf::albedo(const Vec3& to_eye) const {
    if (base_.smooth()) return Rgb(0.0);
    const LocalVec o = upper(to_eye), in = refract(o);
    const double eta = interface_->eta();
    const Ggx ggx{base_.x, base_.y};
    const Rgb base = mean_over_facets(ggx, in, [&](const LocalVec& h) {
        const LocalVec below = h * (2 * in.dot(h)) - in;
        const double z2 = 1 - eta * eta * (1 - below.z * below.z);
        if (!(below.z > 0) || !(z2 > 0)) return Rgb(0.0);
        const LocalVec i(below.x * eta, below.y * eta, std::sqrt(z2));
        return eval_base(i, o) * (eta * eta * below.z / ggx.reflection_pdf(in, below));
    });
    return coat_.smooth() ? base : base + Rgb(interface_->reflectance(o.z, alpha()));
}

CoatedDiffuseBsdf::CoatedDiffuseBsdf(const CoatInterface& interface, const Rgb& reflectance, double alpha_x,
                                     double alpha_y, double thickness)
    : interface_(&interface), alpha_x_(static_cast<float>(alpha_x)), alpha_y_(static_cast<float>(alpha_y)),
      thickness_(static_cast<float>(thickness)) {
    const double back = interface.internal_reflectance(alpha(), thickness), eta2 = interface.eta() * interface.eta();
    Rgb base;
    for (int k = 0; k < 3; ++k) base[k] = reflectance[k] * kInvPi / (eta2 * (1 - reflectance[k] * back));
    base_ = base;
    const double out = eta2 * (1 - interface.internal_reflectance(alpha(), 0));
    base_albedo_ = static_cast<float>((base_.x + base_.y + base_.z) / 3 * kPi * out);
}

double CoatedDiffuseBsdf::through(double cosine) const {
    return interface_->transmittance(cosine, alpha()) * interface_->attenuation(cosine, thickness_);
}

/// In proportion to the light that each lobe reflects, nearly.
double CoatedDiffuseBsdf::coat_probability(double cosine) const {
    const double coat = interface_->reflectance(cosine, alpha());
    const double base = through(cosine) * base_albedo_;
    return coat + base > 0 ? coat / (coat + base) : 1.0;
}

Rgb CoatedDiffuseBsdf::eval(const Vec3& to_light, const Vec3& to_eye) const {
    if (!(to_light.z * to_eye.z > 0)) return Rgb(0.0);
    const LocalVec i = upper(to_light), o = upper(to_eye);
    Rgb f = Rgb(base_) * (through(i.z) * through(o.z));
    if (!smooth()) {
        const LocalVec h = half_vector(i, o);
        f += Rgb(fresnel_dielectric(o.dot(h), interface_->eta()).reflectance *
                 Ggx{alpha_x_, alpha_y_}.reflection(i, o, h));
    }
    return f;
}

double CoatedDiffuseBsdf::pdf(const Vec3& from, const Vec3& to) const {
    if (!(from.z * to.z > 0)) return 0;
    const LocalVec w = upper(from), v = upper(to);
    const double coat = coat_probability(w.z), base = (1 - coat) * v.z * kInvPi;
    return smooth() ? base : base + coat * Ggx{alpha_x_, alpha_y_}.reflection_pdf(w, v);
}

std::optional<BsdfSample> CoatedDiffuseBsdf::sample(const Vec3& from, double u0, double u1, double u2) const {
    if (from.z == 0) return std::nullopt;
    const LocalVec w = upper(from);
    const double coat = coat_probability(w.z);
    std::optional<LocalVec> up;
    if (u2 >= coat) {
        up = LocalVec(cosine_hemisphere(u0, u1));
    } else if (smooth()) {
        return BsdfSample{mirrored(from), Event::reflect, coat};
    } else {
        up = Ggx{alpha_x_, alpha_y_}.sample_reflection(w, u0, u1);
    }
    if (!up) return std::nullopt;
    const Vec3 to = on_side_of(from, *up);
    return finite_sample(to, pdf(from, to));
}

std::optional<DeltaScatter> CoatedDiffuseBsdf::delta(const Vec3& from, Event event) const {
    if (event != Event::reflect || !smooth()) return std::nullopt;
    const double cosine = std::abs(static_cast<double>(from.z)), coat = coat_probability(cosine);
    if (!(coat > 0)) return std::nullopt;
    return DeltaScatter{mirrored(from), Rgb(interface_->reflectance(cosine, 0)), coat, 1.0};
}

Rgb CoatedDiffuseBsdf::albedo(const Vec3& to_eye) const {
    return diffuse_reflectance(to_eye) * kPi + Rgb(glossy_albedo(to_eye));
}

Rgb CoatedDiffuseBsdf::diffuse_reflectance(const Vec3& to_eye) const {
    return Rgb(base_) * (mean_through() * through(upper(to_eye).z));
}

double CoatedDiffuseBsdf::diffuse_weight(const Vec3& to_light) const {
    const double mean = mean_through();
    return mean > 0 ? through(upper(to_light).z) / mean : 1.0;
}

CoatedDiffuseBsdf CoatedDiffuseBsdf::glossy_part() const {
    CoatedDiffuseBsdf coat = *this;
    coat.base_ = {};
    coat.base_albedo_ = 0;
    return coat;
}

CoatedDiffuseBsdf CoatedDiffuseBsdf::widened(double alpha) const {
    CoatedDiffuseBsdf wide = *this;
    if (traits().diffuse) return wide; // for what its coat lets through depends on the roughness
    wide.alpha_x_ = widened_alpha(alpha_x_, alpha);
    wide.alpha_y_ = widened_alpha(alpha_y_, alpha);
    return wide;
}

double CoatedDiffuseBsdf::glossy_albedo(const Vec3& from) const {
    return smooth() ? 0.0 : interface_->reflectance(upper(from).z, alpha());
}

double CoatedDiffuseBsdf::glossy_probability(const Vec3& from) const {
    return smooth() ? 0.0 : coat_probability(upper(from).z);
}

} // namespace keyhole
