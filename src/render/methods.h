// The methods behind render(), one file each.
#pragma once

#include "render/findings.h"
#include "render/render.h"
#include "sampling/user_paths.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace keyhole {

/// Whether render_photons() is behind `method`.
inline bool keeps_photons(std::string_view method) {
    constexpr std::array<std::string_view, 5> methods{"auto", "mps", "ipm", "pm", "pss"};
    return std::ranges::find(methods, method) != methods.end();
}

/// Whether a method samples pixels one by one and needs nothing before that.
inline bool samples_pixels(std::string_view method) { return method == "path" || method == "bdpt"; }

/// The method that settings.method names, without render()'s care for renders that are stopped before they have a
/// picture. The scene's window margin has to be set.
/// @throws Interrupted, and InputError as render()
RenderResult render_by_method(const Scene& scene, const Settings& settings, const UserPaths& paths,
                              const RunContext& context, const Share& share, Findings& findings);

/// Everything that renders from photon maps; the method is the sampler that fills them: mps, ipm, pm
/// or pss, or the better of the first two by trial.
RenderResult render_photons(const Scene& scene, const Settings& settings, const UserPaths& paths,
                            const RunContext& context, const Share& share, Findings& findings);

/// Finds out what render_photons() has to know, all methods but pm. @throws Interrupted
void plan_photons(const Scene& scene, const Settings& settings, const UserPaths& paths, const RunContext& context,
                  Findings& findings);

/// Metropolis light transport (Veach and Guibas 1997): the chains of Metropolis photon sampling, drawn directly.
RenderResult render_mlt(const Scene& scene, const Settings& settings, const UserPaths& paths, const RunContext& context,
                        const Share& share, Findings& findings);

/// Path tracing with next-event estimation, the reference.
RenderResult render_path(const Scene& scene, const Settings& settings, const RunContext& context, const Share& share);

/// Bidirectional path tracing (Veach 1997, chapter 10).
RenderResult render_bdpt(const Scene& scene, const Settings& settings, const RunContext& context, const Share& share);

/// Metropolis light transport in primary sample space: pssmlt (Kelemen et al. 2002), mmlt (Hachisuka, Kaplanyan and
/// Dachsbacher 2014) or rjmlt (after Bitterli et al. 2017), by settings.method.
RenderResult render_primary(const Scene& scene, const Settings& settings, const RunContext& context,
                            const Share& share);

} // namespace keyhole
