#include "scene/bsdfs/microfacet.h"

#include "scene/warp.h"

namespace keyhole {

double Ggx::density(const LocalVec& h) const {
    const double x = h.x / alpha_x, y = h.y / alpha_y, sum = x * x + y * y + h.z * h.z;
    return kInvPi / (alpha_x * alpha_y * sum * sum);
}

double Ggx::lambda(const LocalVec& w) const {
    const double x = alpha_x * w.x, y = alpha_y * w.y, z2 = w.z * w.z;
    if (z2 == 0) return INFINITY;
    return (std::sqrt(1 + (x * x + y * y) / z2) - 1) / 2;
}

double Ggx::visible_density(const LocalVec& w, const LocalVec& h) const {
    const double c = w.dot(h);
    if (!(c > 0) || !(h.z > 0) || !(w.z > 0)) return 0;
    return density(h) * c / (w.z * (1 + lambda(w)));
}

LocalVec Ggx::sample_visible(const LocalVec& w, double u0, double u1) const {
    // Stretched so that the distribution is a hemisphere, whose visible part is a projected disc.
    const LocalVec v = LocalVec(alpha_x * w.x, alpha_y * w.y, w.z).normalized();
    const double length = std::hypot(v.x, v.y);
    const LocalVec t1 = length > 0 ? LocalVec(-v.y / length, v.x / length, 0) : LocalVec(1, 0, 0);
    const LocalVec t2 = v.cross(t1);
    const double r = std::sqrt(u0), phi = 2 * kPi * u1, s = (1 + v.z) / 2;
    const double p1 = r * std::cos(phi);
    const double p2 = (1 - s) * std::sqrt(std::max(0.0, 1 - p1 * p1)) + s * r * std::sin(phi);
    const LocalVec n = t1 * p1 + t2 * p2 + v * std::sqrt(std::max(0.0, 1 - p1 * p1 - p2 * p2));
    return LocalVec(alpha_x * n.x, alpha_y * n.y, std::max(1e-12, n.z)).normalized();
}

std::optional<LocalVec> Ggx::sample_reflection(const LocalVec& w, double u0, double u1) const {
    const LocalVec h = sample_visible(w, u0, u1);
    const LocalVec to = h * (2 * w.dot(h)) - w;
    if (!(to.z > 0)) return std::nullopt;
    return to;
}

double Ggx::reflection_pdf(const LocalVec& from, const LocalVec& to) const {
    const LocalVec h = half_vector(from, to);
    const double c = from.dot(h);
    return c > 0 ? visible_density(from, h) / (4 * c) : 0.0;
}

double Ggx::reflection(const LocalVec& a, const LocalVec& b, const LocalVec& h) const {
    return density(h) * masking(a, b) / (4 * a.z * b.z);
}

} // namespace keyhole
