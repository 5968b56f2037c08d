// Errors that a user can mend: bad scenes, settings and files.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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

/// What is wrong with an input, as far as one look tells. what() has a line for each mistake.
class InputErrors : public InputError {
  public:
    /// @param lines as InputError::what() says them; not empty
    explicit InputErrors(std::vector<std::string> lines) : InputError(joined(lines)), lines_(std::move(lines)) {}

    const std::vector<std::string>& lines() const { return lines_; }

  private:
    static std::string joined(const std::vector<std::string>& lines) {
        std::string text;
        for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
        return text;
    }

    std::vector<std::string> lines_;
};

} // namespace keyhole
