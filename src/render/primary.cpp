// --method pssmlt, mmlt, rjmlt: chains in primary sample space, drawn to the film.
#include "core/parallel.h"
#include "film/splats.h"
#include "render/chain_groups.h"
#include "render/chain_report.h"
#include "render/methods.h"
#include "render/mis_heuristic.h"
#include "render/pass_seed.h"
#include "render/primary_report.h"
#include "render/stage_clock.h"
#include "render/work.h"
#include "sampling/primary/p_large.h"
#include "sampling/primary/primary_chains.h"

#include <fmt/format.h>

#include <cmath>

namespace keyhole {
namespace {

/// The first stretch, in parts of the whole. It learns how often large steps are accepted and fail, with half of the
/// steps large, and draws nothing.
constexpr std::int64_t kStretch = 32;

/// Rounds of the rest: the brightness that weights refer to is brought up to date between them.
constexpr std::int64_t kRounds = 64;

/// Steps of all chains that a stop waits for, at most: a second or two.
constexpr std::int64_t kMostSteps = 1 << 20;

/// In how many parts so many steps of each chain are done, of `least` at least.
std::int64_t parts_of(std::int64_t steps, std::int64_t chains, std::int64_t least) {
    return std::min(steps, std::max(least, steps / std::max<std::int64_t>(1, kMostSteps / chains) + 1));
}

Failures failures_of(std::string_view word) {
    return word == "exclude"         ? Failures::exclude
           : word == "exclude_large" ? Failures::exclude_large
           : word == "delay"         ? Failures::delay
                                     : Failures::reject;
}

PrimaryStart start(const Scene& scene, const Settings& settings, std::uint64_t seed, const EmitterInverse& inverses,
                   RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "brightness");
    const BuilderContext builders{&scene, static_cast<int>(settings.max_depth), mis_heuristic(settings.mis)};
    const PrimaryStartOptions options{.samples = settings.brightness_samples, .seed = seed};
    if (settings.method == "mmlt") return PrimaryStart::by_length(builders, nullptr, options, context);
    if (settings.method == "rjmlt") return PrimaryStart::by_length(builders, &inverses, options, context);
    auto builder = settings.builder == "path"        ? make_path_builder(builders)
                   : settings.builder == "endpoints" ? make_endpoint_builder(builders)
                                                     : make_bidirectional_builder(builders);
    return PrimaryStart::whole(std::move(builder), options, context);
}

/// Learns p_large where it is not prescribed.
double learn_p_large(PrimaryChains& chains, const Settings& settings, std::int64_t steps, RenderStats& stats,
                     const RunContext& context) {
    const std::int64_t parts = parts_of(steps, chains.size(), 1);
    for (std::int64_t i = 0; i < parts && (i == 0 || !context.stopped()); ++i)
        chains.advance({failures_of(settings.failures), 0.5}, split(steps, parts, i).size(), context, nullptr);
    const LargeStepRule rule = large_step_rule(chains.counts());
    const double p = settings.p_large.value.value_or(rule.p_large);
    report_large_steps(rule, p, stats);
    return p;
}

void report(const PrimaryChains& chains, RenderStats& stats) {
    report_steps(chains.counts(), chains.size(), stats);
    if (const ChangeCounts& c = chains.changes(); c.proposed > 0) {
        const auto of_changes = [&](std::uint64_t n) {
            return static_cast<double>(n) / static_cast<double>(c.proposed);
        };
        stats.values["technique changes"] = static_cast<double>(c.proposed);
        stats.values["technique changes accepted"] = of_changes(c.accepted);
        stats.values["technique changes without inverse"] = of_changes(c.no_inverse);
        stats.values["technique changes that drifted"] = of_changes(c.drifted);
    }
}

/// Collects what is to be told of one pass after the other.
class PassReports {
  public:
    void add(const PrimaryChains& chains, RenderStats& stats) {
        RenderStats pass;
        report(chains, pass);
        add_pass(stats, std::move(pass));
        report_agreement(stats, chains.agreement());
        if (passes_ == 0) warn_of_agreement(stats, chains.agreement(), chains.steps());
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
        warn_of_broken(stats, broken_);
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
    const StageClock clock(stats, "chains");
    const ImageWindow& window = scene.camera().window();
    SplatFilm film(window.width, window.height, PixelFilter(settings));
    // Deposits are of the size of the brightness; the film's sums want numbers about 1.
    const double unit = std::exp2(std::round(std::log2(chains.brightness())));
    const auto deposit = [&](const Splat& s, double factor) {
        film.add(window.to_pixel(s.image), SplatFilm::layer_of(s.light), s.value * (factor / unit));
    };
    const std::int64_t per_chain =
        std::max<std::int64_t>(1, settings.mutations / chain_groups(settings) / chains.size());
    context.begin("chains", static_cast<std::uint64_t>(per_chain * chains.size()), "steps");
    const std::int64_t stretch = std::max<std::int64_t>(1, per_chain / kStretch);
    PrimaryKernel kernel{failures_of(settings.failures), learn_p_large(chains, settings, stretch, stats, context)};
    std::int64_t drawn = 0;
    const std::int64_t rest = std::max<std::int64_t>(1, per_chain - stretch),
                       rounds = parts_of(rest, chains.size(), kRounds);
    for (std::int64_t r = 0; r < rounds && (r == 0 || !context.stopped()); ++r) {
        const std::int64_t steps = split(rest, rounds, r).size();
        chains.advance(kernel, steps, context, deposit);
        drawn += steps;
    }
    context.end();
    if (drawn < rest && !work.is_first()) return false;
    work.unit().drawn->add(film, unit * window.pixels() / static_cast<double>(drawn * chains.size()));
    return drawn == rest;
}

} // namespace

RenderResult render_primary(const Scene& scene, const Settings& settings, const RunContext& context,
                            const Share& share) {
    RenderResult result;
    RenderStats& stats = result.stats;
    const EmitterInverse inverses(scene);
    const ImageWindow& window = scene.camera().window();
    const std::int64_t groups = chain_groups(settings);
    Work work(settings, window, Exposure::Parts::drawn, share, groups, Work::PassStart::costly);
    PassReports reports;
    std::optional<PrimaryStart> started;
    std::int64_t pass = -1; // that it is of
    while (const auto unit = work.take(context)) {
        const std::uint64_t seed = seed_of_pass(settings, work.pass_of(*unit));
        if (work.pass_of(*unit) != pass) started.emplace(start(scene, settings, seed, inverses, stats, context));
        pass = work.pass_of(*unit);
        const auto group = static_cast<std::uint64_t>(*unit % groups);
        PrimaryChains chains(started->choose_seeds(settings.chains / groups, group), seed,
                             settings.large_step_mis == "on", group);
        bool whole = !context.stopped();
        if (!whole && !work.is_first()) break;
        if (chains.size() > 0) {
            whole = draw(chains, scene, settings, work, stats, context) && whole;
            if (whole || work.is_first()) reports.add(chains, stats);
        } else {
            work.unit().drawn->add(SplatFilm(window.width, window.height), 0);
        }
        if (whole) work.end_unit(stats);
    }
    reports.finish(stats);
    result.picture = work.finish(stats);
    return result;
}

} // namespace keyhole
