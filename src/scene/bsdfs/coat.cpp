#include "scene/bsdfs/coat.h"

#include "core/error.h"
#include "scene/bsdfs/fresnel.h"

#include <algorithm>
#include <map>
#include <mutex>

namespace keyhole {
namespace {

/// Fractions of the light along one direction that go back and that go through, having met one facet. Facets hide each
/// other, so that they add up to less than 1.
struct Fractions {
    double reflected = 0, transmitted = 0;
};

/// Weights of visible normal sampling, averaged over a grid whose numbers of nodes leave errors of some 1e-3. `eta` is
/// the index on the far side over that on the near one.
Fractions rough_fractions(double cos_i, double alpha, double eta) {
    constexpr int kRadii = 16, kAngles = 8;
    const Ggx ggx{alpha, alpha};
    const LocalVec w(std::sqrt(std::max(0.0, 1 - cos_i * cos_i)), 0, cos_i);
    const double masking = 1 / (1 + ggx.lambda(w));
    Fractions sum;
    for (int i = 0; i < kRadii; ++i)
        for (int j = 0; j < kAngles; ++j) {
            // Half of the angles are enough: the other half mirrors them.
            const double u1 = (j + 0.5) / (2 * kAngles) - 0.25;
            const LocalVec h = ggx.sample_visible(w, (i + 0.5) / kRadii, u1);
            const double c = w.dot(h);
            if (!(c > 0)) continue;
            const auto [f, cos_t] = fresnel_dielectric(c, eta);
            const LocalVec back = h * (2 * c) - w, through = h * (c / eta - cos_t) - w / eta;
            if (back.z > 0) sum.reflected += f * ggx.masking(w, back) / masking;
            if (f < 1 && through.z < 0) sum.transmitted += (1 - f) * ggx.masking(w, through) / masking;
        }
    return {sum.reflected / (kRadii * kAngles), sum.transmitted / (kRadii * kAngles)};
}

/// Midpoints of n equal parts of [0,1].
double node(std::size_t i, std::size_t n) { return (static_cast<double>(i) + 0.5) / static_cast<double>(n); }

} // namespace

std::shared_ptr<const CoatInterface> CoatInterface::of(double eta) {
    if (!(eta > 0) || !std::isfinite(eta)) throw InputError("a coat needs a refractive index above 0");
    static std::mutex mutex;
    static std::map<double, std::weak_ptr<const CoatInterface>> cache;
    const std::lock_guard lock(mutex);
    auto& entry = cache[eta];
    auto interface = entry.lock();
    if (interface == nullptr) entry = interface = std::make_shared<const CoatInterface>(eta);
    return interface;
}

CoatInterface::CoatInterface(double eta) : eta_(eta) {
    for (std::size_t a = 0; a < kAlphas; ++a) {
        const double alpha = static_cast<double>(a) / (kAlphas - 1);
        const auto fractions = [alpha](double cosine, double index) {
            if (alpha > 0) return rough_fractions(cosine, alpha, index);
            const double r = fresnel_dielectric(cosine, index).reflectance;
            return Fractions{r, 1 - r};
        };
        for (std::size_t c = 0; c < kCosines; ++c) {
            const double root = std::max(1e-2, static_cast<double>(c) / (kCosines - 1));
            const auto [reflected, transmitted] = fractions(root * root, eta);
            reflectance_[a][c] = static_cast<float>(reflected);
            transmittance_[a][c] = static_cast<float>(transmitted);
        }
        constexpr std::size_t kSteps = 128;
        double back = 0;
        for (std::size_t i = 0; i < kSteps; ++i)
            back += 2 * node(i, kSteps) * fractions(node(i, kSteps), 1 / eta).reflected / kSteps;
        internal_[a] = static_cast<float>(back);
    }
    double sum = 0;
    for (std::size_t i = 0; i < kNodes; ++i) {
        const double cosine = node(i, kNodes), share = cosine * fresnel_dielectric(cosine, 1 / eta).reflectance;
        internal_share_[i] = static_cast<float>(share);
        sum += share;
    }
    for (float& share : internal_share_) share = sum > 0 ? share / static_cast<float>(sum) : 0.0f;
    fill_mean_through();
}

void CoatInterface::fill_mean_through() {
    constexpr std::size_t kSteps = 128; // by the square of the cosine, in which all directions weigh the same
    for (std::size_t a = 0; a < kAlphas; ++a)
        for (std::size_t u = 0; u < kClear; ++u) {
            const double clear = static_cast<double>(u) / (kClear - 1);
            double sum = 0;
            for (std::size_t i = 0; i < kSteps; ++i) {
                const double cosine = std::sqrt(node(i, kSteps)), inside = refracted(cosine);
                const double way = clear == 1 ? 1.0 : clear > 0 && inside > 0 ? std::pow(clear, 1 / inside) : 0.0;
                sum += transmittance(cosine, static_cast<double>(a) / (kAlphas - 1)) * way;
            }
            mean_through_[a][u] = static_cast<float>(sum / kSteps);
        }
}

double CoatInterface::mean_through(double alpha, double thickness) const {
    const auto [a, ta] = locate(alpha, kAlphas);
    const auto [u, tu] = locate(std::exp(-thickness), kClear);
    const auto row = [&, u = u, tu = tu](std::size_t k) {
        return between(mean_through_[k][u], mean_through_[k][u + 1], tu);
    };
    return between(row(a), row(a + 1), ta);
}

double CoatInterface::look_up(const Table& table, double cos_i, double alpha) {
    const auto [a, ta] = locate(alpha, kAlphas);
    const auto [c, tc] = locate(std::sqrt(cos_i), kCosines);
    return between(between(table[a][c], table[a][c + 1], tc), between(table[a + 1][c], table[a + 1][c + 1], tc), ta);
}

double CoatInterface::reflectance(double cos_i, double alpha) const {
    return alpha == 0 ? fresnel_dielectric(cos_i, eta_).reflectance : look_up(reflectance_, cos_i, alpha);
}

double CoatInterface::transmittance(double cos_i, double alpha) const {
    return alpha == 0 ? 1 - fresnel_dielectric(cos_i, eta_).reflectance : look_up(transmittance_, cos_i, alpha);
}

double CoatInterface::refracted(double cos_i) const {
    return std::sqrt(std::max(0.0, 1 - (1 - cos_i * cos_i) / (eta_ * eta_)));
}

double CoatInterface::attenuation(double cos_i, double thickness) const {
    if (thickness == 0) return 1;
    const double cosine = refracted(cos_i);
    return cosine > 0 ? std::exp(-thickness / cosine) : 0.0;
}

double CoatInterface::internal_reflectance(double alpha, double thickness) const {
    const auto [a, t] = locate(alpha, kAlphas);
    const double clear = std::max(0.0, between(internal_[a], internal_[a + 1], t));
    if (thickness == 0) return clear;
    double left = 0;
    for (std::size_t i = 0; i < kNodes; ++i) left += internal_share_[i] * std::exp(-2 * thickness / node(i, kNodes));
    return clear * left;
}

} // namespace keyhole
