#include "scene/load/suggest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>

namespace keyhole {
namespace {

/// Optimal string alignment distance, row by row.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before = last;
        last = row;
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row.back();
}

} // namespace

std::string expected_one_of(std::string_view word, const std::vector<std::string_view>& choices) {
    if (choices.empty()) return "expected none, as none are defined";
    constexpr std::size_t kMost = 24; // a list that nobody reads helps nobody
    const std::vector<std::string_view> shown(
        choices.begin(), choices.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, choices.size())));
    std::string text = fmt::format("expected {}{}{}", choices.size() > 1 ? "one of " : "", fmt::join(shown, ", "),
                                   choices.size() > kMost ? ", ..." : "");
    std::string_view best;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const auto choice : choices) {
        if (word.size() > 2 * choice.size() + 2) continue; // can't be near; spares the work for long junk
        if (const std::size_t d = edit_distance(word, choice); d < least) least = d, best = choice;
    }
    if (!best.empty()) text += fmt::format("; did you mean '{}'?", best);
    return text;
}

} // namespace keyhole
