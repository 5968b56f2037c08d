// Another technique for the same path: reversible jumps between the primary sample spaces of techniques.
#pragma once

#include "sampling/paths/path.h"
#include "sampling/primary/path_builder.h"
#include "sampling/primary/primary_state.h"
#include "scene/scene.h"

#include <array>
#include <optional>
#include <vector>

namespace keyhole {

// From paths back to primary samples: numbers that make a sampling routine take the choice that it took. Where several
// do, one of them is drawn uniformly (Bitterli et al. 2017, "probabilistic inverses").

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

/// What became of reversible jumps.
struct ChangeCounts {
    std::uint64_t proposed = 0, no_inverse = 0, accepted = 0;
    std::uint64_t drifted = 0; ///< rounding led another way when the path was made again

    ChangeCounts& operator+=(const ChangeCounts& o) {
        proposed += o.proposed;
        no_inverse += o.no_inverse;
        accepted += o.accepted;
        drifted += o.drifted;
        return *this;
    }
};

/// A move of a chain over multiplexed paths, after Bitterli, Jakob, Novak and Jarosz 2017 ("Reversible Jump Metropolis
/// Light Transport Using Inverse Mappings"): keeps the path, chooses another of its techniques evenly, and finds the
/// primary samples with which that one makes it. Their densities cancel the Jacobian, and the ratio of the MIS weights
/// remains. Vertices that change sides must have inverses from either side, or the chain stays.
class ReversibleJump {
  public:
    /// `emitters` must outlive this.
    ReversibleJump(const BuilderContext& context, const EmitterInverse& emitters, int scatterings)
        : c_(context), emitters_(&emitters), scatterings_(scatterings) {}

    /// One move. Returns whether the state changed.
    bool move(PrimaryState& state, Rng& rng, ChangeCounts& counts) const;

  private:
    struct Edit;
    class Edits;
    std::optional<Connection> connection(PrimaryState& state) const;
    bool edit(const Path& path, int from, int to, Rng& rng, Edits& edits) const;
    bool set_eye_number(const Path& path, int j, bool used, Rng& rng, Edits& edits) const;
    bool set_light_number(const Path& path, int j, bool used, Rng& rng, Edits& edits) const;

    BuilderContext c_;
    const EmitterInverse* emitters_;
    int scatterings_;
};

} // namespace keyhole
