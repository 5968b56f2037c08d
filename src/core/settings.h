// Every setting of a render, in one table: scene files, `-D key=value` and the help text all read it.
#pragma once

#include "core/choices.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace keyhole {

/// A number that steers a kind of proposal. Each stands in the file of its proposal.
struct ProposalParameter {
    const char* key; ///< among the settings, as in "lens_perturbation.weight"
    double usual;    ///< unless the settings have another
    double minimum, maximum;
    const char* help;
};

/// Those of all kinds, from the table in sampling/proposals/registry.cpp.
std::span<const ProposalParameter* const> proposal_parameters();

/// Their values.
class ProposalParameters {
  public:
    double operator[](const ProposalParameter& parameter) const {
        const auto found = values_.find(&parameter);
        return found == values_.end() ? parameter.usual : found->second;
    }
    double& operator[](const ProposalParameter& parameter) {
        return values_.try_emplace(&parameter, parameter.usual).first->second;
    }

  private:
    std::map<const ProposalParameter*, double> values_; // where they were asked to be written
};

/// A number, or the renderer's own choice.
struct AutoNumber {
    std::optional<double> value; ///< none: automatic
};

/// A method of rendering; methods/method.h says what it is. This layer knows no more of it than its name.
struct Method;
namespace methods {
extern const Method automatic; ///< `auto`: whichever suits the scene
}
/// All methods, from the table in methods/table.cpp.
std::span<const Method* const> all_methods();
std::string_view name_of(const Method& method);
/// @throws InputError for a name that none has.
const Method& method_named(std::string_view name);

/// A setting as something that can be printed.
template <class T> const T& printable(const T& setting) { return setting; }
template <Choice E> std::string_view printable(const E& setting) { return word_of(setting); }
inline std::string_view printable(const Method* const& setting) { return name_of(*setting); }
inline std::string printable(const AutoNumber& setting) {
    if (!setting.value) return "auto";
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.begin(), text.end(), *setting.value).ptr};
}

/// Settings of a render. Ranges and meanings stand in visit_settings(), the only other place that lists them.
struct Settings {
    const Method* method = &methods::automatic;
    Plan plan = Plan::fitting;
    bool gather_coverage = true;
    std::int64_t spp = 16;
    bool keep_spp = false;
    bool adaptive = false;
    std::uint64_t seed = 1;
    std::int64_t max_depth = 24;
    FilterShape filter = FilterShape::gaussian;
    double filter_radius = 0;
    double filter_sigma = 0;
    AutoNumber exposure;
    std::int64_t brightness_samples = 400'000;
    double brightness_error = 0.02;
    std::int64_t importons = 600'000;
    std::int64_t chains = 1000;
    std::int64_t chain_groups = 0;
    std::int64_t mutations = 1'000'000;
    std::int64_t light_paths = 1'000'000;
    std::int64_t photons = 0;
    std::int64_t photon_memory = 32 << 20;
    PowerRule power = PowerRule::marginal;
    SampledPaths paths = SampledPaths::stored;
    bool equalise = false;
    bool find_openings = true;
    std::int64_t passes = 1;
    double target_error = 0;
    Denoise denoise = Denoise::png;
    bool noise_layers = false;
    bool cryptomatte = false;
    std::int64_t mask_rays = 64;
    std::string save_map, load_map; ///< files of photons; empty: none. Not in the table: they belong to a run
    std::int64_t nearest = 60;
    std::int64_t light_samples = 4;
    AutoNumber gather_rays;
    MisHeuristic mis = MisHeuristic::power;
    PathBuilderKind builder = PathBuilderKind::bidirectional;
    Failures failures = Failures::reject;
    AutoNumber p_large;
    AutoNumber chain_share;
    bool large_step_mis = true;
    bool irradiance_cache = true;
    double cache_error = 0.3;
    double cache_min_reach = 4; ///< [pixels]
    std::int64_t cache_rays = 400;
    bool tune_proposals = true;
    ProposalParameters proposals;
};

