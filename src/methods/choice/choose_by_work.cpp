#include "methods/choice/choose_by_work.h"

#include <fmt/format.h>

#include <utility>

namespace keyhole {

ChosenByWork choose_by_work(const TrialContext& c) {
    const std::vector<TriedMethod> tried = try_methods_by_work(c);
    if (tried.empty()) { // none is done with the window without leaving holes in it
        Settings s = c.settings;
        s.method = can_show(c.scene, methods::ipm) ? &methods::ipm : &methods::path;
        return {s, ""};
    }
    ChosenByWork chosen{settings_of_same_work(c, tried), describe_choice(c, tried)};
    if (c.findings.plan && !c.findings.plan->photons)
        chosen.why += "; no photon maps: " + c.findings.plan->items.front().why;
    c.findings.forget_coverage();
    for (const auto& [member, what] :
         {std::pair{&Settings::spp, "samples a pixel"}, std::pair{&Settings::mutations, "mutations"}})
        if (chosen.settings.*member != c.settings.*member)
            chosen.why += fmt::format("; {} {} instead of {} take the work that the settings ask for",
                                      chosen.settings.*member, what, c.settings.*member);
    return chosen;
}

} // namespace keyhole
