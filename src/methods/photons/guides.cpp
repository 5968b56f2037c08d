#include "methods/photons/guides.h"

#include "methods/photons/radii.h"
#include "photonmap/importance/importance_tracing.h"
#include "session/stage_clock.h"

#include <algorithm>

namespace keyhole {
namespace {

/// A guide needs fewer importons than power that is divided by what they say.
constexpr std::int64_t kMostImportons = 100'000;

} // namespace

Guides make_guides(const SamplerContext& c, std::uint64_t seed, std::int64_t importons, RenderStats& stats,
                   const RunContext& context) {
    const StageClock clock(stats, stages::importance);
    const bool delta = c.caustics;
    Importons traced = trace_importance(c.scene,
                                        {.samples = std::min(importons, kMostImportons),
                                         .at_d1 = delta,
                                         .max_scatterings = static_cast<int>(c.settings.max_depth),
                                         .seed = seed,
                                         .weight = c.weight},
                                        context);
    const float radius = Radii(c.scene).importance;
    stats.importons = 0;
    const auto make = [&](std::vector<Photon>&& from) {
        const PhotonMap map(std::move(from));
        auto guide = std::make_unique<ImportanceGuide>(map, radius, c.patches, &c.scene, context);
        stats.importons += map.photons().size();
        const std::size_t waiting = traced.first.capacity() * sizeof(Photon);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, map.bytes() + guide->bytes() + waiting);
        return guide;
    };
    Guides guides;
    guides.global = make(std::move(traced.second));
    if (delta) guides.caustic = make(std::move(traced.first));
    stats.importon_bytes = guides.global->bytes() + (guides.caustic ? guides.caustic->bytes() : 0);
    return guides;
}

} // namespace keyhole
