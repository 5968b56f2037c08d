#include "cli/setting_options.h"

#include "core/error.h"
#include "core/parallel.h"
#include "methods/choice/effort.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace keyhole {
namespace {

/// Of --target-error, which 0 would let go on for ever. @returns what is wrong; empty: nothing
std::string check_target(const std::string& text) {
    double error = 0;
    const bool good = CLI::detail::lexical_cast(text, error) && error > 0 && error <= 1;
    return good ? "" : fmt::format("found '{}', expected a relative error above 0, at most 1", text);
}

} // namespace

void add_setting_options(CLI::App& command, std::vector<std::string>& overrides) {
    for (const auto& [option, key] : {std::pair("--method", "method"),
                                      {"--spp", "spp"},
                                      {"--mutations", "mutations"},
                                      {"--photons", "photons"},
                                      {"--passes", "passes"},
                                      {"--seed", "seed"},
                                      {"--denoise", "denoise"},
                                      {"--photon-memory", "photon_memory"},
                                      {"--target-error", "target_error"}})
        command.add_option_function<std::string>(
            option,
            [&overrides, key = key](const std::string& value) { overrides.push_back(std::string(key) + "=" + value); },
            std::string("the setting ") + key);
    command.get_option("--target-error")->check(CLI::Validator(check_target, ""));
    command
        .add_option_function<std::vector<std::string>>(
            "-D",
            [&overrides](const std::vector<std::string>& pairs) {
                overrides.insert(overrides.end(), pairs.begin(), pairs.end());
            },
            "any setting, KEY=VALUE; may be repeated, and overrules the options above")
        ->allow_extra_args(false);
}

CLI::Option* add_quality_option(CLI::App& command, std::string& quality) {
    return command.add_option("--quality", quality, "draft, good or final: how much work, in one word");
}

std::set<std::string> named_settings(const std::vector<std::string>& overrides) {
    std::set<std::string> keys;
    for (const std::string& o : overrides) keys.insert(o.substr(0, o.find('=')));
    return keys;
}

Settings with_quality_of(const Settings& settings, const std::string& quality, const std::set<std::string>& named) {
    if (quality.empty()) return settings;
    const auto word = choice_of<Quality>(quality);
    if (!word) throw InputError("found quality '" + quality + "', expected draft, good or final");
    return with_quality(settings, *word, named);
}

double cpu_time_of(double seconds, int threads) { return seconds * busy_cores(threads); }

} // namespace keyhole
