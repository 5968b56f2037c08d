// The user paths that a render follows: those that it is given, or those that it finds.
#pragma once

#include "core/progress.h"
#include "core/render_stats.h"
#include "core/settings.h"
#include "sampling/guidance/user_paths.h"

#include <string>

namespace keyhole {

class RenderPaths {
  public:
    /// Binds what `given` says, and where that has openings finds out what they bring. If the method that the settings
    /// name follows user paths, looks for openings besides that light has to pass, for a small share of the time if
    /// that is limited, and adds paths through those that it finds.
    /// @throws InputError as bind_user_paths(), and Interrupted
    RenderPaths(const Scene& scene, const Settings& settings, const UserPathFile& given, const RunContext& context);

    const UserPaths& paths() const { return paths_; }
    /// By how much fewer light paths do as well with them where they lead through openings; else 1.
    double gain() const { return gain_; }
    /// Adds what looking took, and what it found.
    void report(RenderStats& stats) const { stats.begin_with(own_); }

  private:
    void say_led(const std::string& where, double gain);

    UserPaths paths_;
    double gain_ = 1;
    RenderStats own_;
};

} // namespace keyhole
