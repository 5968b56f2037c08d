#include "scene/load/yaml/properties.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

constexpr double kSingular = 1e-12; // far above rounding in doubles, far below what floats could show

Transform read_scale(const YamlNode& node) {
    const NumberRange range{"a scale factor", -1e12, 1e12};
    const Imath::V3d s =
        node.kind == YamlNode::Kind::list ? read_vec3(node, range) : Imath::V3d(read_number(node, range));
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(s[axis]) < kSingular)
            fail(node, fmt::format("found a singular transform (scale {:g}), expected factors other than 0", s[axis]));
    Transform t;
    t.setScale(s);
    return t;
}

Transform read_rotation(const YamlNode& node) {
    const auto n = read_numbers(node, 4, kCoordinate);
    const Imath::V3d axis(n[1], n[2], n[3]);
    if (!(axis.length() > 0)) fail(node, "found the rotation axis [0, 0, 0], expected one with a direction");
    Transform t;
    t.setAxisAngle(axis.normalized(), n[0] * kPi / 180);
    return t;
}

Transform read_matrix(const YamlNode& node) {
    const auto n = read_numbers(node, 16, kCoordinate);
    if (n[12] != 0 || n[13] != 0 || n[14] != 0 || n[15] != 1)
        fail(*node.items[12], "found a projective matrix, expected 0, 0, 0, 1 as its last row");
    Transform t;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) t[column][row] = n[static_cast<std::size_t>(4 * row + column)];
    if (regularity(t) < kSingular) fail(node, "found a singular matrix, expected one that can be inverted");
    return t;
}

Transform read_step(const YamlNode& node) {
    const MapReader map(node, "a transform", {"scale", "rotate", "translate", "matrix"});
    if (node.entries.size() != 1)
        fail(node, fmt::format("found {} transforms in one map, expected one (list several in their order)",
                               node.entries.size()));
    if (const YamlNode* scale = map.find("scale")) return read_scale(*scale);
    if (const YamlNode* rotate = map.find("rotate")) return read_rotation(*rotate);
    if (const YamlNode* matrix = map.find("matrix")) return read_matrix(*matrix);
    Transform t;
    t.setTranslation(read_vec3(map.at("translate"), kCoordinate));
    return t;
}

} // namespace

Transform read_transform(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::map) return read_step(node);
    Transform all;
    for (const auto& step : read_list(node, "transforms")) all = all * read_step(*step);
    if (!(regularity(all) > kSingular)) fail(node, "found a singular transform, expected one that can be inverted");
    return all;
}

} // namespace keyhole
