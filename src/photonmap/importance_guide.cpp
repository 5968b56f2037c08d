#include "photonmap/importance_guide.h"

namespace keyhole {

std::optional<double> ImportanceGuide::visible_power(const Vertex& v, const Vec3& to_light, const Rgb& power) const {
    const Vec3 normal = v.point.ng.dot(to_light) < 0 ? -v.point.ng : v.point.ng;
    const auto answer = map_.irradiance(v.point.p, normal);
    if (!answer.known) return std::nullopt;
    // Where light leaves is not known here: a diffuse surface doesn't mind, and others are taken for white ones.
    const Rgb scattering = v.bsdf.traits().near_lambertian ? v.bsdf.eval(to_light, to_light) : Rgb(1 / kPi);
    const double visible = luminance(power * scattering * answer.irradiance);
    if (!(visible > 0)) return std::nullopt;
    return visible;
}

} // namespace keyhole
