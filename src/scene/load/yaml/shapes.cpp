#include "scene/load/yaml/shapes.h"

#include "scene/geometry.h"
#include "scene/load/input.h"
#include "scene/load/yaml/reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole {
namespace {

constexpr int kMaxGroupDepth = 64; // bounds the recursion below

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

/// The geometry of a shape of a known type, in its own space.
const std::map<std::string_view, PrimitiveReader> kPrimitives{
    {"rectangle", read_rectangle}, {"box", read_box}, {"sphere", read_sphere}, {"mesh", read_mesh}};

/// Takes what stands in the map of a shape to its place.
void place_geometry(Geometry& geometry, const YamlNode& node, const Transform& to) {
    transform_geometry(geometry, to);
    if (MapReader(node, "a shape").boolean("flip", false)) flip(geometry);
}

} // namespace

void ShapeReader::read_groups(const YamlNode& section) {
    for (const YamlNode::Entry& entry : read_names(section, "lists of shapes"))
        mistakes_.attempt_definition([&] { add_group(entry); });
}

void ShapeReader::add_group(const YamlNode::Entry& entry) {
    const auto& [key, value] = entry;
    read_list(*value, "shapes");
    const auto [known, fresh] = groups_.try_emplace(key->text, Group{key, value});
    if (!fresh)
        fail(*key, fmt::format("found the group '{}' again, expected another name (first at {})", key->text,
                               known->second.key->position().to_string()));
}

void ShapeReader::read_shapes(const YamlNode& section) {
    for (const auto& item : read_list(section, "shapes")) mistakes_.attempt([&] { read_shape(*item, {}); });
}

void ShapeReader::append(std::vector<Shape> shapes) {
    for (const TriangleMesh* mesh : held_meshes(shapes)) triangles_ += mesh->triangles.size();
    for (Shape& shape : shapes) shapes_.push_back(std::move(shape));
}

void ShapeReader::check_unused_groups() {
    const std::size_t shapes = shapes_.size(), instances = instances_, leaves = leaves_;
    for (auto& [name, group] : groups_)
        if (!group.used) mistakes_.attempt([&, &unused = group] { read_named_group(unused, *unused.key, {}); });
    shapes_.resize(shapes);
    instances_ = instances;
    leaves_ = leaves;
}

void ShapeReader::read_list_of_shapes(const YamlNode& list, const Placement& placement) {
    if (placement.depth > kMaxGroupDepth)
        fail(list, fmt::format("found groups nested more than {} deep, expected fewer levels", kMaxGroupDepth));
    for (const auto& item : read_list(list, "shapes")) read_shape(*item, placement);
}

void ShapeReader::read_shape(const YamlNode& node, const Placement& placement) {
    std::vector<std::string_view> types = keys_of(kPrimitives);
    types.insert(types.end(), {"group", "instance"});
    const std::string type = read_type(node, "a shape", types);
    if (type == "group") return read_group(node, placement);
    if (type == "instance") return read_instance(node, placement);

    ++leaves_;
    check_limits(node);
    Shape shape;
    const auto known = group_meshes_.find(&node);
    const bool held = known != group_meshes_.end() && known->second.shared;
    if (!held) shape.geometry = kPrimitives.at(type)(node, meshes_);
    const MapReader map(node, "a shape");
    Placement own = inherit(map, placement);
    GroupMesh* group = type == "mesh" ? group_mesh(node, own) : nullptr;
    if (group != nullptr && group->shared) {
        shape.geometry = group->shared->placed(own.copy);
    } else {
        if (held) shape.geometry = kPrimitives.at(type)(node, meshes_);
        place_geometry(shape.geometry, node, own.to_world);
    }
    const bool is_copy = std::holds_alternative<MeshInstance>(shape.geometry);
    if (!is_copy && !has_bounded_positions(shape.geometry))
        fail(node, "found a shape too large or too far, expected it within 1e13");
    if (type == "mesh" && !has_area(shape.geometry))
        return warnings_.add_flat_mesh(node.position(), fmt::format("mesh '{}'", map.at("file").text));
    const double area = is_copy ? 0 : surface_area(shape); // no copy emits
    if (!is_copy && !(area > 0))
        fail(node, "found a shape without area, expected one that can be seen: of coordinates about 7 "
                   "digits are kept, and small shapes far from the origin lose their area");

    const YamlNode* emission = map.find("emission");
    if (emission != nullptr) shape.emission = read_emission(*emission, area);
    shape.material = own.material;
    shape.name = std::move(own.name);
    shape.material_name = std::move(own.material_name);
    if (!shape.material) {
        if (emission == nullptr) fail(node, fmt::format("found a {} without 'material', expected that key", type));
        static const MaterialPtr black = make_diffuse(Rgb(0.0)); // one for all lamps that reflect nothing
        shape.material = black;
    }
    constexpr NumberRange kOpacity{"an opacity", 0, 1};
    const SurfaceDefaults surface = shape.material->surface();
    if (emission == nullptr) shape.emission = emission_of({surface.emission, true}, area);
    const YamlNode* alpha = map.find("alpha");
    shape.alpha = alpha != nullptr ? read_float_texture(*alpha, kOpacity) : surface.alpha;
    if (const YamlNode* inside = map.find("inside")) shape.inside = media_.resolve(*inside);
    if (const YamlNode* outside = map.find("outside")) shape.outside = media_.resolve(*outside);
    if (!is_copy) triangles_ += triangle_count(shape);
    shapes_.push_back(std::move(shape));
    if (group != nullptr && !group->shared) add_copy(*group, node, own);
    check_limits(node);
}

