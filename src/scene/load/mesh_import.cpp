#include "scene/load/mesh_import.h"

#include "core/error.h"
#include "scene/load/geometry_transform.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace keyhole {
namespace {

constexpr float kMaxCoordinate = 1e12f; // as for coordinates in scene files

[[noreturn]] void fail(const std::string& path, const std::string& message) { throw InputError({path, 0, 0}, message); }

/// assimp reads on for ever where the header has no end, and believes every count in it.
void check_ply_header(const std::string& path) {
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    std::string line;
    for (int i = 0; i < 1000 && std::getline(stream, line); ++i) {
        std::istringstream words(line);
        std::string first, name;
        std::uintmax_t count = 0;
        words >> first;
        if (first == "end_header") return;
        if (first == "element" && (!(words >> name >> count) || count > bytes))
            fail(path, fmt::format("found '{}' in a file of {} bytes, expected a name and a count", line.substr(0, 60),
                                   bytes));
    }
    fail(path, "found a broken mesh (its header doesn't end), expected a valid one");
}

void check_file(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) fail(path, "found no such file, expected a mesh");
    if (!std::filesystem::is_regular_file(status)) fail(path, "found something that is not a file, expected a mesh");
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    // Other formats that assimp knows stay shut: we don't test them.
    if (extension != ".obj" && extension != ".ply" && extension != ".gltf" && extension != ".glb")
        fail(path, fmt::format("found the extension '{}', expected .obj, .ply, .gltf or .glb", extension));
    if (!std::ifstream(path)) fail(path, "found a file that can't be opened, expected a readable mesh");
    if (extension == ".ply") check_ply_header(path);
}

/// assimp's triangulation aborts where a face has no corners. (Indices out of range don't pass its validation.)
void check_faces(const aiScene& scene, const std::string& path) {
    for (unsigned i = 0; i < scene.mNumMeshes; ++i)
        for (unsigned j = 0; j < scene.mMeshes[i]->mNumFaces; ++j)
            if (scene.mMeshes[i]->mFaces[j].mNumIndices == 0)
                fail(path, "found a face without corners, expected three at least");
}

Transform to_transform(const aiMatrix4x4& m) {
    return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

bool is_unit_like(const Vec3& n) {
    const float l = n.length2();
    return l > 0.25f && l < 4; // false for NaN
}

/// One part of the file, before its placement.
TriangleMesh convert(const aiMesh& source) {
    TriangleMesh mesh;
    mesh.positions.reserve(source.mNumVertices);
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        const aiVector3D& p = source.mVertices[i];
        mesh.positions.emplace_back(p.x, p.y, p.z);
        if (source.HasNormals())
            mesh.normals.emplace_back(source.mNormals[i].x, source.mNormals[i].y, source.mNormals[i].z);
        if (source.HasTextureCoords(0))
            mesh.uvs.emplace_back(source.mTextureCoords[0][i].x, source.mTextureCoords[0][i].y);
    }
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
        const aiFace& face = source.mFaces[i];
        if (face.mNumIndices != 3) continue; // points and lines
        const std::array<std::uint32_t, 3> t{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
        mesh.triangles.push_back(t);
    }
    for (Vec2& uv : mesh.uvs)
        if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = {0, 0};
    return mesh;
}

Vec3 area_vector(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
    const auto& p = mesh.positions;
    const Imath::V3d a(p[t[0]]);
    return Vec3((Imath::V3d(p[t[1]]) - a).cross(Imath::V3d(p[t[2]]) - a).normalized());
}

/// Files hold zero and NaN normals more often than one thinks.
void mend_normals(TriangleMesh& mesh) {
    if (mesh.normals.empty()) return;
    for (const auto& t : mesh.triangles)
        for (const auto i : t)
            if (!is_unit_like(mesh.normals[i])) mesh.normals[i] = area_vector(mesh, t);
    for (Vec3& n : mesh.normals) n = is_unit_like(n) ? n.normalized() : Vec3(0, 0, 1); // the latter: of no triangle
}

