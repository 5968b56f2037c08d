// The methods behind render(), one file each.
#pragma once

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

/// Everything that renders from photon maps; the method is the sampler that fills them: mps, ipm, pm
/// or pss, or the better of the first two by trial.
RenderResult render_photons(const Scene& scene, const Settings& settings, const UserPaths& paths,
                            const RunContext& context, const Share& share);

/// Metropolis light transport (Veach and Guibas 1997): the chains of Metropolis photon sampling, drawn directly.
RenderResult render_mlt(const Scene& scene, const Settings& settings, const UserPaths& paths, const RunContext& context,
                        const Share& share);

/// Path tracing with next-event estimation, the reference.
RenderResult render_path(const Scene& scene, const Settings& settings, const RunContext& context, const Share& share);

/// Bidirectional path tracing (Veach 1997, chapter 10).
RenderResult render_bdpt(const Scene& scene, const Settings& settings, const RunContext& context, const Share& share);

/// Metropolis light transport in primary sample space: pssmlt (Kelemen et al. 2002), mmlt (Hachisuka, Kaplanyan and
/// Dachsbacher 2014) or rjmlt (after Bitterli et al. 2017), by settings.method.
RenderResult render_primary(const Scene& scene, const Settings& settings, const RunContext& context,
                            const Share& share);

} // namespace keyhole
