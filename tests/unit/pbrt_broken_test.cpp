// Scene files broken in hundreds of ways: each is an error with its place, or a scene; nothing crashes or hangs.
#include "core/error.h"
#include "support/pbrt_scenes.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace keyhole {
namespace {

std::string read(const std::string& name) {
    std::ifstream file(std::string(KEYHOLE_SOURCE_DIR) + "/tests/data/pbrt/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Begin and end of each token.
std::vector<std::pair<std::size_t, std::size_t>> tokens(const std::string& text) {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] == '#') i = text.find('\n', i);
        const std::size_t begin = text.find_first_not_of(" \n", i);
        if (begin == std::string::npos) break;
        const std::size_t end = text[begin] == '"' ? text.find('"', begin + 1) + 1 : text.find_first_of(" \n", begin);
        found.emplace_back(begin, end);
        i = end;
    }
    return found;
}

/// @returns whether the scene was refused.
bool is_refused(const ScratchDirectory& directory, const std::string& text) {
    const std::string path = directory.write("room.pbrt", text);
    try {
        std::vector<std::string> warnings;
        load_pbrt(path, &warnings);
        return false;
    } catch (const InputError& e) {
        EXPECT_EQ(std::string(e.what()).rfind(directory.path(""), 0), 0u) << e.what() << " names no file";
        return true;
    }
}

/// Replaces each token of a scene by junk. @returns how many scenes that makes, and how many of them are refused.
std::pair<int, int> replace_tokens(const std::string& name) {
    const ScratchDirectory directory;
    directory.write("walls.pbrt", read("walls.pbrt"));
    directory.write("triangle.ply", read("triangle.ply"));
    const std::string whole = read(name);
    EXPECT_FALSE(is_refused(directory, whole));
    const std::vector<std::string> junk{
        "nan", "-1", "1e999", "\"junk\"", "[", "]", "", "true", std::string("\0\x01", 2), "0"};
    int refused = 0, total = 0;
    for (const auto& [begin, end] : tokens(whole)) {
        for (const std::string& j : junk) {
            ++total;
            refused += is_refused(directory, whole.substr(0, begin) + j + whole.substr(end)) ? 1 : 0;
        }
    }
    return {total, refused};
}

TEST(PbrtBroken, EveryTokenReplacedIsAnErrorOrAScene) {
    for (const char* name : {"room.pbrt", "hair.pbrt"}) {
        const auto [total, refused] = replace_tokens(name);
        EXPECT_GT(total, 1000) << name;
        EXPECT_GT(refused, total / 2) << name;
    }
}

TEST(PbrtBroken, ACameraOutOfBoundsIsRefused) {
    const ScratchDirectory directory;
    const std::string camera = "Camera \"perspective\" WorldBegin Shape \"sphere\"";
    EXPECT_FALSE(is_refused(directory, "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 5 1] " + camera));
    EXPECT_TRUE(is_refused(directory, "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 1e20 5 1] " + camera));
}

TEST(PbrtBroken, MissingAndBrokenMeshesAreNamed) {
    const ScratchDirectory directory;
    directory.write("walls.pbrt", read("walls.pbrt"));
    EXPECT_TRUE(is_refused(directory, read("room.pbrt"))); // no triangle.ply
    const std::string ply = read("triangle.ply");
    for (std::size_t n = 0; n + 4 < ply.size(); n += 10) {
        directory.write("triangle.ply", ply.substr(0, n));
        EXPECT_TRUE(is_refused(directory, read("room.pbrt"))) << n;
    }
}

} // namespace
} // namespace keyhole
