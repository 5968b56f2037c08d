// The balance heuristic (Veach 1997, section 9.2) between the two techniques that make photons: chains over whole paths
// and independent light paths. docs/photon-maps.md derives it.
#pragma once

#include "photonmap/photon_weighing.h"
#include "sampling/guidance/guided_light.h"

#include <optional>

namespace keyhole {

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
