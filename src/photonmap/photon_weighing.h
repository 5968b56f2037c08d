// What a photon is worth where it arrives: light tracing keeps photons by it, and it tells how chains and light paths
// share them.
#pragma once

#include "photonmap/importance/importance_map.h"
#include "sampling/guidance/guided_light.h"
#include "sampling/paths/gather_coverage.h"
#include "sampling/paths/light_tracer.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

namespace keyhole {

/// Where emitted photons are worth storing; null members: everywhere alike.
struct EmissionGuide {
    const ImportanceGuide* global = nullptr;  ///< at d2
    const ImportanceGuide* caustic = nullptr; ///< at d1
};

/// The maps that store a photon arriving at a vertex: those that stored_kind() names for any camera sub-path that the
/// light sub-path could be joined to.
struct StorageRule {
    int max_scatterings = 24;
    bool caustics = true;                     ///< whether there is a caustic map
    const GatherCoverage* coverage = nullptr; ///< of gather rays; null: they come everywhere

    struct Kinds {
        bool global, caustic;
    };
    /// Of light that reached finite vertex `v` from `to_light`.
    Kinds operator()(Vertex& v, const Vec3& to_light, const LightPast& past) const {
        const int here = past.scatterings + 1; // from the light's end
        const int lit = past.first_lit(to_light);
        const LightClass as_d1 = light_class({here, past.last ? past.last->index : 0}, lit);
        const LightClass as_d2 = light_class({here + 1, here}, lit); // light still has to be scattered at d1
        const auto covered = [&] { return is_covered(coverage, v, to_light); };
        const auto last_covered = [&] {
            if (coverage == nullptr || past.last->covered) return coverage == nullptr || *past.last->covered;
            return coverage->asks_for(past.last->p, past.last->n, past.last->through);
        };
        return {here < max_scatterings && stores_in(PhotonKind::global, as_d2, covered),
                caustics && stores_in(PhotonKind::caustic, as_d1, last_covered)};
    }
};

/// Weighs photons by visible power where importance is known, by a small multiple of power elsewhere.
struct PhotonWeighing {
    EmissionGuide guide;
    double unknown_scale = 0; ///< weight of a photon of unknown importance over the luminance of its power
    double most_visible = std::numeric_limits<double>::infinity(); ///< that a photon of the global map may have [W]

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
    double squares = 0;                         ///< of known weights
    std::uint64_t all = 0;                      ///< how many there are
    std::uint64_t seen = 0;                     ///< how many have a known weight that isn't 0

    void add(PhotonKind kind, const PhotonWeighing::Weight& weight, double power) {
        ++all;
        if (weight.known) squares += weight.value * weight.value;
        seen += weight.known && weight.value > 0 ? 1 : 0;
        (!weight.known                ? unknown
         : kind == PhotonKind::global ? known_global
                                      : known_caustic) += weight.known ? weight.value : power;
    }
    PhotonWeights& operator+=(const PhotonWeights& o) {
        known_global += o.known_global;
        known_caustic += o.known_caustic;
        unknown += o.unknown;
        squares += o.squares;
        all += o.all;
        seen += o.seen;
        return *this;
    }
    /// Photons that are seen, as many equal ones as would be as good, over all of these paths or photons, whichever are
    /// more: (sum w)^2 / (n sum w^2), with known weights w. 0 if none is seen.
    double share_seen(std::int64_t paths) const {
        const auto n = static_cast<double>(std::max(all, static_cast<std::uint64_t>(paths)));
        return squares > 0 ? known() * known() / (n * squares) : 0;
    }
    double known() const { return known_global + known_caustic; }
    /// Photons of unknown importance together weigh a twentieth of the others: few enough to cost little, enough for
    /// none to become an outlier where the guide is wrong.
    double unknown_scale() const { return known() > 0 && unknown > 0 ? 0.05 * known() / unknown : 1.0; }
    /// How many of so many photons are for the caustic map, where there is one.
    std::size_t for_caustic(std::size_t photons) const;
};

// The balance heuristic (Veach 1997, section 9.2) between the two techniques that make photons: chains over whole paths
// and independent light paths. docs/photon-maps.md derives it.

/// F(X) / p(X) [W] of light sub-path X, vertices 0 to `last` of `path`: flux over the density of light tracing, every
/// way to make X summed: choice of emitter, place and direction, scattering, walks along user paths, survival of
/// roulette. That is the power with which light tracing arrives there. None where light tracing never makes X. Reads
/// points, BSDFs and events of the vertices only.
std::optional<Rgb> light_path_power(const Scene& scene, const LightPathSampling& sampling, const Path& path, int last);

/// N_c steps of chains visit light sub-path X with density C(X) / B, where C = Y(F E) is its visible power, N_i light
/// paths make it with density p(X). Over both, the share of chains is N_c C / B / (N_c C / B + N_i p), which depends on
/// the visible power V = Y(F E) / p of light tracing's photon alone. Weights add up to one whatever estimate of V they
/// are computed from, as long as it is a function of X for both techniques.
class TechniqueWeights {
  public:
    /// `odds`: N_c / (N_i B), the number of steps for each light path over the brightness [(m^2 sr)/W]. What `guide`
    /// and `sampling` refer to must outlive this.
    TechniqueWeights(const EmissionGuide& guide, const LightPathSampling& sampling, double odds)
        : weighing_{guide}, sampling_(sampling), odds_(odds) {}

    /// Share of chains in photons that light tracing would make with visible power V. Where importance is unknown it
    /// stores everything that it can make.
    double of_chains(const PhotonWeighing::Weight& visible) const {
        return visible.known ? 1 / (1 + 1 / (odds_ * visible.value)) : 0.0;
    }
    /// That of light tracing.
    double of_light_path(const PhotonWeighing::Weight& visible) const { return 1 - of_chains(visible); }
    /// V of the photon of `kind` at vertex `at` of `path`; infinite where light tracing never makes it.
    PhotonWeighing::Weight visible(const Scene& scene, PhotonKind kind, const Path& path, int at) const;

  private:
    PhotonWeighing weighing_;
    LightPathSampling sampling_;
    double odds_;
};

} // namespace keyhole