/// What instances may share of a mesh in a group. Null: nothing, for another mesh has the name, or what emits is not
/// shared.
ShapeReader::GroupMesh* ShapeReader::group_mesh(const YamlNode& node, const Placement& own) {
    const bool emits = MapReader(node, "a shape").find("emission") != nullptr ||
                       (own.material && !is_black(own.material->surface().emission));
    if (own.copy == nullptr || emits) return nullptr;
    const auto known = group_meshes_.try_emplace(&node, GroupMesh{own.to_object, {}, {}}).first;
    return known->second.to_object == own.to_object ? &known->second : nullptr;
}

/// The last shape is a copy; with enough of them all become instances.
void ShapeReader::add_copy(GroupMesh& mesh, const YamlNode& node, const Placement& own) {
    mesh.copies.push_back({shapes_.size() - 1, own.copy});
    const std::size_t triangles = triangle_count(shapes_.back()), copies = mesh.copies.size();
    if (!is_worth_sharing(triangles, copies)) return;
    Geometry geometry = kPrimitives.at("mesh")(node, meshes_);
    place_geometry(geometry, node, mesh.to_object);
    mesh.shared.emplace(std::move(std::get<TriangleMesh>(geometry)));
    triangles_ += mesh.shared->mesh().triangles.size();
    for (const GroupMesh::Copy& copy : mesh.copies) {
        if (!mesh.shared->stands_as_instance(*copy.to_world)) continue; // it stays as it is
        shapes_[copy.shape].geometry = mesh.shared->placed(copy.to_world);
        triangles_ -= triangles;
    }
    mesh.copies.clear();
}

void ShapeReader::read_group(const YamlNode& node, const Placement& placement) {
    const MapReader map(node, "a group", {"type", "shapes", "transform", "material", "name"});
    read_list_of_shapes(map.at("shapes"), inherit(map, placement));
}

void ShapeReader::read_instance(const YamlNode& node, const Placement& placement) {
    const MapReader map(node, "an instance", {"type", "group", "transform", "material", "name"});
    const YamlNode& reference = map.at("group");
    const std::string name = read_string(reference, "the name of a group");
    const auto found = groups_.find(name);
    if (found == groups_.end())
        throw UnknownName(reference.position(), fmt::format("group '{}'", name), unknown_name("group", name, groups_));
    ++instances_;
    Placement own = inherit(map, placement);
    own.copy = std::make_shared<const ObjectToWorld>(own.to_world);
    own.to_object = Transform();
    read_named_group(found->second, reference, own);
}

void ShapeReader::read_named_group(Group& group, const YamlNode& user, const Placement& placement) {
    if (group.open) fail(user, fmt::format("found the group '{}' within itself, expected no cycle", group.key->text));
    group.used = true;
    if (group.empty) return; // or groups of many empty ones, each of many of the next, would take for ever
    group.open = true;
    const std::size_t before = leaves_;
    const struct Closer {
        Group& group;
        ~Closer() { group.open = false; } // after a mistake, too: the group may be placed again
    } closer{group};
    read_list_of_shapes(*group.shapes, placement);
    group.empty = leaves_ == before;
}

ShapeReader::Placement ShapeReader::inherit(const MapReader& map, const Placement& placement) const {
    Placement own = placement;
    ++own.depth;
    if (const YamlNode* transform = map.find("transform")) {
        const Transform t = read_transform(*transform);
        own.to_world = t * placement.to_world;
        own.to_object = t * placement.to_object;
        if (!(regularity(own.to_world) > 1e-12))
            fail(*transform,
                 "found a transform that is singular with those around it, expected one that can be inverted");
    }
    if (const YamlNode* name = map.find("name")) own.name = read_string(*name, "a name");
    if (const YamlNode* material = map.find("material")) {
        own.material = find_material(*material, materials_);
        own.material_name = material->kind == YamlNode::Kind::map ? "" : material->text;
    }
    return own;
}

void ShapeReader::check_limits(const YamlNode& node) const {
    const auto stop = [&](std::size_t most, const char* what) {
        throw FatalInputError(node.position(), fmt::format("found more than {} {}, expected fewer", most, what));
    };
    if (std::max(shapes_.size(), leaves_) > kMaxShapes) stop(kMaxShapes, "shapes");
    if (triangles_ > kMaxTriangles) stop(kMaxTriangles, "triangles");
}

} // namespace keyhole
