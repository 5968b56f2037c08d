// What a photon is worth where it arrives: light tracing keeps photons by it, chains of light paths seek it.
#pragma once

#include "photonmap/importance_guide.h"

#include <cstddef>

namespace keyhole {

/// Where emitted photons are worth storing; null members: everywhere alike.
struct EmissionGuide {
    const ImportanceGuide* global = nullptr;  ///< at d2
    const ImportanceGuide* caustic = nullptr; ///< at d1
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
