#include "scene/bsdfs/conductor.h"

#include "scene/bsdfs/glossy_albedo.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

Rgb RoughConductorBsdf::eval(const Vec3& to_light, const Vec3& to_eye) const {
    if (!(to_light.z * to_eye.z > 0)) return Rgb(0.0);
    const LocalVec i = upper(to_light), o = upper(to_eye), h = half_vector(i, o);
    return fresnel_conductor(o.dot(h), index) * (scale * Ggx{alpha_x, alpha_y}.reflection(i, o, h));
}

double RoughConductorBsdf::pdf(const Vec3& from, const Vec3& to) const {
    if (!(from.z * to.z > 0)) return 0;
    return Ggx{alpha_x, alpha_y}.reflection_pdf(upper(from), upper(to));
}

std::optional<BsdfSample> RoughConductorBsdf::sample(const Vec3& from, double u0, double u1, double /*u2*/) const {
    if (from.z == 0) return std::nullopt;
    const auto up = Ggx{alpha_x, alpha_y}.sample_reflection(upper(from), u0, u1);
    if (!up) return std::nullopt;
    const Vec3 to = on_side_of(from, *up);
    return finite_sample(to, pdf(from, to));
}

/// The table's lobe with the Fresnel term of the facets' typical cosine: the one that has their mean of Schlick's
/// weight.
Rgb RoughConductorBsdf::albedo(const Vec3& to_eye) const {
    const GgxAlbedo lobe = ggx_albedo(upper(to_eye).z, mean_alpha(alpha_x, alpha_y), 0);
    if (!(lobe.whole > 0)) return Rgb(0.0);
    const double cosine = 1 - std::pow(std::min(1.0, lobe.schlick / lobe.whole), 0.2);
    return fresnel_conductor(cosine, index) * (scale * lobe.whole);
}

RoughConductorBsdf RoughConductorBsdf::widened(double alpha) const {
    RoughConductorBsdf wide{index, widened_alpha(alpha_x, alpha), widened_alpha(alpha_y, alpha), scale};
    if (wide.alpha_x == alpha_x && wide.alpha_y == alpha_y) return wide;
    const auto albedo = [](const RoughConductorBsdf& b) {
        return mean_ggx_albedo(mean_alpha(b.alpha_x, b.alpha_y), 0).whole;
    };
    wide.scale *= static_cast<float>(albedo(*this) / albedo(wide));
    return wide;
}

} // namespace keyhole
