// Where light paths begin: emitters, points and directions, by what they bring to the picture.
#pragma once

#include "sampling/guidance/learned/emission_targets.h"
#include "sampling/guidance/learned/look_for_light.h"
#include "sampling/paths/walk.h"

#include <span>
#include <vector>

namespace keyhole {

/// A choice of first edges that follows the light which photon maps hold: learned from paths traced from the eye, which
/// don't count in any picture. (Jensen 1995 aims by histograms from the light's side; Estevez and Kulla 2020,
/// "Practical Caustics Rendering with Adaptive Photon Guiding", choose emitters by what pilot photons bring.) A share
/// of all choices goes as if nothing had been learned, so that light arrives from everywhere with the power that it
/// has. Immutable and thread-safe.
class LearnedEmission {
  public:
    /// @param seen in any order; there may be nothing
    LearnedEmission(const Scene& scene, std::vector<SeenLight> seen);

    /// Whether it pays: where light comes from infinity, or from many lamps. Among few of these, paths from the eye
    /// find too little of the light that is hardest to find for what is to be gained.
    static bool can_learn(const Scene& scene);

    /// Keeps half of all edges for what can't be learned from the eye's side: as emitters have power, and as these
    /// bring `hidden` light (one number each, with a positive sum). To be called before anything is sampled.
    void add_hidden(std::span<const double> hidden);

    /// The first edge of a light path. None where nothing emits.
    std::optional<EmittedLight> sample(SampleSource& source) const;

    /// Density with which sample() makes the first edge, from `x0` along `w` through `p`, over that of emission by
    /// power.
    double density_ratio(const SurfacePoint& x0, const Vec3& w, const Vec3& p) const;

    /// How many emitters would do: the reciprocal of the sum of their squared shares.
    double effective_emitters() const;
    std::size_t bytes() const { return targets_.bytes(); }

  private:
    void choose_emitters(std::vector<SeenLight>& seen);
    FirstEdge sample_plain(double u, SampleSource& source) const;
    /// Density of the emitter's point times that of EmitterRay.
    double pdf(const FirstEdge& edge) const;

    const Scene* scene_;
    EmitterDistribution choice_; ///< of emitters, where no target is aimed at
    EmissionTargets targets_;
    double plain_ = 1; ///< share of edges that aim at none
};

} // namespace keyhole
