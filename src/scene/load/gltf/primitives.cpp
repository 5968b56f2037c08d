#include "scene/load/gltf/primitives.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole::gltf {
namespace {

/// Modes in the order of their numbers: points, three kinds of lines, triangles, strips and fans of them.
constexpr int kFirstLines = 1, kTriangles = 4, kLastMode = 6;

} // namespace

void IndexCheck::check(const Json& primitive) {
    const Json& attributes = member(primitive, "attributes");
    if (!primitive.contains("indices") || !attributes.contains("POSITION")) return;
    const auto index = value_of<std::size_t>(primitive["indices"], "indices"),
               position = value_of<std::size_t>(attributes["POSITION"], "POSITION");
    const auto [largest, fresh] = largest_.try_emplace(index, 0);
    if (fresh) {
        const std::vector<std::uint32_t> indices = reader_.read_indices(index);
        if (!indices.empty()) largest->second = *std::ranges::max_element(indices);
    }
    const auto positions = document_.entry("accessors", position).at("count").get<std::size_t>();
    if (largest->second >= positions)
        document_.fail(
            fmt::format("found the index {}, expected one of {} positions, from 0 on", largest->second, positions));
}

void LeftOutParts::tell(const char* what, const std::string& of) {
    if (!told_.insert(what).second) return;
    document_.warn(fmt::format("{} are left out, such as {}", what, of));
}

void LeftOutParts::note_primitive(const Json& primitive, const std::string& owner) {
    const int mode = value_or(primitive, "mode", kTriangles);
    if (mode < 0 || mode > kLastMode)
        document_.fail(fmt::format("found the mode {}, expected 0 to {}", mode, kLastMode));
    if (mode < kTriangles) return tell(mode < kFirstLines ? "points" : "lines", "those of " + owner);
    const Json& attributes = member(primitive, "attributes");
    const bool indexed = primitive.contains("indices");
    if (!indexed && !attributes.contains("POSITION")) return;
    const auto list = indexed ? value_of<std::size_t>(primitive["indices"], "indices")
                              : value_of<std::size_t>(attributes["POSITION"], "POSITION");
    const auto corners = document_.entry("accessors", list).at("count").get<std::size_t>();
    const std::size_t left = mode == kTriangles ? corners % 3 : corners < 3 ? corners : 0;
    if (left > 0) tell("corners of no whole triangle", fmt::format("{} of {} of {}", left, corners, owner));
}

void LeftOutParts::note(std::size_t mesh) {
    const Json& whole = document_.entry("meshes", mesh);
    const std::string owner = called("mesh", mesh, whole);
    document_.within(owner, [&] {
        for (const Json& primitive : member(whole, "primitives"))
            if (primitive.is_object()) note_primitive(primitive, owner);
    });
}

} // namespace keyhole::gltf
