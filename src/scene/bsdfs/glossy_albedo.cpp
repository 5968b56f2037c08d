#include "scene/bsdfs/glossy_albedo.h"

#include "core/vec.h"
#include "scene/bsdfs/fresnel.h"
#include "scene/bsdfs/microfacet.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole {
namespace {

constexpr std::size_t kAlphaNodes = 33, kCosineNodes = 33;
/// Of roots of reflectances, 0.05 apart: that of the index 1.5, by far the commonest, is one of them.
constexpr std::size_t kRootNodes = 11;
constexpr std::size_t kFacetNodes = 65;

/// What all facets reflect along one direction, by the cosine to each, as if they reflected all: shared out to the
/// nodes (i / (kFacetNodes - 1))^2.
using FacetCosines = std::array<double, kFacetNodes>;

/// By visible normals over a grid, which leaves errors of some 1e-3.
FacetCosines integrate_ggx(double cosine, double alpha) {
    constexpr int kRadii = 32, kAngles = 12;
    const Ggx ggx{alpha, alpha};
    const LocalVec w(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine);
    const double unmasked = 1 + ggx.lambda(w);
    FacetCosines sum{};
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
            const auto [k, next] = locate(std::sqrt(c), kFacetNodes);
            sum[k] += weight * (1 - next);
            sum[k + 1] += weight * next;
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

/// A GgxAlbedo for each root; of one facet, its Fresnel weights and a `whole` of 1.
struct Albedos {
    double whole = 0, schlick = 0;
    std::array<double, kRootNodes> dielectric{};

    void add(const Albedos& other, double share) {
        whole += share * other.whole;
        schlick += share * other.schlick;
        for (std::size_t r = 0; r < kRootNodes; ++r) dielectric[r] += share * other.dielectric[r];
    }
    GgxAlbedo at(const TablePosition& root) const {
        return {whole, schlick, between(dielectric[root.i], dielectric[root.i + 1], root.share)};
    }
};

Albedos weights_at(double cosine) {
    Albedos weights{1, schlick_weight(cosine), {}};
    for (std::size_t r = 0; r < kRootNodes; ++r) {
        const double root = DielectricWeight::kMostRoot * static_cast<double>(r) / (kRootNodes - 1);
        weights.dielectric[r] = DielectricWeight(root)(cosine);
    }
    return weights;
}

GgxAlbedo albedo_between(const GgxAlbedo& a, const GgxAlbedo& b, double share) {
    return {between(a.whole, b.whole, share), between(a.schlick, b.schlick, share),
            between(a.dielectric, b.dielectric, share)};
}

TablePosition root_entry(double root) { return locate(root / DielectricWeight::kMostRoot, kRootNodes); }

struct GgxAlbedoTable {
    std::array<std::array<Albedos, kCosineNodes>, kAlphaNodes> entries;
    std::array<Albedos, kAlphaNodes> means;

    GgxAlbedoTable() {
        std::array<Albedos, kFacetNodes> weights; // the same for all entries: Fresnel's equations cost more than sums
        for (std::size_t i = 0; i < kFacetNodes; ++i) {
            const double root = static_cast<double>(i) / (kFacetNodes - 1);
            weights[i] = weights_at(root * root);
        }
        for (std::size_t c = 0; c < kCosineNodes; ++c) entries[0][c] = weights_at(entry_cosine(c));
        for (std::size_t a = 1; a < kAlphaNodes; ++a) {
            const double root = static_cast<double>(a) / (kAlphaNodes - 1), alpha = root * root;
            for (std::size_t c = 0; c < kCosineNodes; ++c) {
                const FacetCosines facets = integrate_ggx(entry_cosine(c), alpha);
                for (std::size_t i = 0; i < kFacetNodes; ++i) entries[a][c].add(weights[i], facets[i]);
            }
        }
        for (std::size_t a = 0; a < kAlphaNodes; ++a) means[a] = mean(a);
    }

    Albedos mean(std::size_t alpha) const {
        constexpr int kSteps = 128;
        Albedos sum;
        for (int i = 0; i < kSteps; ++i) {
            const double cosine = (i + 0.5) / kSteps, weight = 2 * cosine / kSteps;
            if (alpha == 0) {
                sum.add(weights_at(cosine), weight);
                continue;
            }
            const auto [c, share] = locate(std::sqrt(cosine), kCosineNodes);
            sum.add(entries[alpha][c], weight * (1 - share));
            sum.add(entries[alpha][c + 1], weight * share);
        }
        return sum;
    }
};

const GgxAlbedoTable& ggx_albedo_table() {
    static const GgxAlbedoTable table;
    return table;
}

} // namespace

GgxAlbedo ggx_albedo(double cosine, double alpha, double root) {
    if (alpha == 0) return {1, schlick_weight(cosine), DielectricWeight(root)(cosine)};
    const GgxAlbedoTable& t = ggx_albedo_table();
    const auto [a, across] = locate(std::sqrt(alpha), kAlphaNodes);
    const auto [c, along] = locate(std::sqrt(cosine), kCosineNodes);
    const TablePosition r = root_entry(root);
    const Albedos *low = &t.entries[a][c], *high = &t.entries[a + 1][c];
    const auto mixed = [&, along = along, across = across](const auto& of) {
        return between(between(of(low[0]), of(low[1]), along), between(of(high[0]), of(high[1]), along), across);
    };
    return {mixed([](const Albedos& x) { return x.whole; }), mixed([](const Albedos& x) { return x.schlick; }),
            between(mixed([&](const Albedos& x) { return x.dielectric[r.i]; }),
                    mixed([&](const Albedos& x) { return x.dielectric[r.i + 1]; }), r.share)};
}

double mean_alpha(float alpha_x, float alpha_y) {
    return alpha_x == alpha_y ? alpha_x : std::sqrt((alpha_x * alpha_x + alpha_y * alpha_y) / 2);
}

GgxAlbedo mean_ggx_albedo(double alpha, double root) {
    const GgxAlbedoTable& t = ggx_albedo_table();
    const auto [a, share] = locate(std::sqrt(alpha), kAlphaNodes);
    const TablePosition r = root_entry(root);
    return albedo_between(t.means[a].at(r), t.means[a + 1].at(r), share);
}

double sheen_albedo(double cosine) {
    static const auto table = [] {
        std::array<double, kCosineNodes> entries{};
        for (std::size_t i = 0; i < kCosineNodes; ++i) entries[i] = integrate_sheen(entry_cosine(i));
        return entries;
    }();
    const auto [c, share] = locate(std::sqrt(cosine), kCosineNodes);
    return between(table[c], table[c + 1], share);
}

} // namespace keyhole
