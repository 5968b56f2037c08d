#include "scene/load/yaml/shapes.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

using PrimitiveReader = Geometry (*)(const YamlNode&, MeshCache&);

/// A shape's map, with the keys that all shapes have and its own.
MapReader shape_map(const YamlNode& node, std::string_view what, const std::vector<std::string_view>& own) {
    std::vector<std::string_view> keys{"type",  "material", "transform", "emission", "flip",
                                       "alpha", "inside",   "outside",   "name"};
    keys.insert(keys.end(), own.begin(), own.end());
    return {node, what, keys};
}

Geometry read_rectangle(const YamlNode& node, MeshCache& /*meshes*/) {
    const MapReader map = shape_map(node, "a rectangle", {"corner", "u", "v"});
    if (!map.find("corner") && !map.find("u") && !map.find("v"))
        return make_parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    const auto corner = read_vec3(map.at("corner"), kCoordinate);
    const auto u = read_vec3(map.at("u"), kCoordinate), v = read_vec3(map.at("v"), kCoordinate);
    if (!(u.cross(v).length() > 1e-7 * u.length() * v.length()))
        fail(map.at("v"), "found a rectangle without area, expected u and v in different directions");
    return make_parallelogram(Vec3(corner), Vec3(u), Vec3(v));
}

Geometry read_box(const YamlNode& node, MeshCache& /*meshes*/) {
    const MapReader map = shape_map(node, "a box", {"min", "max"});
    const Vec3 minimum(map.vec3("min", kCoordinate, Imath::V3d(-1.0)));
    const Vec3 maximum(map.vec3("max", kCoordinate, Imath::V3d(1.0)));
    for (int axis = 0; axis < 3; ++axis)
        if (!(minimum[axis] < maximum[axis]))
            fail(map.find("max") != nullptr ? map.at("max") : map.at("min"),
                 fmt::format("found {} from {} to {}, expected min below max", "xyz"[axis], minimum[axis],
                             maximum[axis]));
    return make_box(minimum, maximum);
}

Geometry read_sphere(const YamlNode& node, MeshCache& /*meshes*/) {
    constexpr NumberRange kRadius{"a radius", 1e-12, 1e12};
    const MapReader map = shape_map(node, "a sphere", {"center", "radius"});
    return Sphere{Vec3(map.vec3("center", kCoordinate, Imath::V3d(0.0))),
                  static_cast<float>(map.number("radius", kRadius, 1.0)), false};
}

Geometry read_mesh(const YamlNode& node, MeshCache& meshes) {
    const MapReader map = shape_map(node, "a mesh", {"file", "smooth"});
    const YamlNode& file = map.at("file");
    const std::string path = resolve_path(file, "the path of a mesh");
    auto cached = meshes.find(path);
    if (cached == meshes.end()) {
        try {
            cached = meshes.emplace(path, import_mesh(path)).first;
        } catch (const InputError& e) {
            fail(file, e.what());
        }
    }
    TriangleMesh mesh = cached->second;
    if (const YamlNode* smooth = map.find("smooth")) {
        if (!read_bool(*smooth))
            mesh.normals.clear();
        else if (mesh.normals.empty())
            smooth_normals(mesh);
    }
    return mesh;
}

const std::map<std::string_view, PrimitiveReader>& primitive_readers() {
    static const std::map<std::string_view, PrimitiveReader> table{
        {"rectangle", read_rectangle}, {"box", read_box}, {"sphere", read_sphere}, {"mesh", read_mesh}};
    return table;
}

} // namespace

const std::vector<std::string_view>& geometry_types() {
    static const std::vector<std::string_view> types = keys_of(primitive_readers());
    return types;
}

Geometry read_geometry(const std::string& type, const YamlNode& node, MeshCache& meshes) {
    return primitive_readers().at(type)(node, meshes);
}

} // namespace keyhole
