#include "core/error.h"
#include "methods/method.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace keyhole {
namespace {

#define KEYHOLE_METHOD(name) &methods::name,
constexpr const Method* kMethods[] = {
#include "methods/table.inc"
};
#undef KEYHOLE_METHOD

} // namespace

std::span<const Method* const> all_methods() { return kMethods; }
std::string_view name_of(const Method& method) { return method.name; }

const Method& method_named(std::string_view name) {
    const auto found = std::ranges::find(kMethods, name, [](const Method* m) { return m->name; });
    if (found == std::end(kMethods)) throw InputError(fmt::format("unknown method '{}'", name));
    return **found;
}

std::string names_of(bool Method::*is) {
    std::vector<std::string_view> names;
    for (const Method* method : kMethods)
        if (method->*is) names.push_back(method->name);
    return fmt::format("{}", fmt::join(names, ", "));
}

bool can_show(const Scene& scene, const Method& method) {
    return method.scatters_in_media || !scene.has_scattering_media();
}

bool can_do(const Scene& scene, const Settings& s, const Method& method) {
    if (!can_show(scene, method)) return false;
    if (method.keeps_photons) return true;
    // With one scattering there is direct light alone, and nothing for chains.
    return (method.samples_pixels || s.max_depth > 1) && s.save_map.empty() && !s.equalise && s.plan != Plan::all;
}

void require_can_show(const Scene& scene, const Settings& s) {
    if (!scene.has_scattering_media()) return;
    const auto can = [&](const Method* m) { return m->trial.share > 0 && can_do(scene, s, *m); };
    if (s.method == &methods::automatic && (!s.load_map.empty() || std::ranges::none_of(kMethods, can)))
        throw InputError("found a medium that scatters, and settings that photons are needed for, expected either: "
                         "photons lie on surfaces");
    if (s.method != &methods::automatic && !can_show(scene, *s.method))
        throw InputError(fmt::format("found a medium that scatters, which method {} doesn't show; expected one of {}",
                                     s.method->name, names_of(&Method::scatters_in_media)));
}

RenderResult render_by_method(const RenderTask& task) {
    const Method& method = *task.settings.method;
    RenderResult result = method.render(task);
    if (result.stats.method.empty()) result.stats.method = method.name;
    result.settings = task.settings;
    return result;
}

} // namespace keyhole
