// Methods of rendering: each has a file beside this one, or in photons/, and a line in table.inc.
#pragma once

#include "methods/findings.h"
#include "methods/render.h"
#include "sampling/guidance/user_paths.h"

#include <memory>
#include <string_view>

namespace keyhole {

class PassObserver;
class PhotonSampler;
struct SamplerContext;

/// What a method is given. The scene's window margin has to be set.
struct RenderTask {
    const Scene& scene;
    const Settings& settings;
    const UserPaths& user_paths;
    const RunContext& context;
    const WorkPartition& share;
    Findings& findings;
    PassObserver* observer = nullptr; ///< of methods that keep photons; null: nobody watches
};

/// When importance maps have to be there.
enum class ImportanceUse {
    none,   ///< never
    guide,  ///< before photons are stored; less than a third of it stays
    beside, ///< while photons are stored
    both,   ///< beside, and to guide them
};

/// What the file of a method says of it.
struct Method {
    std::string_view name, help;
    bool keeps_photons = false;         ///< in maps, which can be saved and loaded
    bool samples_pixels = false;        ///< one by one, and needs nothing before that
    bool follows_user_paths = false;    ///< that a scene has
    bool asks_for_direct_light = false; ///< by next-event estimation, which may be learned
    bool scatters_in_media = false;     ///< shows scenes with media that scatter
    ImportanceUse importance = ImportanceUse::none;

    /// What `auto` tries it with; docs/charts.md.
    struct Trial {
        double share = 0;     ///< of the time for all trials; 0: it isn't tried
        bool by_work = false; ///< tried where there is no time to go by, too
        /// By how much a trial flatters its error: photons of two renders blur light alike, and chains are too short to
        /// show what they miss.
        double doubt = 1;
        /// Not tried where another method promises a squared error below this: chains can't be so much better there
        /// that it would be worth the time of their trial. 0: always tried.
        double needless_below = 0;
    } trial{};

    /// What a unit of effort is spent on, where the method runs chains.
    double mutations_of_effort = 500e3, brightness_samples_of_effort = 100e3;

    /// @throws Interrupted, and InputError as render()
    RenderResult (*render)(const RenderTask&);
    /// Where photons come from: of methods that keep them.
    std::unique_ptr<PhotonSampler> (*make_sampler)(const SamplerContext&) = nullptr;

    /// Standard photon mapping knows nothing of where photons are worth having.
    bool stores_everywhere() const { return keeps_photons && importance == ImportanceUse::none; }
};

namespace methods {
#define KEYHOLE_METHOD(name) extern const Method name;
#include "methods/table.inc"
#undef KEYHOLE_METHOD
} // namespace methods

/// Names of the methods that `is` holds for, separated by commas.
std::string names_of(bool Method::*is);

/// Whether the method knows what to do with the scene's media.
bool can_show(const Scene& scene, const Method& method);
/// @throws InputError if the method of the settings doesn't, or `auto` has none that does and can do what they ask for
void require_can_show(const Scene& scene, const Settings& settings);

/// Whether the method can do what the settings ask for: save photons, or weigh them by pixels; whether they leave it
/// anything to do; and whether it can show the scene.
bool can_do(const Scene& scene, const Settings& settings, const Method& method);

/// The method that the settings name, without render()'s care for renders that are stopped before they have a picture.
/// @throws Interrupted, and InputError as render()
RenderResult render_by_method(const RenderTask& task);

/// Everything that renders from photon maps; the method is the sampler that fills them.
RenderResult render_photons(const RenderTask& task);

/// Finds out what render_photons() has to know, all methods but pm. @throws Interrupted
void plan_photons(const Scene& scene, const Settings& settings, const UserPaths& paths, const RunContext& context,
                  Findings& findings);

} // namespace keyhole
