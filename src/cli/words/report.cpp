#include "cli/words/report.h"

#include "cli/words/tell.h"
#include "cli/words/units.h"

#include <fmt/format.h>

#include <map>

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

/// All figures that are known but those that have keys of their own in `--stats`.
std::map<std::string, double> figures(const RenderStats& stats) {
    std::map<std::string, double> all = stats.values;
    const auto add = [&](const char* name, const auto& figure) {
        if (figure) all[name] = static_cast<double>(*figure);
    };
    add("passes", stats.passes);
    add("effort", stats.effort);
    add("empty pixels", stats.no_samples);
    if (stats.agreement) {
        all["chains, agreement (split R-hat)"] = stats.agreement->r_hat;
        all["chains, error of block brightness"] = stats.agreement->error;
    }
    const PhotonQuality& q = stats.photon_quality;
    add("photon power, share of the brightest 0.1 %", q.of_brightest);
    if (q.cut_off.value_or(0) > 0) add("photon power, share cut off outliers", q.cut_off);
    if (q.lookups) {
        all["photons per lookup"] = q.lookups->found;
        all["photons per lookup, effective"] = q.lookups->effective;
        all["photons per lookup, share of those asked for"] = q.lookups->share;
    }
    if (q.cache) {
        all["cached irradiances"] = q.cache->records;
        all["cached irradiances, noise of one pass"] = q.cache->noise;
        all["cached irradiances, share of points without"] = q.cache->starving;
    }
    if (q.noise) {
        all["squared error of one sample a pixel"] = q.noise->samples;
        all["squared error of cached irradiances by their first rays"] = q.noise->records;
    }
    add("photons seen, share of the picture not confirmed by pilots", q.unconfirmed);
    return all;
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

using Json = nlohmann::ordered_json;

Json stats_json(const RenderStats& s) {
    Json stages = Json::array(), proposals = Json::array();
    for (const StageStats& stage : s.stages)
        stages.push_back({{"name", stage.stage->name},
                          {"wall_seconds", stage.wall_seconds},
                          {"cpu_seconds", stage.cpu_seconds},
                          {"rays", stage.rays}});
    for (const ProposalStats& p : s.proposals)
        proposals.push_back({{"name", p.name},
                             {"proposed", p.proposed},
                             {"failed", p.failed},
                             {"zero", p.zero},
                             {"nan", p.nan},
                             {"rejected", p.rejected},
                             {"accepted", p.accepted},
                             {"seconds", p.seconds},
                             {"deposited", p.deposited}});
    return {{"complete", s.complete},
            {"method", s.method},
            {"brightness", s.brightness},
            {"brightness_error", s.brightness_error},
            {"stages", stages},
            {"proposals", proposals},
            {"photons_global", s.photons_global},
            {"photons_caustic", s.photons_caustic},
            {"photon_bytes", s.photon_bytes},
            {"importons", s.importons},
            {"importon_bytes", s.importon_bytes},
            {"values", figures(s)},
            {"remarks", s.remarks},
            {"warnings", s.warnings}};
}

} // namespace keyhole
