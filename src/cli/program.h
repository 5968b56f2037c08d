// The program: parses the command line, runs a subcommand, turns exceptions into exit codes.
#pragma once

#include "cli/command.h"
#include "cli/process_group.h"

namespace keyhole {

/// @param group the processes that share `render`; null: this one is alone.
/// @returns an ExitCode.
int run_program(int argc, char** argv, ProcessGroup* group);

} // namespace keyhole
