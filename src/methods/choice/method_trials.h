// Which method leaves the least error in a time, by short renders of all of them.
#pragma once

#include "methods/choice/effort.h"
#include "methods/choice/experience.h"
#include "methods/choice/trial_error.h"
#include "methods/method.h"

#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace keyhole {

/// What a render of a small window tells of a method's cost.
struct TrialCost {
    Experience cost;
    double taken;                              ///< by it: seconds, or rays
    double samples;                            ///< of a pixel
    StageBalance balance;                      ///< that it found best
    std::optional<PhotonQuality::Noise> noise; ///< told where time is limited: otherwise settings stay as they are

    /// What one more sample of each of so many pixels would take: seconds, or rays.
    double per_sample(double pixels) const { return taken / samples * pixels / cost.pixels; }
    /// Settings of a render of so many seconds, or rays, at least with effort `least`; `effort` becomes its effort.
    Settings settings_for(const Settings& s, const std::set<std::string>& given, double pixels, double seconds,
                          double& effort) const;
};

/// What a render of so many seconds tells.
TrialCost cost_of_render(const Scene& scene, const Settings& settings, double effort, double pixels,
                         const RenderStats& stats, double seconds);

/// A method after its trial: two independent renders of a small window.
struct TriedMethod {
    const Method* method;
    TrialPictures pictures;
    /// With pixels as small as those of the picture: of path tracing, and where light is caustic.
    std::optional<TrialPictures> narrow;
    double by_samples = 1; ///< share of the grain that only samples of pixels make less
    TrialCost of;          ///< of one of the two renders
    TrialError error;
    double predicted = 0; ///< squared relative error that the render would leave (the measure of relmse_trim)
};

/// What trials are made with. All must outlive it.
struct TrialContext {
    Scene& scene;
    const Settings& settings;
    const std::set<std::string>& given; ///< settings that somebody named
    const RunContext& context;
    const UserPaths& user_paths;
    Findings& findings;
};

/// What a method costs, by one render of about so many seconds. None where it is not done in `most`, or leaves a pixel
/// empty: then it is too slow for the time. The scene's window is what it was afterwards.
std::optional<TrialCost> try_cost(const TrialContext& c, const Method& method, double seconds, double most);

/// Trials of all methods that can do what the settings ask for, the cheapest first, for as long as a part of the time
/// goes: at most 13 % of it, less where there is much, and `most` [s]. The best is first. Empty if there is time for
/// none. No picture of a trial counts in the end, so that nothing that follows from them can bias what does.
std::vector<TriedMethod> try_methods(const TrialContext& c, double most = std::numeric_limits<double>::infinity());

/// The same for a render without a time: for the work that light tracing by importance would take with these settings.
/// Work is counted in rays, so that the choice, and with it the picture, is the same on every machine and on any number
/// of threads. @throws Interrupted
std::vector<TriedMethod> try_methods_by_work(const TrialContext& c);

/// Settings of a render by the method that does about as much work as light tracing by importance would with those of
/// `c`, found by try_methods_by_work().
Settings settings_of_same_work(const TrialContext& c, std::span<const TriedMethod> tried);

/// In words, for the record: the method, by how much it is ahead, and what there was too little time to try.
std::string describe_choice(const TrialContext& c, std::span<const TriedMethod> tried);

/// Warns of light that `method` found in a few bright samples of its trial only, and another one everywhere.
void warn_of_dots(const Method& method, const TrialError& error, RenderStats& stats);

} // namespace keyhole
