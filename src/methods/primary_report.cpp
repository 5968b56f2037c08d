#include "methods/primary_report.h"

#include <fmt/format.h>

#include <utility>

namespace keyhole {
namespace {

ProposalStats line(std::string name, const StepCounts& c) {
    return {std::move(name),         c.proposed, 0, 0, c.proposed - c.failed - c.accepted, c.accepted,
            {{"no_path", c.failed}}, 0};
}

} // namespace

void report_large_steps(const LargeStepRule& rule, double p, RenderStats& stats) {
    stats.values["p_large"] = p;
    stats.values["p_large by the rule"] = rule.p_large;
    stats.values["p_large by its first branch"] = rule.by_formula ? 1 : 0;
    stats.values["eta_s"] = rule.eta_s;
    stats.values["eta_l"] = rule.eta_l;
    stats.values["eta_0"] = rule.eta_0;
}

void report_steps(const PrimaryCounts& counts, std::int64_t chains, RenderStats& stats) {
    stats.proposals = {line("small step", counts.small), line("large step", counts.large),
                       line("delayed rejection", counts.delayed)};
    const auto share = [&](std::uint64_t n) {
        return static_cast<double>(n) / static_cast<double>(counts.proposals());
    };
    stats.values["chains"] = static_cast<double>(chains);
    stats.values["mutations"] = static_cast<double>(counts.proposals());
    stats.values["steps"] = static_cast<double>(counts.steps());
    stats.values["failure rate"] = share(counts.small.failed + counts.large.failed);
    stats.values["acceptance rate"] = share(counts.small.accepted + counts.large.accepted + counts.delayed.accepted);
    stats.values["remedied paths"] = share(counts.remedied());
}

void warn_of_broken(RenderStats& stats, std::uint64_t broken) {
    if (broken > 0) stats.warnings.push_back(fmt::format("{} candidates had a value that is not a number", broken));
}

} // namespace keyhole
