#include "methods/photons/chain_importance.h"

#include "methods/photons/radii.h"

#include <cmath>

namespace keyhole {
namespace {

ImportanceOptions lookups(const SamplerContext& c) {
    return {.k = 50, .max_radius = Radii(c.scene).importance, .patches = &c.patches};
}

} // namespace

ChainImportance::ChainImportance(const SamplerContext& c, std::uint64_t seed, std::int64_t importons,
                                 const RunContext& run)
    : ChainImportance(c, trace_importance(c.scene, c.importance_tracing(importons, seed), run)) {}

ChainImportance::ChainImportance(const SamplerContext& c, Importons&& importons)
    : at_d1(std::move(importons.first), lookups(c)), at_d2(std::move(importons.second), lookups(c)) {}

void ChainImportance::report(RenderStats& stats) const {
    stats.importons = at_d1.map().photons().size() + at_d2.map().photons().size();
    stats.importon_bytes = bytes();
}

DepositOptions ChainImportance::deposit(const SamplerContext& c) const {
    return {.global = &at_d2,
            .caustic = &at_d1,
            .rule = c.settings.power,
            .scene = &c.scene,
            .set = c.path_set(),
            .max_scatterings = static_cast<int>(c.settings.max_depth),
            .observer = c.observer};
}

std::size_t photons_for_caustic(const SamplerContext& c, const StageOne& one, std::size_t photons) {
    return c.caustics ? photons_for_caustic(one.caustic.mean() / one.brightness.mean(), photons) : 0;
}

StageOneSettings stage_one_settings(const SamplerContext& c, std::uint64_t seed, const GuidedPaths& guides) {
    return {.set = c.path_set(),
            .max_scatterings = static_cast<int>(c.settings.max_depth),
            .samples = c.settings.brightness_samples,
            .error = c.settings.brightness_error,
            .seed = seed,
            .guides = c.user_paths.empty() ? nullptr : &guides};
}

void report_power(const PathDepositor::Tally& t, RenderStats& stats) {
    stats.values["share of power without importance"] = t.total > 0 ? t.lost / t.total : 0;
    // How unequal photons are: what the rule in force makes of them, and what MPS 3.2 would.
    const auto variation = [](const RunningStats& s) { return s.mean() > 0 ? std::sqrt(s.variance()) / s.mean() : 0; };
    stats.values["photon power, coefficient of variation"] = variation(t.power);
    stats.values["photon power, coefficient of variation, literal"] = variation(t.literal_power);
    stats.values["photons with power by drawing camera sub-paths"] = static_cast<double>(t.untrusted);
    stats.values["camera sub-paths drawn"] = static_cast<double>(t.draws);
}

} // namespace keyhole
