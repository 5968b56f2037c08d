// Files that are either whole or not there.
#pragma once

#include <span>
#include <string>

namespace keyhole {

/// Replaces the file `path` by `bytes`: whoever looks sees the old file or the new one, and after a crash or on a full
/// disk the old one stays. Follows symbolic links; what is no regular file (a pipe, a device) is written to directly.
/// @throws InputError with the path and the reason.
void write_file_atomically(const std::string& path, std::span<const char> bytes);
/// The same with what lies in several places, one after the other.
void write_file_atomically(const std::string& path, std::span<const std::span<const char>> parts);

/// Removes the temporary file of a write_file_atomically() that is under way, if there is one. Signal-safe: for a
/// process that is about to end.
void remove_unfinished_file() noexcept;

/// Finds out now whether write_file_atomically() could work: makes a file in the folder and removes it.
/// @throws InputError with the path and the reason.
void check_writable(const std::string& path);

} // namespace keyhole
