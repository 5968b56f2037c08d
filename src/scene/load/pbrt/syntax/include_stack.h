// The files that a scene consists of, and where reading stands in them.
#pragma once

#include "scene/load/pbrt/syntax/directive.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace keyhole::pbrt {

/// Directives of a file and of those that it includes, in the order in which they act.
class IncludeStack {
  public:
    /// @throws InputError for a file that can't be read.
    explicit IncludeStack(const std::string& path);

    /// The next directive; none at the end of the outermost file. @throws InputError for broken syntax.
    std::optional<Directive> next();
    /// After next() threw: goes on to where the next directive begins.
    void skip_to_directive();

    /// Goes on with another file, and comes back after its end. Paths are relative to the outermost file, as in pbrt,
    /// or else to the one that includes.
    /// @throws FatalInputError with the position of `directive` for missing files, cycles, and too many of them.
    void enter(const Directive& directive, const std::string& name);

    /// Of the outermost file.
    const std::string& directory() const { return directory_; }
    /// Files that are open.
    std::size_t depth() const { return files_.size(); }
    /// Where the outermost file begins.
    FilePosition begin() const { return {path_, 1, 1}; }

  private:
    struct File {
        std::string canonical;
        std::unique_ptr<DirectiveReader> reader;
    };

    void open(const std::string& path);

    std::string path_, directory_;
    std::vector<File> files_;
    std::size_t opened_ = 0;
};

} // namespace keyhole::pbrt
