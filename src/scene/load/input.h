// What the readers of all formats share: text files, mistakes, warnings and suggestions.
#pragma once

#include "core/error.h"

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// The text of a file, which should be `what`.
/// @throws InputError "path: what is wrong" for anything but a readable regular file within `most_bytes`.
std::string read_text_file(const std::string& path, std::string_view what = "a scene file",
                           std::size_t most_bytes = std::size_t{1} << 26);

/// The bytes of a file; where it is packed with gzip (RFC 1952) what was packed, of several parts one after the other.
/// @throws InputError, without a position, for a file that can't be read, for packed data that are broken or end too
/// early, and for more than `most_unpacked` bytes of them.
std::string read_packed_file(const std::string& path, std::size_t most_unpacked);

/// "expected one of a, b, c", ending in "; did you mean 'b'?" if `word` is a near miss of one of `choices`: within a
/// third of its length, at least one edit. Edits insert, delete, replace a letter or exchange neighbours (Damerau
/// 1964).
std::string expected_one_of(std::string_view word, const std::vector<std::string_view>& choices);

/// The part of expected_one_of() behind the list, "; did you mean 'b'?"; empty without a near miss.
std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& choices);

/// The keys of a map by names.
template <class Map> std::vector<std::string_view> keys_of(const Map& map) {
    std::vector<std::string_view> names;
    for (const auto& entry : map) names.push_back(entry.first);
    return names;
}

/// "found the unknown material 'wihte', expected ..." for a name that a map doesn't have.
template <class Map> std::string unknown_name(std::string_view what, const std::string& name, const Map& map) {
    return "found the unknown " + std::string(what) + " '" + name + "', " + expected_one_of(name, keys_of(map));
}

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

/// Collects warnings, each kind once.
class Warnings {
  public:
    /// @param out may be null.
    explicit Warnings(std::vector<std::string>* out) : out_(out) {}
    /// Adds "file:line:column: message", unless one of this `kind` was added before.
    void add(const FilePosition& where, const std::string& kind, const std::string& message) {
        if (kinds_.insert(kind).second && out_ != nullptr) out_->push_back(where.to_string() + ": " + message);
    }

    /// Says that a mesh is left out because no ray could hit it. @param mesh in words, perhaps with its path
    void add_flat_mesh(const FilePosition& where, const std::string& mesh) {
        add(where, "mesh without area at " + where.to_string(),
            mesh + ": no triangle of the mesh has an area: it is left out");
    }

  private:
    std::vector<std::string>* out_;
    std::set<std::string> kinds_;
};

} // namespace keyhole
