#include "cli/words/report.h"

#include "cli/words/figures.h"
#include "cli/words/tell.h"
#include "cli/words/units.h"

#include <fmt/format.h>

#include <cstdio>

namespace keyhole {
namespace {

void print_proposals(const std::vector<ProposalStats>& proposals) {
    tell("{:<28}{:>12}{:>9}{:>9}{:>9}{:>9}{:>6}{:>10}{:>9}\n", "proposal", "proposed", "failed", "zero", "rejected",
         "accepted", "NaN", "seconds", "deposits");
    for (const ProposalStats& p : proposals) {
        std::uint64_t failed = 0;
        for (const auto& [reason, n] : p.failed) failed += n;
        const auto percent = [&](std::uint64_t n) {
            return p.proposed == 0
                       ? std::string("-")
                       : fmt::format("{:.1f} %", 100.0 * static_cast<double>(n) / static_cast<double>(p.proposed));
        };
        tell("{:<28}{:>12}{:>9}{:>9}{:>9}{:>9}{:>6}{:>10.2f}{:>9}\n", p.name, p.proposed, percent(failed),
             percent(p.zero), percent(p.rejected), percent(p.accepted), p.nan, p.seconds,
             fmt::format("{:.2f} %", 100 * p.deposited));
    }
}

} // namespace

void print_warnings(const RenderStats& stats) {
    for (const std::string& remark : stats.remarks) tell("keyhole: {}\n", remark);
    for (const std::string& warning : stats.warnings) tell("keyhole: warning: {}\n", warning);
}

void print_report(const RenderStats& stats) {
    for (const StageStats& s : stats.stages)
        tell("{}: {} wall, {} CPU, {}rays\n", s.stage->name, duration(s.wall_seconds), duration(s.cpu_seconds),
             with_prefix(static_cast<double>(s.rays)));
    if (stats.brightness > 0) tell("brightness: {:.6g} +- {:.2g}\n", stats.brightness, stats.brightness_error);
    if (stats.photon_bytes > 0)
        tell("photons: {} global, {} caustic, {}B; importons: {}, {}B\n", stats.photons_global, stats.photons_caustic,
             with_prefix(static_cast<double>(stats.photon_bytes)), stats.importons,
             with_prefix(static_cast<double>(stats.importon_bytes)));
    for (const auto& [name, value] : figures(stats)) tell("{}: {:.6g}\n", name, value);
    if (!stats.proposals.empty()) print_proposals(stats.proposals);
}

} // namespace keyhole
