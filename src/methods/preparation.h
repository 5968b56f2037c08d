// What a render finds out before its trials, and makes them with.
#pragma once

#include "methods/findings.h"
#include "methods/learned_direct_light_scope.h"
#include "methods/render_paths.h"

namespace keyhole {

/// The scene knows what was learned of direct light as long as this lives.
class Preparation {
  public:
    /// @throws InputError as bind_user_paths(), and Interrupted
    Preparation(Scene& scene, const Settings& settings, const UserPathFile& user_paths, const RunContext& context)
        : direct_light_(scene, settings, context), paths_(scene, settings, user_paths, context) {
        findings_.gain_by_openings = paths_.gain();
    }
    const UserPaths& paths() const { return paths_.paths(); }
    Findings& findings() { return findings_; }

    /// Adds what it took, and what was found.
    void report(RenderStats& stats) const {
        direct_light_.report(stats);
        paths_.report(stats);
    }

  private:
    LearnedDirectLightScope direct_light_;
    RenderPaths paths_;
    Findings findings_; // of trials too
};

} // namespace keyhole
