#include "cli/words/figures.h"

namespace keyhole {

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

} // namespace keyhole
