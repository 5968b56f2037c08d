// What the methods that render from photon maps differ in.
#pragma once

#include "core/progress.h"
#include "core/render_stats.h"
#include "core/settings.h"
#include "photonmap/importance/importance_tracing.h"
#include "photonmap/photon_weighing.h"
#include "photonmap/photons.h"
#include "photonmap/surface/surface_patches.h"
#include "sampling/guidance/user_paths.h"
#include "sampling/paths/path_set.h"
#include "scene/scene.h"

#include <optional>

namespace keyhole {

struct WorkShares {
    double chains; ///< of `mutations`; light paths get the rest of `light_paths`
    /// So many steps of a chain count as one independent sample in the weights of its photons: neighbouring states know
    /// of each other. Nothing is biased, whatever it is.
    double correlation;
};

/// Stages one and two of a pass: everything up to the photons. Called for one pass after the other.
class PhotonSampler {
  public:
    virtual ~PhotonSampler() = default;

    /// The photons of a pass that are independent of those of other passes. `seed` is that of the pass. Adds what it
    /// did to `stats`.
    virtual Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) = 0;
    /// Says what the last pass leaves to be said.
    virtual void finish(RenderStats& /*stats*/) {}
};

/// What a sampler works with. All must outlive it.
struct SamplerContext {
    const Scene& scene;
    const Settings& settings;
    const SurfacePatches& patches;
    const UserPaths& user_paths;                 ///< for chains, and for emission by importance
    bool caustics = true;                        ///< whether there is to be a caustic map
    const GatherCoverage* coverage = nullptr;    ///< of gather rays; null: they come everywhere
    const ImageWeight* weight = nullptr;         ///< of pixels; null: photons follow the light
    std::optional<WorkShares>* shares = nullptr; ///< of cps, found by trial for this render and those that follow
    PhotonObserver* observer = nullptr;          ///< of the photons that a render is made from; null: nobody watches
    bool keeps_units = false;                    ///< what is cut short is of no use then

    /// With so much of the time in reserve for later stages; none where all have to be whole.
    RunContext with_reserve(const RunContext& context, double share) const {
        return keeps_units ? context : context.with_reserve(share);
    }
    /// The paths that chains sample.
    PathSet path_set() const { return {settings.paths == SampledPaths::all, coverage, weight}; }
    /// What goes to which map.
    StorageRule storage() const { return {static_cast<int>(settings.max_depth), caustics, coverage}; }
    /// Of so many importons for what goes there.
    ImportanceTracing importance_tracing(std::int64_t importons, std::uint64_t seed) const {
        return {.samples = importons,
                .at_d1 = caustics,
                .max_scatterings = static_cast<int>(settings.max_depth),
                .seed = seed,
                .weight = weight};
    }
};

} // namespace keyhole
