// What a photon is worth where it arrives: light tracing keeps photons by it, chains of light paths seek it.
#pragma once

#include "photonmap/importance_guide.h"
#include "sampling/light_tracer.h"
#include "sampling/reach.h"

#include <cstddef>

namespace keyhole {

/// Where emitted photons are worth storing; null members: everywhere alike.
struct EmissionGuide {
    const ImportanceGuide* global = nullptr;  ///< at d2
    const ImportanceGuide* caustic = nullptr; ///< at d1
};

/// Which map light goes to that arrives at a vertex, as PathSet::storage_point() has it for whole paths.
struct StorageRule {
    int max_scatterings = 24;
    bool caustics = true;         ///< whether there is a caustic map
    const Reach* reach = nullptr; ///< of gather rays; null: they come everywhere

    struct Kinds {
        bool global, caustic;
    };
    /// Of light that reached finite vertex `v` from `to_light` as its `arrival`-th vertex, counted from 1.
    Kinds operator()(const SurfacePoint& v, const Vec3& to_light, int arrival, const LightPast& past) const {
        const auto reached = [&](const Vec3& p, const Vec3& n) { return reach == nullptr || reach->comes_to(p, n); };
        // Beyond reach its last scattering makes this the first one seen.
        const bool unreached = past.last && !reached(past.last->p, past.last->n);
        // From d2 light still has to be scattered at d1.
        return {arrival > 1 && arrival < max_scatterings && reached(v.p, facing(v.ng, to_light)),
                caustics && (past.specular_only() || unreached)};
    }
};

/// Weighs photons by visible power where importance is known, by a small multiple of power elsewhere.
struct PhotonWeighing {
    EmissionGuide guide;
    double unknown_scale = 0; ///< weight of a photon of unknown importance over the luminance of its power

    struct Weight {
        double value;
        bool known;
    };
    /// Of light of RGB `power` [W] that arrives at `v` from `to_light`.
    Weight operator()(PhotonKind kind, const Vertex& v, const Vec3& to_light, const Rgb& power) const;
};

/// Sums over photons, from which the weight of later ones and the maps' shares of the memory follow.
struct PhotonWeights {
    double known_global = 0, known_caustic = 0; ///< weight
    double unknown = 0;                         ///< luminance of power [W]

    void add(PhotonKind kind, const PhotonWeighing::Weight& weight, double power) {
        (!weight.known                ? unknown
         : kind == PhotonKind::global ? known_global
                                      : known_caustic) += weight.known ? weight.value : power;
    }
    PhotonWeights& operator+=(const PhotonWeights& o) {
        known_global += o.known_global;
        known_caustic += o.known_caustic;
        unknown += o.unknown;
        return *this;
    }
    double known() const { return known_global + known_caustic; }
    /// Photons of unknown importance together weigh a twentieth of the others: few enough to cost little, enough for
    /// none to become an outlier where the guide is wrong.
    double unknown_scale() const { return known() > 0 && unknown > 0 ? 0.05 * known() / unknown : 1.0; }
    /// How many of so many photons are for the caustic map, where there is one.
    std::size_t for_caustic(std::size_t photons) const;
};

} // namespace keyhole
