#include "methods/chain_report.h"

#include "session/stage_clock.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole {
namespace {

/// Beyond these a set of chains is not to be trusted.
constexpr double kMostStuck = 0.02; ///< share of the chains
constexpr double kMostRHat = 1.5;   ///< independent draws in 16 parts stay below 1.15; see docs/proposals.md
constexpr double kMostError = 0.1;  ///< of the brightness of a block

void warn_of_chains(RenderStats& stats, const ChainSummary& chains) {
    const auto steps = chains.steps_per_chain();
    if (static_cast<double>(chains.stuck) > kMostStuck * static_cast<double>(chains.chains))
        stats.warnings.push_back(fmt::format(
            "{} of {} chains spent more than half of their {} steps on a single path: expect hot spots that are not "
            "there. Try more mutations",
            chains.stuck, chains.chains, steps));
    warn_of_convergence(stats, chains.convergence, static_cast<std::int64_t>(steps));
}

void warn_of_brightness(RenderStats& stats, bool stopped) {
    if (!(stats.brightness > 0))
        stats.warnings.emplace_back(
            stopped ? "stopped before any indirect light or caustic was found: only direct light is "
                      "rendered"
                    : "no sampled path carried indirect light or a caustic: only direct light is "
                      "rendered. If there is more, try more brightness_samples");
    else if (stats.brightness_error > 0.05 * stats.brightness)
        stats.warnings.push_back(
            fmt::format("the brightness of indirect light is known to {:.0f} % only (standard error): "
                        "raise brightness_samples",
                        100 * stats.brightness_error / stats.brightness));
}

void report_chains(RenderStats& stats, const Mixture<Path>& mixture, const ChainSummary& chains) {
    LedgerEntry all;
    for (std::size_t k = 0; k < chains.ledger.size(); ++k) {
        const LedgerEntry& e = chains.ledger[k];
        all += e;
        ProposalStats line{std::string(mixture.kind(k).name()),
                           e.proposed,
                           e.zero,
                           e.nan,
                           e.rejected,
                           e.accepted,
                           {},
                           e.seconds,
                           e.deposited / static_cast<double>(std::max<std::uint64_t>(1, chains.steps))};
        for (std::size_t f = 0; f < kFailures; ++f) line.failed[std::string(kFailureNames[f])] = e.failed[f];
        stats.proposals.push_back(line);
    }
    stats.values["chains"] = static_cast<double>(chains.chains);
    stats.values["mutations"] = static_cast<double>(chains.steps);
    stats.values["chains, longest rejection run"] = static_cast<double>(chains.longest_rejection_run);
    stats.values["chains, stuck"] = static_cast<double>(chains.stuck);
    if (all.proposed > 0)
        stats.values["chains, acceptance"] = static_cast<double>(all.accepted) / static_cast<double>(all.proposed);
    report_convergence(stats, chains.convergence);
    if (chains.guidance) {
        stats.values["user paths, variance of block brightness with"] = chains.guidance->with;
        stats.values["user paths, variance of block brightness without"] = chains.guidance->without;
        stats.values["user paths, chains without"] = static_cast<double>(chains.guidance->chains_without);
    }
    warn_of_chains(stats, chains);
}

} // namespace

void report_convergence(RenderStats& stats, const std::optional<ConvergenceDiagnostic>& found) {
    if (!found) return;
    stats.agreement = {found->r_hat, found->error};
}

void warn_of_convergence(RenderStats& stats, const std::optional<ConvergenceDiagnostic>& found, std::int64_t steps) {
    if (!found) {
        stats.warnings.push_back(fmt::format(
            "the chains made {} steps each, too few to tell whether they agree: what they draw can't be trusted. Try "
            "more mutations",
            steps));
    } else if (found->r_hat > kMostRHat && found->error > kMostError) {
        stats.warnings.push_back(
            fmt::format("independent groups of chains disagree on the brightness of parts of the image (split R-hat "
                        "{:.2f}, {:.0f} % standard error): what they draw can't be trusted. Try more mutations",
                        found->r_hat, 100 * found->error));
    }
}

void add_ledger(std::vector<ProposalStats>& lines, const std::vector<ProposalStats>& more) {
    const auto mutations = [](const std::vector<ProposalStats>& of) {
        double sum = 0;
        for (const ProposalStats& line : of) sum += static_cast<double>(line.proposed);
        return sum;
    };
    const double added = mutations(more), all = mutations(lines) + added;
    for (std::size_t k = 0; k < more.size() && k < lines.size(); ++k) {
        if (all > 0) lines[k].deposited += (more[k].deposited - lines[k].deposited) * added / all;
        lines[k].proposed += more[k].proposed;
        lines[k].zero += more[k].zero;
        lines[k].nan += more[k].nan;
        lines[k].rejected += more[k].rejected;
        lines[k].accepted += more[k].accepted;
        for (const auto& [reason, n] : more[k].failed) lines[k].failed[reason] += n;
        lines[k].seconds += more[k].seconds;
    }
}

void add_pass(RenderStats& stats, RenderStats pass) {
    add_ledger(pass.proposals, stats.proposals);
    stats.proposals = std::move(pass.proposals);
    for (const auto& [name, value] : pass.values) stats.values[name] = value;
}

StageOne ChainReports::measure_brightness(const Scene& scene, const StageOneSettings& settings, RenderStats& stats,
                                          const RunContext& context) {
    const StageClock clock(stats, stages::brightness);
    StageOne one = run_stage_one(scene, settings, context);
    stopped_ = !one.is_whole();
    brightness_.merge(one.brightness);
    stats.brightness = brightness_.mean();
    stats.brightness_error = brightness_.standard_error();
    stats.values["brightness of caustics"] = one.caustic.mean();
    stats.values["brightness of caustics, error"] = one.caustic.standard_error();
    stats.values["brightness by bidirectional tracing"] = one.technique == Technique::bidirectional ? 1 : 0;
    stats.values["brightness samples"] = static_cast<double>(one.samples);
    return one;
}

void ChainReports::add(const Mixture<Path>& mixture, const ChainSummary& chains, RenderStats& stats) {
    RenderStats pass;
    report_chains(first_ ? stats : pass, mixture, chains);
    add_ledger(stats.proposals, pass.proposals);
    first_ = false;
}

void ChainReports::finish(RenderStats& stats) const {
    warn_of_brightness(stats, stopped_);
    for (const ProposalStats& p : stats.proposals)
        if (p.nan > 0)
            stats.warnings.push_back(
                fmt::format("{} proposals '{}' had a density or value that is not a number", p.nan, p.name));
}

} // namespace keyhole
