// Errors that a user can mend: bad scenes, settings and files.
#pragma once

#include <stdexcept>
#include <string>

namespace keyhole {

/// Where in a file something was found. Lines and columns count from 1; 0 means unknown.
struct FilePosition {
    std::string file;
    int line = 0;
    int column = 0;

    /// `file:line:column`, leaving out what is unknown.
    std::string to_string() const {
        std::string s = file;
        for (const int number : {line, line > 0 ? column : 0}) {
            if (number <= 0) continue;
            s += ':';
            s += std::to_string(number);
        }
        return s;
    }
};

/// Bad input. `what()` reads `file:line:column: what was found, what was expected`. The command line exits with 2.
class InputError : public std::runtime_error {
  public:
    explicit InputError(const std::string& message) : std::runtime_error(message) {}
    InputError(const FilePosition& where, const std::string& message)
        : std::runtime_error(where.file.empty() ? message : where.to_string() + ": " + message) {}
};

} // namespace keyhole
