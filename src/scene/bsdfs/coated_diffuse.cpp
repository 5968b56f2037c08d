#include "scene/bsdfs/coated_diffuse.h"

#include "scene/bsdfs/fresnel.h"
#include "scene/warp.h"

namespace keyhole {

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
