// Where light paths begin: emitters, and directions and places of light from infinity, by what they bring to the
// picture.
#pragma once

#include "sampling/guidance/learned/look_for_light.h"
#include "sampling/guidance/learned/plane_histogram.h"
#include "sampling/paths/light_tracer.h"

#include <cstdint>
#include <vector>

namespace keyhole {

/// A choice of emitters and, for those at infinity, of directions and places, that follows the light which photon maps
/// hold: learned from paths traced from the eye, which don't count in any picture. (Jensen 1995 aims by the same
/// histograms from the light's side; Estevez and Kulla 2020, "Practical Caustics Rendering with Adaptive Photon
/// Guiding", choose emitters by what pilot photons bring.) A share of all choices goes as if nothing had been learned,
/// so that light arrives from everywhere with the power that it has. Immutable and thread-safe.
class LearnedEmission {
  public:
    /// @param seen in any order; there may be nothing
    LearnedEmission(const Scene& scene, std::vector<SeenLight> seen);

    /// Whether it pays: where light comes from infinity, or from many lamps. Among few of these, paths from the eye
    /// find too little of the light that is hardest to find for what is to be gained.
    static bool can_learn(const Scene& scene);

    /// The first edge of a light path, its density that of all choices together; none where nothing emits.
    std::optional<EmittedLight> sample(SampleSource& source) const;

    /// Density of the first edge of a light path, from `x0` along `w` through `p`, over that of emission by power, all
    /// choices together: what sample() has but where it resamples directions; there the limit of many candidates.
    double density_ratio(const SurfacePoint& x0, const Vec3& w, const Vec3& p) const;

    /// How many emitters would do: the reciprocal of the sum of their squared shares.
    double effective_emitters() const;
    std::size_t bytes() const;

  private:
    /// Parallel light of neighbouring directions.
    struct Beam {
        double weight = 0;    ///< how much more of its light counts than of light of all directions
        Vec3 w{0, 0, 1};      ///< of its middle, in which light travels
        Vec3 center{0, 0, 0}; ///< of the plane across w that places are counted on
        PlaneHistogram places;
    };
    /// Of one emitter at infinity.
    struct Sky {
        int side = 1;           ///< beams lie on an octahedral map of side * side cells; 1 for a single direction
        double mean_weight = 1; ///< of beams, by the light that the emitter sends from each
        std::vector<Beam> beams;
    };

    void choose_emitters(std::vector<SeenLight>& seen);
    void learn_sky(std::uint32_t emitter, std::span<const SeenLight> found);
    void learn_beam(Beam& beam, std::span<const SeenLight> found) const;
    std::optional<EmittedLight> sample_sky(const Sky& sky, const Emitter& emitter, double probability, std::uint32_t i,
                                           SampleSource& source) const;
    EmitterRay sample_place(const Beam& beam, const Emitter& emitter, const SurfacePoint& point,
                            SampleSource& source) const;
    /// Where light along `w` through `p` crosses the beam's plane.
    static PlaneHistogram::Place place_on(const Beam& beam, const Vec3& w, const Vec3& p);
    const Beam& beam_of(const Sky& sky, const Vec3& towards) const;

    const Scene* scene_;
    EmitterDistribution choice_;
    std::vector<Sky> skies_; ///< by emitter; no beams: nothing was learned
};

} // namespace keyhole
