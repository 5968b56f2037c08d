// Several mistakes of a user, reported together.
#pragma once

#include "core/error.h"

#include <string>
#include <utility>
#include <vector>

namespace keyhole {

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
