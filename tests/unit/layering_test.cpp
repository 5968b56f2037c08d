// The house keeps its order: rooms include only what lies to their left, only the command line talks, files stay short,
// and nothing depends on which thread runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace {

using Strings = std::vector<std::string>;
namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> kRooms{"core", "scene",  "sampling", "photonmap", "gather",
                                                 "film", "render", "cli",      "mpi"};
constexpr std::size_t kMostLines = 400;

/// A source file; `path` is relative to src.
struct Source {
    std::string path;
    Strings lines;

    std::string room() const { return path.substr(0, path.find('/')); }
};

std::ptrdiff_t rank(std::string_view room) { return std::ranges::find(kRooms, room) - kRooms.begin(); }
bool is_room(std::string_view room) { return std::ranges::find(kRooms, room) != kRooms.end(); }

std::string without_comment(const std::string& line) { return line.substr(0, line.find("//")); }

std::vector<Source> all_sources() {
    const fs::path root = fs::path(KEYHOLE_SOURCE_DIR) / "src";
    std::vector<Source> sources;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
        Source& source = sources.emplace_back(Source{entry.path().lexically_relative(root).generic_string(), {}});
        std::ifstream file(entry.path());
        for (std::string line; std::getline(file, line);) source.lines.push_back(line);
    }
    return sources;
}

/// `path:line: text` of the lines that `is_wrong`.
template <class IsWrong> Strings wrong_lines(const Source& source, IsWrong&& is_wrong) {
    Strings found;
    for (std::size_t i = 0; i < source.lines.size(); ++i) {
        if (is_wrong(source.lines[i])) {
            found.push_back(source.path + ":" + std::to_string(i + 1) + ": " + source.lines[i]);
        }
    }
    return found;
}

/// Includes of a room further right, and of files that are named other than from the root of src.
Strings wrong_includes(const Source& source) {
    static const std::regex include("^\\s*#\\s*include\\s*\"(([^/\"]*)/)?([^\"]*)\"");
    return wrong_lines(source, [&](const std::string& line) {
        std::smatch m;
        if (!std::regex_search(line, m, include)) return false;
        const std::string room = m[2];
        if (!is_room(room)) return true;
        return rank(room) > rank(source.room());
    });
}

/// Output and exits; only the command line does either, and the main() of the program with MPI.
Strings wrong_talk(const Source& source) {
    static const std::regex talk(
        R"(\b(cout|cerr|clog)\b|\b(f?printf|puts|fputs|perror)\s*\(|\bfmt::print|)"
        R"(#\s*include\s*<(iostream|CLI/[^>]*)>|\b(exit|_Exit|quick_exit|abort|terminate)\s*\()");
    if (source.room() == "cli" || source.path == "mpi/main.cpp") return {};
    return wrong_lines(source, [](const std::string& l) { return std::regex_search(without_comment(l), talk); });
}

/// What would let threads, the clock or chance into a picture.
Strings wrong_randomness(const Source& source) {
    static const std::regex chance(
        R"(\bseed_?\s*(\+|\^)|(\+|\^)\s*seed_?\b|\bthis_thread::get_id|\bthread_index\b|\bcurrent_thread_index\b|)"
        R"(\brandom_device\b|\bs?rand\s*\(|\bmt19937|\btime\s*\(\s*(0|NULL|nullptr)\s*\)|\bparallel_reduce\b)");
    return wrong_lines(source, [](const std::string& l) { return std::regex_search(without_comment(l), chance); });
}

template <class Rule> Strings over_all(Rule&& rule) {
    Strings found;
    for (const Source& source : all_sources()) std::ranges::copy(rule(source), std::back_inserter(found));
    return found;
}

} // namespace

TEST(Layering, IncludesPointToTheLeftOnly) { EXPECT_THAT(over_all(wrong_includes), testing::IsEmpty()); }

TEST(Layering, OnlyTheCommandLineTalksOrExits) { EXPECT_THAT(over_all(wrong_talk), testing::IsEmpty()); }

TEST(Layering, NothingDependsOnThreadsOrChance) { EXPECT_THAT(over_all(wrong_randomness), testing::IsEmpty()); }

TEST(Layering, EveryFileLiesInARoom) {
    const auto sources = all_sources();
    ASSERT_GT(sources.size(), 50u) << "sources not found under " KEYHOLE_SOURCE_DIR;
    for (const Source& source : sources) EXPECT_TRUE(is_room(source.room())) << source.path;
}

TEST(Layering, FilesStayShort) {
    for (const Source& source : all_sources()) EXPECT_LE(source.lines.size(), kMostLines) << source.path;
}

TEST(Layering, RulesCatchWhatTheyForbid) {
    const Source wrong{"sampling/a.cpp",
                       {"#include \"photonmap/photon.h\"", "#include \"film/picture.h\"", "#include \"measure.h\"",
                        "std::cerr << x;", "fmt::print(\"x\");", "if (bad) std::exit(1);", "Rng rng(seed + thread);",
                        "std::random_device device;"}};
    EXPECT_EQ(wrong_includes(wrong).size(), 3u);
    EXPECT_EQ(wrong_talk(wrong).size(), 3u);
    EXPECT_EQ(wrong_randomness(wrong).size(), 2u);
}

TEST(Layering, RulesAllowWhatTheyShould) {
    const Strings fine{"#include \"core/rng.h\"", "#include \"sampling/path.h\"", "#include <vector>",
                       "entry.seed = o.seed; // not seed + thread", "snprintf(buffer, 8, text);"};
    EXPECT_THAT(wrong_includes({"gather/a.cpp", fine}), testing::IsEmpty());
    EXPECT_THAT(wrong_talk({"gather/a.cpp", fine}), testing::IsEmpty());
    EXPECT_THAT(wrong_randomness({"gather/a.cpp", fine}), testing::IsEmpty());
    EXPECT_THAT(wrong_talk({"cli/main.cpp", {"std::cerr << x; return 1;"}}), testing::IsEmpty());
}
