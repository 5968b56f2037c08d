// Importance guides of both maps.
#pragma once

#include "methods/photons/photon_sampler.h"
#include "photonmap/photon_weighing.h"

#include <memory>

namespace keyhole {

struct Guides {
    std::unique_ptr<ImportanceGuide> global, caustic; ///< null: there is none

    EmissionGuide both() const { return {global.get(), caustic.get()}; }
};

/// Traces `importons` eye paths, or as many as guides need, and makes guides of them, that of the caustic map where
/// there is to be one. Puts their figures into `stats`.
Guides make_guides(const SamplerContext& c, std::uint64_t seed, std::int64_t importons, RenderStats& stats,
                   const RunContext& context);

} // namespace keyhole
