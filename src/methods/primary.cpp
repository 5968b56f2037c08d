// --method pssmlt (Kelemen et al. 2002), mmlt (Hachisuka, Kaplanyan and Dachsbacher 2014) and rjmlt (after Bitterli et
// al. 2017): chains in primary sample space, drawn to the film.
#include "core/parallel.h"
#include "film/splats.h"
#include "methods/chain_report.h"
#include "methods/method.h"
#include "methods/sample_report.h"
#include "sampling/markov/chain_rounds.h"
#include "sampling/primary/primary_chains.h"
#include "sampling/primary/primary_kernel.h"
#include "session/passes.h"
#include "session/stage_clock.h"
#include "session/work.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace keyhole {
namespace {

/// Rounds after the first batch: the brightness that weights refer to is brought up to date between them.
constexpr std::int64_t kRounds = 64;

/// Steps of all chains in a round at most.
constexpr std::int64_t kMostSteps = 1 << 20;

/// So many steps of each chain, in `least` rounds at least.
ChainRounds rounds_of(std::int64_t steps, std::int64_t chains, std::int64_t least) {
    return ChainRounds::even(
        steps, std::min(steps, std::max(least, steps / std::max<std::int64_t>(1, kMostSteps / chains) + 1)));
}

/// Stage one; the methods differ in it.
struct StageOneTask {
    BuilderContext builders;
    const EmitterInverse& inverses;
    const Settings& settings;
    PrimaryStartOptions options;
    const RunContext& context;
};
using StageOneOf = PrimaryStart (*)(const StageOneTask&);

PrimaryStart start_pssmlt(const StageOneTask& t) {
    auto builder = t.settings.builder == PathBuilderKind::path        ? make_path_builder(t.builders)
                   : t.settings.builder == PathBuilderKind::endpoints ? make_endpoint_builder(t.builders)
                                                                      : make_bidirectional_builder(t.builders);
    return PrimaryStart::whole(std::move(builder), t.options, t.context);
}
PrimaryStart start_mmlt(const StageOneTask& t) {
    return PrimaryStart::by_length(t.builders, nullptr, t.options, t.context);
}
PrimaryStart start_rjmlt(const StageOneTask& t) {
    return PrimaryStart::by_length(t.builders, &t.inverses, t.options, t.context);
}

ProposalStats line(std::string name, const StepCounts& c) {
    return {std::move(name),         c.proposed, 0, 0, c.proposed - c.failed - c.accepted, c.accepted,
            {{"no_path", c.failed}}, 0};
}

/// What the rule for large steps said, and the probability `p` that is used.
void report_large_steps(const LargeStepRule& rule, double p, RenderStats& stats) {
    stats.values["p_large"] = p;
    stats.values["p_large by the rule"] = rule.p_large;
    stats.values["p_large by its first branch"] = rule.by_formula ? 1 : 0;
    stats.values["eta_s"] = rule.eta_s;
    stats.values["eta_l"] = rule.eta_l;
    stats.values["eta_0"] = rule.eta_0;
}

/// The ledger and the figures of the chains of a pass.
void report(const PrimaryChains& chains, RenderStats& stats) {
    const PrimaryCounts counts = chains.counts();
    stats.proposals = {line("small step", counts.small), line("large step", counts.large),
                       line("delayed rejection", counts.delayed)};
    const auto share = [&](std::uint64_t n) {
        return static_cast<double>(n) / static_cast<double>(counts.proposals());
    };
    stats.values["chains"] = static_cast<double>(chains.size());
    stats.values["mutations"] = static_cast<double>(counts.proposals());
    stats.values["steps"] = static_cast<double>(counts.steps());
    stats.values["failure rate"] = share(counts.small.failed + counts.large.failed);
    stats.values["acceptance rate"] = share(counts.small.accepted + counts.large.accepted + counts.delayed.accepted);
    stats.values["remedied paths"] = share(counts.remedied());
    if (const ChangeCounts& c = chains.changes(); c.proposed > 0) {
        const auto of_changes = [&](std::uint64_t n) {
            return static_cast<double>(n) / static_cast<double>(c.proposed);
        };
        stats.values["reversible jumps"] = static_cast<double>(c.proposed);
        stats.values["reversible jumps accepted"] = of_changes(c.accepted);
        stats.values["reversible jumps without inverse"] = of_changes(c.no_inverse);
        stats.values["reversible jumps that drifted"] = of_changes(c.drifted);
    }
}

/// Collects what is to be told of one pass after the other.
class PassReports {
  public:
    void add(const PrimaryChains& chains, RenderStats& stats) {
        RenderStats pass;
        report(chains, pass);
        add_pass(stats, std::move(pass));
        report_convergence(stats, chains.convergence());
        if (passes_ == 0) warn_of_convergence(stats, chains.convergence(), chains.steps());
        broken_ += chains.broken();
        brightness_ += chains.brightness();
        variance_ += chains.brightness_error() * chains.brightness_error();
        ++passes_;
    }

    void finish(RenderStats& stats) const {
        if (passes_ == 0) {
            stats.warnings.emplace_back("no sampled path carried light: the picture is black. If there is any, try "
                                        "more brightness_samples");
            return;
        }
        stats.brightness = brightness_ / passes_;
        stats.brightness_error = std::sqrt(variance_) / passes_;
        if (broken_ > 0)
            stats.warnings.push_back(fmt::format("{} candidates had a value that is not a number", broken_));
        if (stats.brightness_error > 0.05 * stats.brightness)
            stats.warnings.push_back(
                fmt::format("the brightness of the picture is known to {:.0f} % only (standard error): "
                            "raise brightness_samples",
                            100 * stats.brightness_error / stats.brightness));
    }