/// One line of the table. `Visitor` is called as visitor(key, member, minimum, maximum, help) for numbers,
/// visitor(key, member, help) for choices and switches; an AutoNumber is a number or `auto`; members are references
/// into `settings`, or values where these are constant.
template <class S, class Visitor> void visit_settings(S& s, Visitor&& visit) {
    using I = std::int64_t;
    visit("method", s.method, "rendering method");
    visit("plan", s.plan, "auto: maps, proposals and stages that the scene has no use for are left out");
    visit("gather_coverage", s.gather_coverage,
          "store light that few gather rays could find where it is seen, if there is much of it");
    visit("spp", s.spp, I{1}, I{1} << 24, "samples per pixel");
    visit("keep_spp", s.keep_spp,
          "auto keeps spp where it takes path or bdpt, instead of as many as ipm's work is enough for; set by --spp");
    visit("adaptive", s.adaptive, "more samples for noisy pixels, in renders of one pass; spp is the mean");
    visit("seed", s.seed, I{0}, I{1} << 53, "seed of all random streams");
    visit("max_depth", s.max_depth, I{1}, I{126}, "most scatterings between light and eye");
    visit("filter", s.filter, "reconstruction filter");
    visit("filter_radius", s.filter_radius, 0.0, 16.0, "its reach in pixels; 0: 0.5 of a box, 1 of the others");
    visit("filter_sigma", s.filter_sigma, 0.0, 16.0, "of a Gaussian, in pixels; 0: its radius");
    visit("exposure", s.exposure, -100.0, 100.0,
          "of the tone-mapped picture, in stops: 2^exposure is white; auto: by its own brightness");
    visit("brightness_samples", s.brightness_samples, I{1000}, I{1} << 40, "path samples of stage one, at least");
    visit("brightness_error", s.brightness_error, 0.0, 1.0,
          "relative error of B_eye for which up to 8 times as many are taken; 0: no more");
    visit("importons", s.importons, I{1000}, I{1} << 30, "eye paths traced for the importance map");
    visit("chains", s.chains, I{1}, I{1} << 20, "Markov chains; their number never follows the threads");
    visit("chain_groups", s.chain_groups, I{0}, I{1} << 20,
          "units of work that the chains of a pass are shared out among, where they draw; 0: by `mutations`");
    visit("mutations", s.mutations, I{1}, I{1} << 50, "Metropolis steps over all chains");
    visit("light_paths", s.light_paths, I{1}, I{1} << 50, "light paths that ipm and pm trace");
    visit("photons", s.photons, I{0}, I{1} << 30, "most photons kept in a pass; 0: what the memory holds");
    visit("photon_memory", s.photon_memory, I{1} << 18, I{1} << 44,
          "bytes for photons, their index and importance maps");
    visit("power", s.power, "how mps takes the camera sub-path out of a photon's power");
    visit("paths", s.paths, "paths that mps samples: those that store a photon, or all");
    visit("find_openings", s.find_openings, "lead light through narrow openings that are found");
    visit("equalise", s.equalise, "photons for dark pixels as for bright ones: evens out relative errors");
    visit("passes", s.passes, I{0}, I{1} << 40, "passes of photons and gather; 0: until time or target_error is up");
    visit("target_error", s.target_error, 0.0, 1.0, "relative error at which passes end; 0: none");
    visit("denoise", s.denoise,
          "filter what samples of pixels leave of noise: of the PNG only, of the EXR too, or not");
    visit("noise_layers", s.noise_layers, "write what two halves of the samples differ in, as layers `noise.NAME`");
    visit("cryptomatte", s.cryptomatte, "ids of objects and materials as layers, by the Cryptomatte specification");
    visit("mask_rays", s.mask_rays, I{1}, I{1} << 20,
          "rays per pixel for these, and for the alpha of a transparent film");
    visit("nearest", s.nearest, I{1}, I{10'000}, "photons in a radiance estimate");
    visit("light_samples", s.light_samples, I{1}, I{1} << 16, "samples of emitters per sample of a pixel");
    visit("gather_rays", s.gather_rays, 1.0, 65536.0, "gather rays per sample of a pixel; auto: by trial");
    visit("mis", s.mis, "how the techniques of bidirectional paths share them");
    visit("builder", s.builder, "how pssmlt makes paths");
    visit("failures", s.failures, "what pssmlt, mmlt and rjmlt do with proposals that make no path; exclude is biased");
    visit("p_large", s.p_large, 0.0, 1.0, "probability of large steps of pssmlt, mmlt and rjmlt");
    visit("chain_share", s.chain_share, 0.0, 1.0,
          "of cps, what chains get of `mutations`; light paths get the rest of `light_paths`. auto: by trial");
    visit("large_step_mis", s.large_step_mis, "whether large steps deposit as samples on their own account");
    visit("irradiance_cache", s.irradiance_cache, "cache irradiance on diffuse surfaces");
    visit("cache_error", s.cache_error, 0.01, 1.0, "reach of a cached irradiance over the distance to surroundings");
    visit("cache_min_reach", s.cache_min_reach, 0.1, 60.0, "least reach of a cached irradiance, in pixels");
    visit("cache_rays", s.cache_rays, I{8}, I{1} << 20, "gather rays for a cached irradiance");
    visit("tune_proposals", s.tune_proposals, "weigh the kinds of proposal of mps by how far each moves chains, too");
    for (const ProposalParameter* p : proposal_parameters())
        visit(p->key, s.proposals[*p], p->minimum, p->maximum, p->help);
}

} // namespace keyhole
