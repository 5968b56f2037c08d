// How much effort a render makes, as one number.
#pragma once

#include "core/settings.h"

#include <set>
#include <string>

namespace keyhole {

/// How time is split between stage one and chains: factors on what a unit of effort gives each.
struct StageBalance {
    double brightness = 1, chains = 1;
};

/// CPU time of a unit of effort, on scenes/ at 320x240 [s]: what is known before anything was measured.
constexpr double kSecondsOfEffort = 5;

/// `settings` with everything that makes a render longer and better set by `effort`: 1 takes about kSecondsOfEffort on
/// the scenes of scenes/. More effort is more samples, more photons, a finer cache, in proportions that
/// served well there; photons grow more slowly than the paths that bring them, so that bias and noise of
/// lookups shrink together. Settings named in `given` stay as they are. Photons that the memory can't hold at once are
/// spread over passes.
/// @param pixels of the picture.
Settings with_effort(const Settings& settings, double effort, std::int64_t pixels, const std::set<std::string>& given,
                     const StageBalance& balance = {});

/// The same, but nothing more or finer than in `settings`: for passes that are to be short.
Settings with_effort_at_most(const Settings& settings, double effort, std::int64_t pixels,
                             const std::set<std::string>& given);

/// Passes that should fit into a time, where as many are made as do: several, because four tell an error, and scenes
/// may be as many times slower than others, or than their trials.
constexpr double kPassesInTime = 8;

/// Whether a time goes into as many passes as fit, all alike.
inline bool fills_passes(const Settings& settings) { return settings.passes == 0 || settings.target_error > 0; }

/// Effort of a pass of a render to a relative error, of which there are four at least: where that much is noise the
/// first few are to be enough.
double effort_of_pass(double target_error);

/// What `--quality` names: the effort that makes a draft, a good picture, or a final one, at any size of the picture.
enum class Quality { draft, good, final };
constexpr auto words_of(Quality) { return std::to_array<std::string_view>({"draft", "good", "final"}); }
Settings with_quality(const Settings& settings, Quality quality, const std::set<std::string>& given);

} // namespace keyhole