void append(TriangleMesh& all, TriangleMesh part) {
    if (!all.positions.empty() && all.normals.empty() != part.normals.empty())
        smooth_normals(all.normals.empty() ? all : part);
    const auto first = static_cast<std::uint32_t>(all.positions.size());
    for (auto& t : part.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
    all.normals.insert(all.normals.end(), part.normals.begin(), part.normals.end());
    all.uvs.resize(part.uvs.empty() && all.uvs.empty() ? 0 : first, Vec2(0, 0));
    all.uvs.insert(all.uvs.end(), part.uvs.begin(), part.uvs.end());
    if (!all.uvs.empty()) all.uvs.resize(all.positions.size(), Vec2(0, 0));
}

/// Walks the file's tree of placements.
class Collector {
  public:
    Collector(const aiScene& scene, const std::string& path) : scene_(scene), path_(path) {}

    TriangleMesh collect() {
        visit(*scene_.mRootNode, Transform(), 0);
        return std::move(all_);
    }

  private:
    void visit(const aiNode& node, const Transform& parent, int depth) {
        if (depth > 256) fail(path_, "found parts nested more than 256 deep, expected fewer levels");
        const Transform to_world = to_transform(node.mTransformation) * parent;
        for (unsigned i = 0; i < node.mNumMeshes; ++i) place(*scene_.mMeshes[node.mMeshes[i]], to_world);
        for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], to_world, depth + 1);
    }

    void place(const aiMesh& source, const Transform& to_world) {
        if (all_.triangles.size() + source.mNumFaces > kMaxMeshTriangles ||
            all_.positions.size() + source.mNumVertices > 3 * kMaxMeshTriangles)
            fail(path_, fmt::format("found more than {} triangles, expected fewer", kMaxMeshTriangles));
        TriangleMesh part = convert(source);
        if (!(regularity(to_world) > 1e-12))
            fail(path_, "found a singular placement of a part, expected a regular one");
        transform_mesh(part, to_world);
        for (const Vec3& p : part.positions)
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(p[axis]) <= kMaxCoordinate))
                    fail(path_, fmt::format("found the coordinate {}, expected one within 1e12", p[axis]));
        std::erase_if(part.triangles, [&](const auto& t) { return area_vector(part, t).length2() == 0; });
        if (part.triangles.empty()) return;
        mend_normals(part);
        append(all_, std::move(part));
    }

    const aiScene& scene_;
    const std::string& path_;
    TriangleMesh all_;
};

} // namespace

TriangleMesh import_mesh(const std::string& path) {
    check_file(path);
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const auto checked = [&](const aiScene* scene) {
        if (scene == nullptr)
            fail(path, fmt::format("found a broken mesh ({}), expected a valid one", importer.GetErrorString()));
        return scene;
    };
    check_faces(*checked(importer.ReadFile(path, aiProcess_ValidateDataStructure)), path);
    const aiScene* scene = checked(
        importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType));
    TriangleMesh mesh;
    if (scene->mRootNode != nullptr) mesh = Collector(*scene, path).collect();
    if (mesh.triangles.empty()) fail(path, "found no triangles, expected at least one");
    return mesh;
}

void smooth_normals(TriangleMesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), Vec3(0.0f));
    for (const auto& t : mesh.triangles) {
        const Vec3 n = area_vector(mesh, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& p = mesh.positions[t[k]];
            const Vec3 a = (mesh.positions[t[(k + 1) % 3]] - p).normalized();
            const Vec3 b = (mesh.positions[t[(k + 2) % 3]] - p).normalized();
            mesh.normals[t[k]] += n * std::acos(std::clamp(a.dot(b), -1.0f, 1.0f));
        }
    }
    for (Vec3& n : mesh.normals) n.normalize();
    mend_normals(mesh); // where normals cancel
}

} // namespace keyhole
