#include "render/render.h"

#include "core/error.h"
#include "core/interruptible.h"
#include "film/filter.h"
#include "render/first_look.h"
#include "render/method_trials.h"
#include "render/methods.h"

#include <algorithm>

namespace keyhole {

RenderResult render_by_method(const Scene& scene, const Settings& settings, const UserPaths& paths,
                              const RunContext& context, const Share& share, Findings& findings) {
    const auto render = [&] {
        if (settings.method == "path") return render_path(scene, settings, context, share);
        if (settings.method == "mlt") return render_mlt(scene, settings, paths, context, share, findings);
        if (settings.method == "bdpt") return render_bdpt(scene, settings, context, share);
        if (settings.method == "pssmlt" || settings.method == "mmlt" || settings.method == "rjmlt")
            return render_primary(scene, settings, context, share);
        if (keeps_photons(settings.method)) return render_photons(scene, settings, paths, context, share, findings);
        throw InputError("unknown method '" + settings.method + "'");
    };
    RenderResult result = render();
    if (result.stats.method.empty()) result.stats.method = settings.method;
    result.settings = settings;
    return result;
}

namespace {

/// Photons that are saved, read or weighed by pixels leave no choice but that between samplers of photons.
bool may_choose(const Settings& s) {
    return s.method == "auto" && s.save_map.empty() && s.load_map.empty() && !s.equalise && s.plan != "all";
}

/// By trials of a known amount of work. @param choice receives the choice in words.
Settings choose(const TrialContext& c, std::string& choice) {
    const std::vector<TriedMethod> tried = try_methods_by_work(c);
    if (tried.empty()) return c.settings;
    c.findings.forget_reach();
    choice = describe_choice(tried);
    if (c.findings.plan && !c.findings.plan->photons)
        choice += "; no photon maps: " + c.findings.plan->items.front().why;
    return settings_of_same_work(c, tried);
}

} // namespace

void set_window_margin(Scene& scene, const Settings& settings) {
    ImageWindow window = scene.camera().window();
    window.margin = std::max({2.0f, 0.03f * static_cast<float>(std::max(window.width, window.height)),
                              static_cast<float>(PixelFilter(settings).radius())});
    scene.set_window(window);
}

RenderResult render(Scene& scene, const Settings& settings, const RunContext& context, const UserPathFile& user_paths,
                    const Share& share) {
    set_window_margin(scene, settings);
    Findings findings;
    RenderResult result;
    // A crew has to come to one choice: who is stopped in the middle of a trial would make another.
    const std::set<std::string> none;
    RunContext deciding = context.alone();
    if (share.crew != nullptr) deciding.stop = nullptr;
    try {
        const UserPaths paths = bind_user_paths(scene, user_paths);
        std::string choice;
        const Settings chosen =
            may_choose(settings) ? choose({scene, settings, none, deciding, paths, findings}, choice) : settings;
        result = render_by_method(scene, chosen, paths, context, share, findings);
        result.settings = settings;
        if (!choice.empty()) result.stats.remarks.insert(result.stats.remarks.begin(), choice);
    } catch (const Interrupted&) { // before there was a picture
        result.settings = settings;
        result.stats.complete = false;
    }
    // What others are to go on from has its sums, which a first look has not.
    const bool asked = context.stop != nullptr && context.stop->stopped();
    if (asked && !has_picture(result) && !share.keep_sums && !share.save && share.crew == nullptr)
        return first_look(scene, settings);
    return result;
}

} // namespace keyhole
