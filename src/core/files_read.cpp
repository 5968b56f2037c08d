#include "core/files_read.h"

#include <mutex>
#include <set>

namespace keyhole {
namespace {

struct Notes {
    std::mutex mutex;
    std::set<std::string> paths;
};

Notes& notes() {
    static Notes instance;
    return instance;
}

} // namespace

void note_file_read(const std::string& path) {
    const std::lock_guard lock(notes().mutex);
    notes().paths.insert(path);
}

std::vector<std::string> files_read() {
    const std::lock_guard lock(notes().mutex);
    return {notes().paths.begin(), notes().paths.end()};
}

} // namespace keyhole
