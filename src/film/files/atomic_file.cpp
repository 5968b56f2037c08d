#include "film/files/atomic_file.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <mutex>
#include <sys/stat.h>
#include <unistd.h>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int error) {
    throw InputError(fmt::format("{}: cannot write: {}", path, std::strerror(error)));
}

/// Name of the temporary file that is being written, for a signal handler, which can ask for one only: threads take
/// turns.
std::array<char, PATH_MAX> unfinished{};
std::atomic<bool> is_unfinished{false};
std::mutex turn;

void remember(const std::string& name) {
    if (name.size() >= unfinished.size()) return;
    std::copy(name.c_str(), name.c_str() + name.size() + 1, unfinished.begin());
    is_unfinished = true;
}

/// An open file; closed, and removed if it is still temporary, at the end of its scope.
struct File {
    int descriptor = -1;
    std::string temporary;                ///< name, empty: not to be removed
    std::unique_lock<std::mutex> writing; ///< held while `unfinished` is its name
    File() = default;
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        if (descriptor >= 0) close(descriptor);
        if (!temporary.empty()) unlink(temporary.c_str());
        if (writing) is_unfinished = false;
    }
};

/// What to replace: the end of a chain of links.
fs::path final_target(const std::string& path) {
    fs::path target = path;
    std::error_code ignored;
    for (int links = 0; links < 40 && fs::is_symlink(target, ignored); ++links) {
        const fs::path next = fs::read_symlink(target, ignored);
        target = next.is_absolute() ? next : target.parent_path() / next;
    }
    return target;
}

enum class Kind { replaceable, direct };

Kind kind_of(const std::string& path, const fs::path& target) {
    struct stat status {};
    if (path.empty()) fail("''", ENOENT);
    if (stat(target.c_str(), &status) != 0) {
        if (errno == ENAMETOOLONG) fail(path, errno); // its own may be longer than the temporary one's
        return Kind::replaceable;
    }
    if (S_ISDIR(status.st_mode)) fail(path, EISDIR);
    return S_ISREG(status.st_mode) ? Kind::replaceable : Kind::direct;
}

/// A new file in the target's folder, with the permissions of the file that it is to replace.
void open_temporary(File& file, const std::string& path, const fs::path& target) {
    const fs::path folder = target.parent_path();
    file.writing = std::unique_lock(turn);
    for (int attempt = 0;; ++attempt) {
        const std::string name = (folder / fmt::format(".keyhole-{}-{}.tmp", getpid(), attempt)).string();
        remember(name);
        file.descriptor = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file.descriptor >= 0) {
            file.temporary = name;
            break;
        }
        if (errno != EEXIST || attempt > 1000) fail(path, errno);
    }
    struct stat status {};
    if (stat(target.c_str(), &status) == 0 && fchmod(file.descriptor, status.st_mode & 07777U) != 0) fail(path, errno);
}

void write_all(int descriptor, const std::string& path, std::span<const char> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = write(descriptor, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(path, errno);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
}

} // namespace

void write_file_atomically(const std::string& path, std::span<const char> bytes) {
    write_file_atomically(path, std::array{bytes});
}

void write_file_atomically(const std::string& path, std::span<const std::span<const char>> parts) {
    const fs::path target = final_target(path);
    File file;
    if (kind_of(path, target) == Kind::direct) {
        file.descriptor = open(target.c_str(), O_WRONLY | O_CLOEXEC);
        if (file.descriptor < 0) fail(path, errno);
        for (const auto& bytes : parts) write_all(file.descriptor, path, bytes);
        return;
    }
    open_temporary(file, path, target);
    for (const auto& bytes : parts) write_all(file.descriptor, path, bytes);
    if (fsync(file.descriptor) != 0) fail(path, errno);
    if (rename(file.temporary.c_str(), target.c_str()) != 0) fail(path, errno);
    file.temporary.clear();
}

void remove_unfinished_file() noexcept {
    if (is_unfinished) unlink(unfinished.data());
}

void check_writable(const std::string& path) {
    const fs::path target = final_target(path);
    if (kind_of(path, target) == Kind::direct) return;
    File file;
    open_temporary(file, path, target);
}

} // namespace keyhole
