#include "scene/load/pbrt/shapes.h"

#include "scene/load/input.h"
#include "scene/load/load_mesh.h"

#include <fmt/format.h>

#include <map>

namespace keyhole::pbrt {
namespace {

std::vector<Vec3> read_vectors(Parameters& p, std::string_view name, std::initializer_list<std::string_view> types) {
    const std::vector<double> n = p.numbers(name, types);
    std::vector<Vec3> v;
    v.reserve(n.size() / 3);
    for (std::size_t i = 0; i + 2 < n.size(); i += 3) v.emplace_back(n[i], n[i + 1], n[i + 2]);
    return v;
}

std::vector<Vec2> read_uvs(Parameters& p) {
    const std::string_view name = p.has("uv") ? "uv" : "st"; // the latter: v3
    // v3 wrote them as floats.
    const std::vector<double> n = p.numbers(name, {"point2", "vector2", "float"});
    std::vector<Vec2> v;
    v.reserve(n.size() / 2);
    for (std::size_t i = 0; i + 1 < n.size(); i += 2) v.emplace_back(n[i], n[i + 1]);
    return v;
}

/// Positions, and as many normals and texture coordinates where there are any.
TriangleMesh read_vertices(Parameters& p) {
    TriangleMesh mesh;
    mesh.positions = read_vectors(p, "P", {"point3"});
    mesh.normals = read_vectors(p, "N", {"normal"});
    mesh.uvs = read_uvs(p);
    const std::size_t n = mesh.positions.size();
    if (n == 0) p.fail("found no 'P', expected positions");
    if (!mesh.normals.empty() && mesh.normals.size() != n)
        p.fail(fmt::format("found {} normals for {} positions, expected as many", mesh.normals.size(), n));
    if (!mesh.uvs.empty() && mesh.uvs.size() != n)
        p.fail(fmt::format("found {} texture coordinates for {} positions, expected as many", mesh.uvs.size(), n));
    p.ignore({"S", "T", "faceIndices", "discarddegenerateUVs"});
    return mesh;
}

/// Vertex indices in groups of `corners`; 0, 1, 2 ... where there are just as many positions.
std::vector<std::uint32_t> read_indices(Parameters& p, std::size_t corners, std::size_t positions) {
    std::vector<std::uint32_t> indices;
    for (const double i : p.numbers("indices", {"integer"})) {
        if (!(i >= 0 && i < static_cast<double>(positions)))
            p.fail(fmt::format("found the vertex index {}, expected one from 0 to {}", i, positions - 1));
        indices.push_back(static_cast<std::uint32_t>(i));
    }
    if (indices.empty() && positions == corners)
        for (std::uint32_t i = 0; i < corners; ++i) indices.push_back(i);
    if (indices.empty() || indices.size() % corners != 0)
        p.fail(fmt::format("found {} 'indices', expected {} for each face", indices.size(), corners));
    return indices;
}

ShapeSource mended(Parameters& p, TriangleMesh mesh) {
    try {
        mend_mesh(mesh, p.directive().name);
    } catch (const InputError& e) {
        p.fail(e.what());
    }
    return {std::move(mesh), {}};
}

ShapeSource triangle_mesh(Parameters& p) {
    TriangleMesh mesh = read_vertices(p);
    const auto indices = read_indices(p, 3, mesh.positions.size());
    for (std::size_t i = 0; i < indices.size(); i += 3)
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return mended(p, std::move(mesh));
}

ShapeSource loop_subdiv(Parameters& p) {
    p.warn("loopsubdiv", "the control mesh stands for the subdivision surface");
    p.ignore({"levels", "scheme"});
    return triangle_mesh(p);
}

ShapeSource ply_mesh(Parameters& p) {
    const std::string file = p.string("filename", "");
    if (file.empty()) p.fail("found no 'filename', expected the path of a mesh");
    if (p.has("displacement"))
        p.warn("displaced mesh", "'displacement' of shapes is ignored: the mesh stays as it is in the file");
    p.ignore({"edgelength", "displacement.edgelength"});
    ShapeSource source;
    source.ply_path = p.context().resolve(file);
    return source;
}

/// The corners of a patch as pbrt lists them: (u,v) = (0,0), (1,0), (0,1), (1,1).
using Patch = std::array<std::uint32_t, 4>;

/// Two triangles are all there is to a parallelogram.
bool is_parallelogram(const TriangleMesh& mesh, const Patch& patch) {
    const auto& x = mesh.positions;
    const Vec3 u = x[patch[1]] - x[patch[0]], v = x[patch[2]] - x[patch[0]];
    const Vec3 bend = x[patch[3]] - x[patch[2]] - u;
    return bend.length2() <= 1e-10f * (u.length2() + v.length2());
}

template <class T> T bilinear(const std::vector<T>& values, const Patch& patch, float u, float v) {
    return values[patch[0]] * ((1 - u) * (1 - v)) + values[patch[1]] * (u * (1 - v)) +
           values[patch[2]] * ((1 - u) * v) + values[patch[3]] * (u * v);
}

void append_patch(TriangleMesh& mesh, const TriangleMesh& corners, const Patch& patch, std::uint32_t steps) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t j = 0; j <= steps; ++j) {
        for (std::uint32_t i = 0; i <= steps; ++i) {
            const float u = static_cast<float>(i) / static_cast<float>(steps);
            const float v = static_cast<float>(j) / static_cast<float>(steps);
            mesh.positions.push_back(bilinear(corners.positions, patch, u, v));
            mesh.uvs.push_back(corners.uvs.empty() ? Vec2(u, v) : bilinear(corners.uvs, patch, u, v));
            if (!corners.normals.empty()) mesh.normals.push_back(bilinear(corners.normals, patch, u, v).normalized());
        }
    }
    append_grid(mesh, first, steps, steps);
}

