#include "cli/words/stats_json.h"

#include "cli/words/figures.h"

namespace keyhole {

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
