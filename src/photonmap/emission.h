// Photons by light tracing: standard photon mapping (Jensen 2001), or emission with importance storing.
#pragma once

#include "core/progress.h"
#include "photonmap/map_stores.h"
#include "photonmap/photon_weighing.h"
#include "photonmap/photons.h"
#include "sampling/guidance/guided_subpath.h"
#include "sampling/guidance/learned/learned_emission.h"
#include "sampling/guidance/learned/learned_scattering.h"
#include "scene/scene.h"

#include <cstdint>

namespace keyhole {

struct EmissionOptions {
    std::int64_t paths;  ///< light paths traced
    std::size_t photons; ///< ceiling for both maps together; they share it as they share the weight of what arrives
    StorageRule rule{};
    std::uint64_t seed;
    LightGuides user_paths{};                 ///< that half of the light paths follow, where there are any
    const LearnedEmission* learned = nullptr; ///< where the others begin; null: by power
    const LearnedScattering* scattering =
        nullptr; ///< where light paths go on if there are no user paths; null: by BSDFs alone. Not with weights
    const TechniqueWeights* weights = nullptr; ///< where chains make photons of the same maps; null: they don't
    bool cut_outliers =
        false; ///< whether photons whose visible power stands for that of thousands lose what is too much
    PhotonObserver* observer = nullptr; ///< null: nobody watches
};

/// What light tracing has done.
struct Emission {
    std::int64_t paths = 0;
    std::uint64_t arrivals = 0; ///< photons that could have been stored
    double cut = 0;             ///< share of the visible power that outliers lost

    double scale() const; ///< of the weights that were stored
};

struct EmittedPhotons : Photons, Emission {
    std::size_t bytes = 0; ///< of the stores
};

/// How much of plain light tracing brings what is seen: PhotonWeights::share_seen() of the first few thousand of so
/// many paths, by the visible power that the guide gives to their photons.
double share_of_photons_seen(const Scene& scene, const EmissionGuide& guide, const StorageRule& rule,
                             std::int64_t paths, std::uint64_t seed, const RunContext& context);

/// Traces light paths and stores a photon at every vertex where a map can be asked (see docs/photon-maps.md): in the
/// global map unless light came straight from the emitter, and, if it came through specular vertices only or from
/// outside the coverage of gather rays, in the caustic map as well; each map is complete by itself.
///
/// With a guide a photon is kept with probability min(1, Y(Phi E) / t), and weighed by the reciprocal (after Keller and
/// Wald 2000); t follows from the ceilings. E decides what is kept and nothing else: its errors bias no expectation.
/// Where E is unknown photons share a small part of the store by their power. Reproducible on any number of threads.
EmittedPhotons emit_photons(const Scene& scene, const EmissionGuide& guide, const EmissionOptions& options,
                            const RunContext& context);

/// The same into `stores`; nothing is said of how many photons these hold.
Emission emit_photons(const Scene& scene, const EmissionGuide& guide, const EmissionOptions& options, MapStores& stores,
                      const RunContext& context);

} // namespace keyhole
