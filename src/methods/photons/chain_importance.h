// What samplers whose photons come from chains over whole paths share.
#pragma once

#include "methods/photons/photon_sampler.h"
#include "photonmap/deposit.h"
#include "photonmap/importance/importance_map.h"
#include "photonmap/importance/importance_tracing.h"
#include "sampling/brightness.h"

namespace keyhole {

/// The importance maps that photons of chains get their power from.
struct ChainImportance {
    ImportanceMap at_d1, at_d2;

    /// Traces `importons` eye paths.
    ChainImportance(const SamplerContext& context, std::uint64_t seed, std::int64_t importons, const RunContext& run);
    void report(RenderStats& stats) const;

    /// For power by the rule of the settings.
    DepositOptions deposit(const SamplerContext& context) const;
    std::size_t bytes() const { return at_d1.bytes() + at_d2.bytes(); }

  private:
    ChainImportance(const SamplerContext& context, Importons&& importons);
};

/// Each photon weighs the same where it is asked, so the maps share the ceiling as they share the light.
std::size_t photons_for_caustic(const SamplerContext& context, const StageOne& one, std::size_t photons);

/// Of a pass with such settings and seed.
StageOneSettings stage_one_settings(const SamplerContext& context, std::uint64_t seed, const GuidedPaths& guides);

void report_power(const PathDepositor::Tally& tally, RenderStats& stats);

} // namespace keyhole