ShapeSource bilinear_mesh(Parameters& p) {
    constexpr std::uint32_t kSteps = 16; // facets along the edge of a patch that is curved
    const TriangleMesh corners = read_vertices(p);
    const auto indices = read_indices(p, 4, corners.positions.size());
    if (p.has("emissionfilename")) p.fail("found 'emissionfilename', expected emission that is the same everywhere");
    std::vector<Patch> patches;
    bool flat = true;
    for (std::size_t i = 0; i < indices.size(); i += 4) {
        patches.push_back({indices[i], indices[i + 1], indices[i + 2], indices[i + 3]});
        flat = flat && is_parallelogram(corners, patches.back());
    }
    TriangleMesh mesh;
    for (const Patch& patch : patches) append_patch(mesh, corners, patch, flat ? 1 : kSteps);
    ShapeSource source = mended(p, std::move(mesh));
    source.faces_per_patch = flat ? 2 : std::size_t{2} * kSteps * kSteps;
    return source;
}

ShapeSource curve(Parameters& p) {
    ShapeSource source;
    source.curves = read_curve(p);
    source.faces_per_patch = kMaxMeshTriangles; // a curve is one light
    return source;
}

using ShapeReader = ShapeSource (*)(Parameters&);
template <Geometry (*kRead)(Parameters&)> ShapeSource quadric(Parameters& p) {
    ShapeSource source{kRead(p), {}};
    source.faces_per_patch = kMaxMeshTriangles; // facets of one light
    return source;
}

const std::map<std::string_view, ShapeReader>& shape_readers() {
    static const std::map<std::string_view, ShapeReader> table{
        {"trianglemesh", triangle_mesh},      {"plymesh", ply_mesh},
        {"bilinearmesh", bilinear_mesh},      {"loopsubdiv", loop_subdiv},
        {"sphere", quadric<read_sphere>},     {"disk", quadric<read_disk>},
        {"cylinder", quadric<read_cylinder>}, {"curve", curve}};
    return table;
}

} // namespace

ShapeSource read_shape(Parameters& p) {
    const std::string& kind = p.directive().words[0];
    const auto reader = shape_readers().find(kind);
    if (reader == shape_readers().end())
        p.fail(fmt::format("found the shape '{}', {}", kind, expected_one_of(kind, keys_of(shape_readers()))));
    return reader->second(p);
}

void turn_triangles_to_normals(TriangleMesh& mesh) {
    if (mesh.normals.empty()) return;
    for (auto& t : mesh.triangles) {
        const auto& x = mesh.positions;
        const Vec3 n = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
        if (n.dot(mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]]) < 0) std::swap(t[1], t[2]);
    }
}

void assume_uvs(TriangleMesh& mesh) {
    TriangleMesh apart;
    for (const auto& t : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(apart.positions.size());
        for (const auto i : t) {
            apart.positions.push_back(mesh.positions[i]);
            if (!mesh.normals.empty()) apart.normals.push_back(mesh.normals[i]);
        }
        apart.uvs.insert(apart.uvs.end(), {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)});
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    mesh = std::move(apart);
}

} // namespace keyhole::pbrt
