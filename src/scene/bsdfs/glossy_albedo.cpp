#include "scene/bsdfs/glossy_albedo.h"

#include "core/vec.h"
#include "scene/bsdfs/microfacet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole {
namespace {

constexpr std::size_t kAlphaNodes = 33, kCosineNodes = 33;

/// By visible normals over a grid, which leaves errors of some 1e-3.
SplitAlbedo integrate_ggx(double cosine, double alpha) {
    constexpr int kRadii = 32, kAngles = 12;
    const Ggx ggx{alpha, alpha};
    const LocalVec w(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine);
    const double unmasked = 1 + ggx.lambda(w);
    SplitAlbedo sum{0, 0};
    for (int i = 0; i < kRadii; ++i) {
        // Dense near 1, where the distribution's tail is.
        const double t = 1 - (i + 0.5) / kRadii, u0 = 1 - t * t * t, share = 3 * t * t / (kRadii * kAngles);
        for (int j = 0; j < kAngles; ++j) {
            // Half of the angles are enough: the other half mirrors them.
            const LocalVec h = ggx.sample_visible(w, u0, (j + 0.5) / (2 * kAngles) - 0.25);
            const double c = w.dot(h);
            const LocalVec to = h * (2 * c) - w;
            if (!(c > 0) || !(to.z > 0)) continue;
            const double weight = share * ggx.masking(w, to) * unmasked;
            sum.whole += weight;
            sum.edge += weight * schlick_weight(c);
        }
    }
    return sum;
}

/// By the midpoint rule over the hemisphere of lights.
double integrate_sheen(double cosine) {
    constexpr int kHeights = 48, kAzimuths = 48;
    const LocalVec o(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine);
    double sum = 0;
    for (int i = 0; i < kHeights; ++i)
        for (int j = 0; j < kAzimuths; ++j) {
            // Uniform by projected solid angle, whose total is pi.
            const double z2 = (i + 0.5) / kHeights, r = std::sqrt(1 - z2), phi = kPi * (j + 0.5) / kAzimuths;
            const LocalVec w(r * std::cos(phi), r * std::sin(phi), std::sqrt(z2));
            sum += schlick_weight(std::sqrt(std::max(0.0, (1 + o.dot(w)) / 2)));
        }
    return sum * kPi / (kHeights * kAzimuths);
}

/// Cosine of an entry: closer to each other near the horizon, where albedos change fast.
double entry_cosine(std::size_t i) {
    const double root = std::max(1e-2, static_cast<double>(i) / (kCosineNodes - 1));
    return root * root;
}

struct Entry {
    std::size_t i;
    double share; // of the next one
};
Entry entry_at(double x, std::size_t n) {
    const double s = std::clamp(x, 0.0, 1.0) * static_cast<double>(n - 1);
    const auto i = std::min(static_cast<std::size_t>(s), n - 2);
    return {i, s - static_cast<double>(i)};
}

double between(double a, double b, double share) { return a + (b - a) * share; }
SplitAlbedo between(const SplitAlbedo& a, const SplitAlbedo& b, double share) {
    return {between(a.whole, b.whole, share), between(a.edge, b.edge, share)};
}

struct GgxAlbedoTable {
    std::array<std::array<SplitAlbedo, kCosineNodes>, kAlphaNodes> entries;
    std::array<SplitAlbedo, kAlphaNodes> means;

    GgxAlbedoTable() {
        for (std::size_t a = 0; a < kAlphaNodes; ++a) {
            const double root = static_cast<double>(a) / (kAlphaNodes - 1), alpha = root * root;
            for (std::size_t c = 0; c < kCosineNodes; ++c) {
                const double cosine = entry_cosine(c);
                entries[a][c] = a > 0 ? integrate_ggx(cosine, alpha) : SplitAlbedo{1, schlick_weight(cosine)};
            }
            means[a] = mean(a);
        }
    }

    SplitAlbedo mean(std::size_t alpha) const {
        if (alpha == 0) return {1, 1.0 / 21};
        constexpr int kSteps = 128;
        SplitAlbedo sum{0, 0};
        for (int i = 0; i < kSteps; ++i) {
            const double cosine = (i + 0.5) / kSteps;
            const auto [c, share] = entry_at(std::sqrt(cosine), kCosineNodes);
            const SplitAlbedo x = between(entries[alpha][c], entries[alpha][c + 1], share);
            sum.whole += 2 * cosine * x.whole / kSteps;
            sum.edge += 2 * cosine * x.edge / kSteps;
        }
        return sum;
    }
};

const GgxAlbedoTable& ggx_albedo_table() {
    static const GgxAlbedoTable table;
    return table;
}

} // namespace

SplitAlbedo ggx_albedo(double cosine, double alpha) {
    if (alpha == 0) return {1, schlick_weight(cosine)};
    const GgxAlbedoTable& t = ggx_albedo_table();
    const auto [a, across] = entry_at(std::sqrt(alpha), kAlphaNodes);
    const auto [c, along] = entry_at(std::sqrt(cosine), kCosineNodes);
    return between(between(t.entries[a][c], t.entries[a][c + 1], along),
                   between(t.entries[a + 1][c], t.entries[a + 1][c + 1], along), across);
}

SplitAlbedo mean_ggx_albedo(double alpha) {
    const GgxAlbedoTable& t = ggx_albedo_table();
    const auto [a, share] = entry_at(std::sqrt(alpha), kAlphaNodes);
    return between(t.means[a], t.means[a + 1], share);
}

double sheen_albedo(double cosine) {
    static const auto table = [] {
        std::array<double, kCosineNodes> entries{};
        for (std::size_t i = 0; i < kCosineNodes; ++i) entries[i] = integrate_sheen(entry_cosine(i));
        return entries;
    }();
    const auto [c, share] = entry_at(std::sqrt(cosine), kCosineNodes);
    return between(table[c], table[c + 1], share);
}

} // namespace keyhole
