// The architecture: layers and the folders of sampling include only what lies to their left, only the command line
// talks, files stay short, and nothing depends on which thread runs it.
#include "source_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <regex>
#include <string>
#include <string_view>

namespace {

using keyhole::source_test::all_sources;
using keyhole::source_test::Source;
using keyhole::source_test::Strings;

constexpr std::array<std::string_view, 10> kLayers{"core", "scene",   "sampling", "photonmap", "gather",
                                                   "film", "session", "methods",  "cli",       "mpi"};
/// Folders of sampling: chains and their proposals know nothing of paths, paths nothing of who moves them. What lies in
/// sampling itself stands beside proposals.
constexpr std::array<std::string_view, 6> kSampling{"sampling/markov",    "sampling/paths", "sampling/guidance",
                                                    "sampling/proposals", "sampling",       "sampling/primary"};
constexpr std::size_t kMostLines = 400;

std::ptrdiff_t rank(std::string_view layer) { return std::ranges::find(kLayers, layer) - kLayers.begin(); }
bool is_layer(std::string_view layer) { return std::ranges::find(kLayers, layer) != kLayers.end(); }

std::string without_comment(const std::string& line) { return line.substr(0, line.find("//")); }

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

/// Includes of a layer further right, and of files that are named other than from the root of src.
Strings wrong_includes(const Source& source) {
    static const std::regex include("^\\s*#\\s*include\\s*\"(([^/\"]*)/)?([^\"]*)\"");
    return wrong_lines(source, [&](const std::string& line) {
        std::smatch m;
        if (!std::regex_search(line, m, include)) return false;
        const std::string layer = m[2];
        if (!is_layer(layer)) return true;
        return rank(layer) > rank(source.layer());
    });
}

/// That of kSampling which a folder is or lies in.
auto sampling_folder(std::string folder) {
    auto found = std::ranges::find(kSampling, folder);
    for (std::size_t end; found == kSampling.end() && (end = folder.rfind('/')) != std::string::npos;) {
        folder.resize(end);
        found = std::ranges::find(kSampling, folder);
    }
    return found;
}

/// Includes in sampling of a folder further right.
Strings wrong_folders(const Source& source) {
    static const std::regex include("^#include \"(.*)/[^/]*\"");
    const auto folder = sampling_folder(std::string(source.folder()));
    return wrong_lines(source, [&](const std::string& line) {
        std::smatch m;
        if (folder == kSampling.end() || !std::regex_search(line, m, include)) return false;
        const auto other = sampling_folder(m[1].str());
        return other != kSampling.end() && other > folder;
    });
}

/// The files of `lines`, as wrong_lines() makes them, once each.
Strings files_of(const Strings& lines) {
    Strings files;
    for (const std::string& line : lines) files.push_back(line.substr(0, line.find(':')));
    std::ranges::sort(files);
    files.erase(std::unique(files.begin(), files.end()), files.end());
    return files;
}

/// Files that still look to the right. A list that only gets shorter.
const Strings kBackwards{"sampling/guidance/found/suggest_paths.cpp",
                         "sampling/guidance/found/suggest_paths.h",
                         "sampling/guidance/guided_subpath.cpp",
                         "sampling/guidance/guided_subpath.h",
                         "sampling/markov/chain_set.h",
                         "sampling/paths/bidirectional_tracer.h"};

/// Output and exits; only the command line does either, and the main() of the program with MPI.
Strings wrong_talk(const Source& source) {
    static const std::regex talk(
        R"(\b(cout|cerr|clog)\b|\b(f?printf|puts|fputs|perror)\s*\(|\bfmt::print|)"
        R"(#\s*include\s*<(iostream|CLI/[^>]*)>|\b(exit|_Exit|quick_exit|abort|terminate)\s*\()");
    if (source.layer() == "cli" || source.path == "mpi/main.cpp") return {};
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

TEST(Layering, FoldersOfSamplingPointToTheLeftOnly) {
    const Strings wrong = over_all(wrong_folders);
    EXPECT_EQ(files_of(wrong), kBackwards) << testing::PrintToString(wrong);
}

TEST(Layering, OnlyTheCommandLineTalksOrExits) { EXPECT_THAT(over_all(wrong_talk), testing::IsEmpty()); }

TEST(Layering, NothingDependsOnThreadsOrChance) { EXPECT_THAT(over_all(wrong_randomness), testing::IsEmpty()); }

TEST(Layering, EveryFileLiesInALayer) {
    const auto sources = all_sources();
    ASSERT_GT(sources.size(), 50u) << "sources not found under " KEYHOLE_SOURCE_DIR;
    for (const Source& source : sources) EXPECT_TRUE(is_layer(source.layer())) << source.path;
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
    EXPECT_EQ(wrong_folders({"sampling/markov/a.h", {"#include \"sampling/paths/path.h\""}}).size(), 1u);
    EXPECT_EQ(wrong_folders({"sampling/guidance/found/a.h", {"#include \"sampling/proposals/edit.h\""}}).size(), 1u);
    EXPECT_EQ(wrong_folders({"sampling/paths/a.h", {"#include \"sampling/markov/chain.h\""}}).size(), 0u);
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
