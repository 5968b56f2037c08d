// Shares and checkpoints of a render.
#pragma once

#include "cli/process_group.h"
#include "core/settings.h"
#include "film/join.h"
#include "session/work_partition.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keyhole {

/// What of a render is done, and how it is kept from getting lost.
struct Checkpoints {
    std::string pass_range;           ///< A:B; empty: all
    std::optional<double> checkpoint; ///< seconds between checkpoints
    bool resume = false;

    void add_options(CLI::App& command);

    /// Whether any of it is asked for.
    bool asked() const { return checkpoint || resume || !pass_range.empty(); }

    /// The share that this asks for. `exr` is the output; checkpoints go beside it. `render` has the size and the
    /// identity (render_identity()) of pictures of the render; a checkpoint to go on from has to have the same. Keeps
    /// what the share refers to. With a group every process has its checkpoints; all are read.
    /// @throws InputError for a range that can't be, and for checkpoints that can't be read or are of another render.
    WorkPartition share(const std::string& exr, const Picture& render, const Settings& settings, ProcessGroup* group);

    /// The file of checkpoints for an output, of process `rank`; empty: none is written.
    std::string file(const std::string& exr, int rank = 0) const;

    /// @throws InputError where there are files of checkpoints that nobody asks to go on from: they may be the work of
    /// days.
    void keep_others(const std::string& exr) const;

    /// Files of checkpoints for an output that are there, of all processes.
    std::vector<std::string> found(const std::string& exr) const;

  private:
    void read(const std::string& exr, const NamedPicture& render);

    NamedPicture done_; // without a name: there is nothing to go on from
};

} // namespace keyhole
