// The files of src as the tests of the architecture read them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace keyhole::source_test {

using Strings = std::vector<std::string>;

/// A source file; `path` is relative to src.
struct Source {
    std::string path;
    Strings lines;

    std::string layer() const { return path.substr(0, path.find('/')); }
    std::string folder() const { return path.substr(0, path.rfind('/')); }
    std::string text() const {
        std::string all;
        for (const std::string& line : lines) all += line + "\n";
        return all;
    }
};

inline std::filesystem::path root() { return std::filesystem::path(KEYHOLE_SOURCE_DIR) / "src"; }

inline std::vector<Source> all_sources() {
    std::vector<Source> sources;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root())) {
        if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
        Source& source = sources.emplace_back(Source{entry.path().lexically_relative(root()).generic_string(), {}});
        std::ifstream file(entry.path());
        for (std::string line; std::getline(file, line);) source.lines.push_back(line);
    }
    return sources;
}

} // namespace keyhole::source_test
