#include "methods/render.h"

#include "core/shared_work.h"
#include "film/filter.h"
#include "methods/choice/choose_by_work.h"
#include "methods/choice/first_look.h"
#include "methods/method.h"
#include "methods/preparation.h"
#include "session/work.h"

#include <algorithm>
#include <string>
#include <utility>

namespace keyhole {

namespace {

/// Photons that are read leave no choice.
bool may_choose(const Settings& s) { return s.method == &methods::automatic && s.load_map.empty(); }

} // namespace

void set_window_margin(Scene& scene, const Settings& settings) {
    ImageWindow window = scene.camera().window();
    window.margin = std::max({2.0f, 0.03f * static_cast<float>(std::max(window.width, window.height)),
                              static_cast<float>(PixelFilter(settings).radius())});
    scene.set_window(window);
}

RenderResult render(Scene& scene, const Settings& settings, const RunContext& context, const UserPathFile& user_paths,
                    const WorkPartition& share) {
    require_can_show(scene, settings);
    set_window_margin(scene, settings);
    RenderResult result;
    // A group of processes has to come to one choice: who is stopped in the middle of a trial would make another.
    const std::set<std::string> none;
    RunContext deciding = context.alone();
    if (share.communicator != nullptr) deciding.stop = nullptr;
    try {
        Preparation before(scene, settings, user_paths, deciding);
        const UserPaths& paths = before.paths();
        Findings& findings = before.findings();
        const ChosenByWork chosen = may_choose(settings)
                                        ? choose_by_work({scene, settings, none, deciding, paths, findings})
                                        : ChosenByWork{settings, ""};
        result = render_by_method({scene, chosen.settings, paths, context, share, findings});
        result.settings = settings;
        before.report(result.stats);
        if (!chosen.why.empty()) result.stats.remarks.insert(result.stats.remarks.begin(), chosen.why);
    } catch (const Interrupted&) { // before there was a picture
        result.settings = settings;
        result.stats.complete = false;
        if (share.done != nullptr && !share.keep_sums) { // but for what was done before
            result.picture = *share.done;
            result.picture.sums.clear();
            result.picture.metadata.clear();
            result.stats.samples = std::stod(share.done->metadata.at("samples"));
            result.stats.warnings.emplace_back(kNothingAdded);
        }
    }
    // What others are to go on from has its sums, which a first look has not.
    const bool asked = context.stop != nullptr && context.stop->stopped();
    if (asked && !has_picture(result) && !share.keep_sums && !share.save && share.communicator == nullptr) {
        const RenderStats before = std::move(result.stats);
        result = first_look(scene, settings);
        result.stats.take_word_of_map(before);
    }
    if (result.stats.cut_map) result.stats.warn(Doubt::photons, *result.stats.cut_map);
    return result;
}

} // namespace keyhole
