#include "scene/load/mistakes.h"

#include <fmt/format.h>

namespace keyhole {

void Mistakes::note(const InputError& error) {
    if (const auto* unknown = dynamic_cast<const UnknownName*>(&error))
        if (names_are_lost_ || !seen_.insert(unknown->name()).second) return;
    if (const auto* several = dynamic_cast<const InputErrors*>(&error))
        for (const std::string& line : several->lines()) note_line(line);
    else
        note_line(error.what());
}

void Mistakes::note_line(const std::string& line) {
    constexpr std::size_t kMostSeen = 10'000; // of files that are nothing but mistakes
    if (seen_.size() < kMostSeen && !seen_.insert(line).second) return;
    if (++count_ <= kMostLines) lines_.push_back(line);
}

void Mistakes::report() const {
    if (empty()) return;
    std::vector<std::string> lines = lines_;
    if (count_ > kMostLines) lines.push_back(fmt::format("and {} more", count_ - kMostLines));
    throw InputErrors(std::move(lines));
}

} // namespace keyhole
