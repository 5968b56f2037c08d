#include "scene/bsdfs/dielectric.h"

namespace keyhole {
namespace {

/// Two directions and the microfacet between them, turned so that `from` is above.
struct Facet {
    LocalVec from, to, h;
    double relative; ///< index on the far side of `from` over that on its own
    bool reflects;
};

/// None where no microfacet that both can see leads from one to the other.
std::optional<Facet> facet_between(const Vec3& from, const Vec3& to, double eta) {
    if (from.z == 0 || to.z == 0) return std::nullopt;
    Facet f;
    f.relative = from.z > 0 ? eta : 1 / eta;
    f.reflects = from.z * to.z > 0;
    // Floats are unit to seven digits; near total reflection that would not do for Snell's law at the facet.
    f.from = upper(from).normalized();
    f.to = LocalVec(to.x, to.y, from.z > 0 ? to.z : -to.z).normalized();
    f.h = (f.from + f.to * (f.reflects ? 1.0 : f.relative)).normalized();
    if (f.h.z < 0) f.h = -f.h;
    if (!(f.from.dot(f.h) > 0) || !(f.to.dot(f.h) * f.to.z > 0)) return std::nullopt;
    return f;
}

/// |d h / d to| for refraction (Walter et al. 2007, equation 17).
double refraction_jacobian(const Facet& f) {
    const double sum = f.from.dot(f.h) + f.relative * f.to.dot(f.h);
    return f.relative * f.relative * std::abs(f.to.dot(f.h)) / (sum * sum);
}

double reflectance(const Facet& f) { return fresnel_dielectric(f.from.dot(f.h), f.relative).reflectance; }

} // namespace

std::optional<BsdfSample> GlassBsdf::sample(const Vec3& from, double /*u0*/, double /*u1*/, double u2) const {
    const double relative = from.z > 0 ? eta : 1 / eta;
    const Event event =
        u2 < fresnel_dielectric(std::abs(from.z), relative).reflectance ? Event::reflect : Event::transmit;
    const auto lobe = delta(from, event);
    if (!lobe || is_black(lobe->coefficient)) return std::nullopt;
    return BsdfSample{lobe->to, event, lobe->probability};
}

std::optional<DeltaScatter> GlassBsdf::delta(const Vec3& from, Event event) const {
    if (from.z == 0) return std::nullopt;
    const double relative = from.z > 0 ? eta : 1 / eta;
    const auto [reflectance, cos_t] = fresnel_dielectric(std::abs(from.z), relative);
    if (event == Event::reflect) {
        return DeltaScatter{mirrored(from), Rgb(reflect_tint) * reflectance, reflectance, 1.0};
    }
    if (event != Event::transmit || cos_t == 0) return std::nullopt;
    const auto inverse = static_cast<float>(-1 / relative);
    Vec3 to(from.x * inverse, from.y * inverse, static_cast<float>(from.z > 0 ? -cos_t : cos_t));
    to.normalize();
    return DeltaScatter{to, Rgb(transmit_tint) * (1 - reflectance), 1 - reflectance, relative};
}

Rgb RoughDielectricBsdf::eval(const Vec3& to_light, const Vec3& to_eye) const {
    const auto f = facet_between(to_eye, to_light, eta);
    if (!f) return Rgb(0.0);
    const Ggx ggx{alpha_x, alpha_y};
    if (f->reflects) return Rgb(reflect_tint) * (reflectance(*f) * ggx.reflection(f->from, f->to, f->h));
    // Equation 21 of Walter et al., n_eye^2 in its numerator: the Jacobian has n_light^2 there instead.
    const double radiance_scale = 1 / (f->relative * f->relative);
    return Rgb(transmit_tint) *
           ((1 - reflectance(*f)) * ggx.density(f->h) * ggx.masking(f->from, f->to) * refraction_jacobian(*f) *
            radiance_scale * f->from.dot(f->h) / std::abs(f->from.z * f->to.z));
}

double RoughDielectricBsdf::pdf(const Vec3& from, const Vec3& to) const {
    const auto f = facet_between(from, to, eta);
    if (!f) return 0;
    const double visible = Ggx{alpha_x, alpha_y}.visible_density(f->from, f->h), r = reflectance(*f);
    return f->reflects ? visible * r / (4 * f->from.dot(f->h)) : visible * (1 - r) * refraction_jacobian(*f);
}

std::optional<BsdfSample> RoughDielectricBsdf::sample(const Vec3& from, double u0, double u1, double u2) const {
    if (from.z == 0) return std::nullopt;
    const LocalVec w = upper(from).normalized(), h = Ggx{alpha_x, alpha_y}.sample_visible(w, u0, u1);
    const double relative = from.z > 0 ? eta : 1 / static_cast<double>(eta), c = w.dot(h);
    const auto [r, cos_t] = fresnel_dielectric(c, relative);
    const bool reflects = u2 < r;
    const LocalVec up = reflects ? h * (2 * c) - w : h * (c / relative - cos_t) - w / relative;
    if (up.z == 0 || (up.z > 0) != reflects) return std::nullopt;
    const Vec3 to = on_side_of(from, up.normalized());
    return finite_sample(to, pdf(from, to));
}

Rgb RoughDielectricBsdf::albedo(const Vec3& to_eye) const {
    const LocalVec w = upper(to_eye);
    const Ggx ggx{alpha_x, alpha_y};
    const double relative = to_eye.z > 0 ? eta : 1 / static_cast<double>(eta);
    return mean_over_facets(ggx, w, [&](const LocalVec& h) {
        const double c = w.dot(h);
        const auto [r, cos_t] = fresnel_dielectric(c, relative);
        const LocalVec back = h * (2 * c) - w, through = h * (c / relative - cos_t) - w / relative;
        Rgb sum(0.0);
        if (back.z > 0) sum += Rgb(reflect_tint) * (r * ggx.unmasked(w, back));
        if (r < 1 && through.z < 0) sum += Rgb(transmit_tint) * ((1 - r) * ggx.unmasked(w, through));
        return sum;
    });
}

} // namespace keyhole
