// Options of the command line that stand for settings.
#pragma once

#include "core/settings.h"

#include <CLI/CLI.hpp>

#include <set>
#include <string>
#include <vector>

namespace keyhole {

/// Adds --method, --spp and the others that are settings by their names, and -D. Each becomes "key=value" in
/// `overrides`, which must outlive the parsing; -D comes last.
void add_setting_options(CLI::App& command, std::vector<std::string>& overrides);

/// Adds --quality. @returns the option
CLI::Option* add_quality_option(CLI::App& command, std::string& quality);

/// Settings that "key=value" name.
std::set<std::string> named_settings(const std::vector<std::string>& overrides);

/// with_quality() by the word of --quality; empty: as they are. @throws InputError for another word.
Settings with_quality_of(const Settings& settings, const std::string& quality, const std::set<std::string>& named);

/// CPU time that a wall-clock time is on so many threads; 0: one for each core.
double cpu_time_of(double seconds, int threads);

} // namespace keyhole
