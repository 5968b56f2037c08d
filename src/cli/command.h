// What the subcommands share.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <string>

namespace keyhole {

class ProcessGroup;

/// Exit codes; InputError and mistakes on the command line give kBadInput, any other exception kInternalError.
enum ExitCode : int { kSuccess = 0, kInternalError = 1, kBadInput = 2, kNotTrusted = 3, kInterrupted = 130 };

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

} // namespace keyhole
