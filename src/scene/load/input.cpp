#include "scene/load/input.h"

#include "core/files_read.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>
#include <utility>

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

/// What other programs call it, and what it is called here.
constexpr auto kOtherWords = std::to_array<std::pair<std::string_view, std::string_view>>({
    {"lights", "emitters"},
    {"lamps", "emitters"},
    {"objects", "shapes"},
    {"meshes", "shapes"},
    {"settings", "render"},
    {"integrator", "render"},
    {"position", "from"},
    {"origin", "from"},
    {"eye", "from"},
    {"look_at", "to"},
    {"lookat", "to"},
    {"target", "to"},
    {"sun", "distant"},
    {"directional", "distant"},
    {"sky", "environment"},
    {"envmap", "environment"},
    {"color", "reflectance"},
    {"albedo", "reflectance"},
    {"base_color", "reflectance"},
    {"metal", "conductor"},
    {"mirror", "conductor"},
    {"lambertian", "diffuse"},
    {"quad", "rectangle"},
    {"cube", "box"},
    {"samples", "spp"},
    {"strength", "radiance"},
    {"intensity", "radiance"},
    {"center", "position"},
});

} // namespace

std::string expected_one_of(std::string_view word, const std::vector<std::string_view>& choices) {
    if (choices.empty()) return "expected none, as none are defined";
    constexpr std::size_t kMost = 24; // a list that nobody reads helps nobody
    const std::vector<std::string_view> shown(
        choices.begin(), choices.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, choices.size())));
    return fmt::format("expected {}{}{}{}", choices.size() > 1 ? "one of " : "", fmt::join(shown, ", "),
                       choices.size() > kMost ? ", ..." : "", did_you_mean(word, choices));
}

std::string did_you_mean(std::string_view word, const std::vector<std::string_view>& choices) {
    std::string_view best;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const auto choice : choices) {
        if (word.size() > 2 * choice.size() + 2) continue; // can't be near; spares the work for long junk
        if (const std::size_t d = edit_distance(word, choice); d < least) least = d, best = choice;
    }
    for (const auto& [other, ours] : kOtherWords)
        if (best.empty() && other == word && std::ranges::find(choices, ours) != choices.end()) best = ours;
    return best.empty() ? "" : fmt::format("; did you mean '{}'?", best);
}

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

std::string read_text_file(const std::string& path, std::string_view what, std::size_t most_bytes) {
    const auto fail = [&](const std::string& why) -> std::string { throw InputError({path, 0, 0}, why); };
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (std::filesystem::is_directory(status)) return fail(fmt::format("found a directory, expected {}", what));
    if (!std::filesystem::is_regular_file(status))
        return fail(fmt::format("found {}, expected {}", found_in_place_of_file(path), what));
    if (const auto bytes = std::filesystem::file_size(path, error); !error && bytes > most_bytes)
        return fail(fmt::format("found {} bytes, expected at most {}", bytes, most_bytes));
    std::ifstream stream(path, std::ios::binary);
    if (!stream) return fail("found a file that can't be opened, expected a readable one");
    note_file_read(path);
    std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (stream.bad()) return fail("found a file that can't be read, expected a readable one");
    return text;
}

std::string read_packed_file(const std::string& path, std::size_t most_unpacked) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw InputError("found no readable file, expected a mesh");
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
    const auto size = std::filesystem::file_size(path, error);
    if (file == nullptr || error) throw InputError("found no readable file, expected a mesh");
    note_file_read(path);
    std::string bytes(size + 1, '\0'); // one more, that the end of a file that isn't packed is found at once
    std::size_t count = 0;
    for (int read = 1; read > 0; count += static_cast<std::size_t>(std::max(0, read))) {
        if (count > most_unpacked && gzdirect(file.get()) == 0)
            throw InputError(fmt::format("found more than {} bytes packed with gzip, expected fewer", most_unpacked));
        if (count == bytes.size()) bytes.resize(2 * count);
        constexpr std::size_t kMostAtOnce = 1 << 30; // zlib counts in 32 bits
        read = gzread(file.get(), &bytes[count], static_cast<unsigned>(std::min(bytes.size() - count, kMostAtOnce)));
    }
    int code = Z_OK;
    const std::string_view message = gzerror(file.get(), &code); // "path: what is wrong"
    if (code == Z_BUF_ERROR) throw InputError("found packed data that end too early, expected a whole gzip file");
    if (code != Z_OK)
        throw InputError(fmt::format("found broken packed data ({}), expected a valid gzip file",
                                     message.substr(std::min(message.size(), path.size() + 2))));
    bytes.resize(count);
    return bytes;
}

} // namespace keyhole
