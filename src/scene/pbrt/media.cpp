#include "scene/pbrt/media.h"

#include "scene/load/suggest.h"

#include <fmt/format.h>

namespace keyhole::pbrt {

void MediumTable::define(Parameters& p) {
    const std::string type = p.string("type", "");
    Entry entry;
    Medium medium;
    if (type != "homogeneous") {
        entry.refusal = fmt::format("found a medium of type '{}', expected homogeneous", type);
    } else if (p.has("preset") || !p.has("sigma_a") || !p.has("sigma_s")) {
        entry.refusal =
            "found a medium that scatters, as it does unless 'sigma_s' is 0, expected one that only absorbs";
    } else {
        // v3 and v4 measure in inverse units of the scene; v4 calls the factor 'scale'.
        medium.absorption = p.spectrum("sigma_a", Rgb(0.0), SpectrumUse::index) * p.number("scale", 1, kNotNegative);
        if (!is_black(p.spectrum("sigma_s", Rgb(0.0), SpectrumUse::index)))
            entry.refusal = "found a medium that scatters, expected one whose 'sigma_s' is 0";
        if (!is_black(p.spectrum("Le", Rgb(0.0), SpectrumUse::light)))
            entry.refusal = "found a medium that emits, expected one that only absorbs";
        p.ignore({"g", "Lescale"});
        p.warn_of_the_rest();
    }
    if (!is_black(medium.absorption)) entry.medium = std::make_shared<const Medium>(medium);
    media_[p.directive().words[0]] = entry;
}

std::shared_ptr<const Medium> MediumTable::look_up(const std::string& name, const Directive& user) const {
    if (name.empty()) return nullptr;
    const auto found = media_.find(name);
    if (found == media_.end()) {
        std::vector<std::string_view> names;
        for (const auto& [known, entry] : media_) names.push_back(known);
        user.fail_unknown(user.position, fmt::format("medium '{}'", name),
                          fmt::format("found the unknown medium '{}', {}", name, expected_one_of(name, names)));
    }
    if (!found->second.refusal.empty()) user.fail(found->second.refusal);
    return found->second.medium;
}

} // namespace keyhole::pbrt
