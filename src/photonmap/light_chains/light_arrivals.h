// What one vector of primary samples of a light sub-path makes: photons.
#pragma once

#include "photonmap/photon.h"
#include "photonmap/photon_weighing.h"
#include "scene/scene.h"

#include <array>
#include <vector>

namespace keyhole {

/// The walk's numbers and those of its roulette are kept apart, so that one does not shift the others.
struct LightSources {
    SampleSource &light, &roulette;

    std::array<SampleSource*, 2> all() const { return {&light, &roulette}; }
};

/// A photon that a light sub-path may leave.
struct Arrival {
    Photon photon; ///< power [W] of weight 1
    float weight;
    PhotonKind kind;
    bool known; ///< whether importance said so
};

/// The photons of a sub-path, and the scalar that a chain samples in proportion to: Y(f_map E), summed over them.
class LightArrivals {
  public:
    double target() const { return target_; } ///< 0: a failed sample
    const std::vector<Arrival>& arrivals() const { return arrivals_; }
    bool broken() const { return broken_; } ///< a value was not a number and was left out

    void clear() {
        arrivals_.clear();
        target_ = 0;
        broken_ = false;
    }
    /// Light of RGB `power` [W] at `v` from `to_light`; `caustic`: see Photon.
    void add(PhotonKind kind, const Vertex& v, const Vec3& to_light, const Rgb& power, bool caustic,
             const PhotonWeighing::Weight& weight);

  private:
    std::vector<Arrival> arrivals_;
    double target_ = 0;
    bool broken_ = false;
};

/// Maps primary samples to light sub-paths, and these to a photon at every vertex where a map can be asked, in each map
/// as in emit_photons(). Immutable and thread-safe.
class LightBuilder {
  public:
    using Sources = LightSources;
    using Sample = LightArrivals;

    /// `scene` and the guides must outlive it.
    LightBuilder(const Scene& scene, const PhotonWeighing& weighing, const StorageRule& rule)
        : scene_(&scene), weighing_(weighing), rule_(rule) {}

    /// Fills `sample`, which is empty. It stays so where nothing is stored.
    void build(LightSources sources, LightArrivals& sample) const;

  private:
    void store(PhotonKind kind, const Vertex& v, const Vec3& to_light, const Rgb& power, bool caustic,
               LightArrivals& sample) const;

    const Scene* scene_;
    PhotonWeighing weighing_;
    StorageRule rule_;
};

} // namespace keyhole
