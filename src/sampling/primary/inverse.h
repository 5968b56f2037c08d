// From paths back to primary samples: numbers that make a sampling routine take the choice that it took. Where several
// do, one of them is drawn uniformly (Bitterli, Jakob, Novak and Jarosz 2017, "probabilistic inverses").
#pragma once

#include "sampling/paths/path.h"
#include "scene/scene.h"

#include <array>
#include <optional>
#include <vector>

namespace keyhole {

/// The three numbers with which the BSDF at `v`, reached along `back`, continues along `to` by v.event. None for models
/// without an inverse: diffuse, mirrors, smooth and rough conductors and smooth glass have one.
std::optional<std::array<double, 3>> invert_bsdf(const Vertex& v, const Vec3& back, const Vec3& to, SampleSource& rng);

/// Inverses of the sampling of emitters. Immutable and thread-safe.
class EmitterInverse {
  public:
    /// `scene` must outlive this.
    explicit EmitterInverse(const Scene& scene);

    /// The numbers with which sample_emitter() makes `point`. None but for one-sided triangle meshes that emit.
    std::optional<std::array<double, 4>> point(const SurfacePoint& point, SampleSource& rng) const;

    /// The numbers with which its emitter sends a ray from `point` along `w`; for points that point() inverts.
    std::array<double, 2> ray(const SurfacePoint& point, const Vec3& w) const;

  private:
    const Scene* scene_;
    std::vector<double> choice_;                 ///< running sum of the probabilities of emitters
    std::vector<EmitterDistribution> triangles_; ///< by shape, where it emits
};

} // namespace keyhole
