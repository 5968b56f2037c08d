// Mistakes in scene files that a reader can go on after, so that one run shows all of them.
#pragma once

#include "core/input_errors.h"

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace keyhole {

/// A mistake after which what follows can't be understood: reading ends there.
class FatalInputError : public InputError {
  public:
    using InputError::InputError;
};

/// The use of a name that nothing defines.
class UnknownName : public InputError {
  public:
    /// @param name with what it should name, as in "material 'wood'"
    UnknownName(const FilePosition& where, std::string name, const std::string& message)
        : InputError(where, message), name_(std::move(name)) {}

    const std::string& name() const { return name_; }

  private:
    std::string name_;
};

/// Collects them in the order in which they are found.
class Mistakes {
  public:
    /// No more lines than this help anybody at once.
    static constexpr std::size_t kMostLines = 20;

    /// Calls `read`, and notes what it throws. @returns whether that is nothing.
    /// @throws FatalInputError as `read` does.
    template <class Read> bool attempt(Read&& read) {
        try {
            read();
            return true;
        } catch (const FatalInputError&) {
            throw;
        } catch (const InputError& e) {
            note(e);
            return false;
        }
    }
    /// attempt() of something that defines names.
    template <class Read> bool attempt_definition(Read&& read) {
        const bool good = attempt(read);
        names_are_lost_ = names_are_lost_ || !good;
        return good;
    }

    /// Notes a mistake, unless it was noted before. Unknown names are noted once each, and not at all once a definition
    /// was lost: theirs may have been there.
    void note(const InputError& error);
    /// What was passed over may have defined names.
    void lose_names() { names_are_lost_ = true; }

    bool empty() const { return count_ == 0; }
    /// @throws InputErrors if there are any.
    void report() const;

  private:
    void note_line(const std::string& line);

    std::vector<std::string> lines_;
    std::set<std::string> seen_; ///< lines, and names that are unknown
    std::size_t count_ = 0;
    bool names_are_lost_ = false;
};

} // namespace keyhole
