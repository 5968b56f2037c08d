// The program, and what its subcommands share.
#pragma once

#include "cli/process_group.h"
#include "scene/camera.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <functional>
#include <string>

namespace keyhole {

/// Exit codes; InputError and mistakes on the command line give kBadInput, any other exception kInternalError.
enum ExitCode : int { kSuccess = 0, kInternalError = 1, kBadInput = 2, kNotTrusted = 3, kInterrupted = 130 };

/// Parses the command line, runs a subcommand, turns exceptions into exit codes.
/// @param group the processes that share `render`; null: this one is alone.
/// @returns an ExitCode.
int run_program(int argc, char** argv, ProcessGroup* group);

/// What to run once the command line is understood.
using Action = std::function<int()>;

/// Each adds its subcommand to `app`; parsing it sets `action`.
/// @param command_line for the picture's metadata.
/// @param group the processes that share a render; null: this one is alone.
void add_render_command(CLI::App& app, Action& action, const std::string& command_line, ProcessGroup* group);
void add_merge_command(CLI::App& app, Action& action, const std::string& command_line);
void add_diff_command(CLI::App& app, Action& action);
void add_paths_command(CLI::App& app, Action& action);
void add_experiment_command(CLI::App& app, Action& action);
void add_info_command(CLI::App& app, Action& action);
void add_chart_command(CLI::App& app, Action& action);
void add_inspect_command(CLI::App& app, Action& action);
void add_plan_command(CLI::App& app, Action& action);

/// Sets the film's size from "WIDTHxHEIGHT". @throws InputError with what was found and what was expected.
void set_resolution(ImageWindow& window, const std::string& text);

/// A number from `least` to `most`; "nan" is none, which CLI::Range lets pass.
inline CLI::Validator real_range(double least, double most) {
    CLI::Validator range = CLI::Range(least, most);
    const auto number = CLI::Validator(
        [](const std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && std::isnan(value) ? "found nan, expected a number"
                                                                               : std::string();
        },
        "");
    return range & number;
}

} // namespace keyhole