  private:
    std::uint64_t broken_ = 0;
    double brightness_ = 0, variance_ = 0; // sums over passes
    double passes_ = 0;
};

/// Runs the chains of a group and adds what they draw. Returns whether they got to their end.
bool draw(PrimaryChains& chains, const Scene& scene, const Settings& settings, Work& work, RenderStats& stats,
          const RunContext& context) {
    const StageClock clock(stats, stages::chains);
    const ImageWindow& window = scene.camera().window();
    SplatFilm film(window.width, window.height, PixelFilter(settings), chains.brightness());
    const auto deposit = [&](const Splat& s, double factor) {
        film.add(window.to_pixel(s.image), SplatFilm::layer_of(s.light), s.value * factor);
    };
    const std::int64_t per_chain =
        std::max<std::int64_t>(1, settings.mutations / chain_groups(settings) / chains.size());
    const LearningBatch batch(per_chain);
    const ProgressStage progress(context, "chains", per_chain * chains.size(), "steps");
    rounds_of(batch.steps, chains.size(), 1).run(context, [&](std::int64_t n) {
        chains.advance({settings.failures, 0.5}, n, context);
    });
    const LargeStepRule rule = large_step_rule(chains.counts());
    const PrimaryKernel kernel{settings.failures, settings.p_large.value.value_or(rule.p_large)};
    report_large_steps(rule, kernel.p_large, stats);
    std::int64_t drawn = 0; // less than its rounds where one of them was stopped
    rounds_of(batch.rest, chains.size(), kRounds).run(context, [&](std::int64_t n) {
        drawn += chains.advance(kernel, n, context, deposit);
    });
    if (drawn < batch.rest && !work.is_first()) return false;
    work.unit().drawn->add(film, window.pixels() / static_cast<double>(drawn * chains.size()), work.half());
    return drawn == batch.rest;
}

template <StageOneOf start> RenderResult render_primary(const RenderTask& task) {
    const auto& [scene, settings, paths, context, share, findings, observer] = task;
    RenderResult result;
    RenderStats& stats = result.stats;
    const EmitterInverse inverses(scene);
    const ImageWindow& window = scene.camera().window();
    const std::int64_t groups = chain_groups(settings);
    Work work(settings, window, AccumulationBuffer::Parts::drawn, share, groups, Work::PassStart::costly);
    PassReports reports;
    std::optional<PrimaryStart> started;
    std::int64_t pass = -1; // that it is of
    while (const auto unit = work.take(context)) {
        const std::uint64_t seed = seed_of_pass(settings, work.pass_of(*unit));
        if (work.pass_of(*unit) != pass) {
            const StageClock clock(stats, stages::brightness);
            started.emplace(start({{&scene, static_cast<int>(settings.max_depth), settings.mis},
                                   inverses,
                                   settings,
                                   {.samples = settings.brightness_samples, .seed = seed},
                                   context}));
        }
        pass = work.pass_of(*unit);
        const auto group = static_cast<std::uint64_t>(*unit % groups);
        const Range own = chains_of_group(static_cast<std::size_t>(settings.chains), groups, *unit % groups);
        PrimaryChains chains(started->choose_seeds(own.size(), group), seed, settings.large_step_mis, group);
        bool whole = !context.stopped();
        if (!whole && !work.is_first()) break;
        if (chains.size() > 0) {
            whole = draw(chains, scene, settings, work, stats, context) && whole;
            if (whole || work.is_first()) reports.add(chains, stats);
        } else {
            work.unit().drawn->add(SplatFilm(window.width, window.height), 0, work.half());
        }
        if (whole) work.end_unit(stats);
    }
    reports.finish(stats);
    report_lost_caustics(scene, stats);
    report_sun_behind_glass(scene, stats);
    result.picture = work.finish(stats);
    return result;
}

} // namespace

constinit const Method methods::pssmlt{.name = "pssmlt",
                                       .help = "Metropolis light transport in primary sample space",
                                       .scatters_in_media = true,
                                       .trial = {.share = 0.07, .doubt = 1.5, .needless_below = 0.05},
                                       .render = render_primary<start_pssmlt>};

// Samples of all techniques, which stage one of these takes, cost as much as many of their steps.
constinit const Method methods::mmlt{.name = "mmlt",
                                     .help = "the same as pssmlt, with chains for each length of path",
                                     .scatters_in_media = true,
                                     .trial = {.share = 0.12, .by_work = true, .doubt = 1.5, .needless_below = 0.05},
                                     .mutations_of_effort = 1500e3,
                                     .brightness_samples_of_effort = 50e3,
                                     .render = render_primary<start_mmlt>};

constinit const Method methods::rjmlt{.name = "rjmlt",
                                      .help = "mmlt that changes techniques by reversible jumps",
                                      .trial = {.share = 0.07, .doubt = 1.5, .needless_below = 0.05},
                                      .mutations_of_effort = 1500e3,
                                      .brightness_samples_of_effort = 50e3,
                                      .render = render_primary<start_rjmlt>};

} // namespace keyhole
