#include "scene/bsdfs/fresnel.h"

#include <algorithm>

namespace keyhole {
namespace {

double fresnel_conductor(double cos_i, double eta, double k) {
    const double cos2 = cos_i * cos_i, sin2 = std::max(0.0, 1 - cos2);
    const double t0 = eta * eta - k * k - sin2;
    const double a2_plus_b2 = std::hypot(t0, 2 * eta * k);
    const double a = std::sqrt(std::max(0.0, (a2_plus_b2 + t0) / 2));
    const double t1 = a2_plus_b2 + cos2, t2 = 2 * cos_i * a;
    const double perpendicular = (t1 - t2) / (t1 + t2);
    const double t3 = cos2 * a2_plus_b2 + sin2 * sin2, t4 = t2 * sin2;
    // At normal incidence both vanish where the index is 1, and the two reflectances are the same.
    const double ratio = t3 + t4 > 0 ? (t3 - t4) / (t3 + t4) : 1.0;
    return perpendicular * (1 + ratio) / 2;
}

} // namespace

FresnelResult fresnel_dielectric(double cos_i, double eta) {
    const double sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return {1.0, 0.0};
    const double cos_t = std::sqrt(1 - sin2_t);
    const double parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const double perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return {(parallel * parallel + perpendicular * perpendicular) / 2, cos_t};
}

Rgb fresnel_conductor(double cos_i, const ComplexIndex& index) {
    return {fresnel_conductor(cos_i, index.eta.x, index.k.x), fresnel_conductor(cos_i, index.eta.y, index.k.y),
            fresnel_conductor(cos_i, index.eta.z, index.k.z)};
}

} // namespace keyhole
