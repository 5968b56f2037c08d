#include "scene/load/load_mesh.h"

#include "core/error.h"
#include "core/files_read.h"
#include "scene/geometry.h"
#include "scene/load/load.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace keyhole {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& message) { throw InputError({path, 0, 0}, message); }

/// In lower case; with what stands before ".gz".
std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    return extension == ".gz" && path.stem() != path ? extension_of(path.stem()) + extension : extension;
}

/// @returns the extension.
std::string check_file(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        fail(path, fmt::format("found {}, expected a mesh", found_in_place_of_file(path)));
    const std::string extension = extension_of(path);
    // Other formats that assimp knows stay shut: we don't test them.
    constexpr std::array kKnown{".obj", ".ply", ".ply.gz", ".gltf", ".glb"};
    if (std::ranges::find(kKnown, extension) == kKnown.end())
        fail(path, fmt::format("found the extension '{}', expected .obj, .ply, .ply.gz, .gltf or .glb", extension));
    if (!std::ifstream(path)) fail(path, "found a file that can't be opened, expected a readable mesh");
    note_file_read(path);
    return extension;
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
    return mesh;
}

std::vector<Imath::V4f> colors_of(const aiMesh& source) {
    std::vector<Imath::V4f> colors;
    for (unsigned i = 0; source.HasVertexColors(0) && i < source.mNumVertices; ++i) {
        const aiColor4D& c = source.mColors[0][i];
        colors.emplace_back(c.r, c.g, c.b, c.a);
    }
    return colors;
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
    /// @param instances whether parts may be instances.
    Collector(const aiScene& scene, const std::string& path, bool instances)
        : scene_(scene), path_(path), copies_(scene.mNumMeshes, 0), shared_(scene.mNumMeshes) {
        if (instances) count(*scene.mRootNode, 0);
    }

    std::vector<MeshPart> collect() {
        visit(*scene_.mRootNode, Transform(), 0);
        if (!any_) fail(path_, "found no triangles, expected at least one");
        return std::move(parts_);
    }

  private:
    void count(const aiNode& node, int depth) {
        if (depth > kMostDepth) fail(path_, "found parts nested more than 256 deep, expected fewer levels");
        for (unsigned i = 0; i < node.mNumMeshes; ++i) ++copies_[node.mMeshes[i]];
        for (unsigned i = 0; i < node.mNumChildren; ++i) count(*node.mChildren[i], depth + 1);
    }

    void visit(const aiNode& node, const Transform& parent, int depth) {
        if (depth > kMostDepth) fail(path_, "found parts nested more than 256 deep, expected fewer levels");
        const Transform to_world = to_transform(node.mTransformation) * parent;
        std::shared_ptr<const ObjectToWorld> copy;                          // of what hangs on the node
        const unsigned meshes = is_regular(to_world) ? node.mNumMeshes : 0; // none of what is hidden by a scale of 0
        for (unsigned i = 0; i < meshes; ++i) {
            const unsigned number = node.mMeshes[i];
            const aiMesh& source = *scene_.mMeshes[number];
            // Colours of vertices are known by where the mesh stands.
            if (source.HasVertexColors(0) || !is_worth_sharing(source.mNumFaces, copies_[number])) {
                place(source, to_world, node.mName.C_Str());
                continue;
            }
            if (copy == nullptr) copy = std::make_shared<const ObjectToWorld>(to_world);
            place_copy(number, copy, node.mName.C_Str());
        }
        for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], to_world, depth + 1);
    }

    void hold(std::size_t triangles, std::size_t positions) {
        triangles_ += triangles;
        positions_ += positions;
        if (triangles_ > kMaxMeshTriangles || positions_ > 3 * kMaxMeshTriangles)
            fail(path_, fmt::format("found more than {} triangles, expected fewer", kMaxMeshTriangles));
    }

    void place(const aiMesh& source, const Transform& to_world, const char* name) {
        hold(source.mNumFaces, source.mNumVertices);
        TriangleMesh part = convert(source);
        any_ = any_ || !part.triangles.empty();
        transform_mesh(part, to_world);
        mend(part, name);
        if (!part.triangles.empty()) add(source, std::move(part), name);
    }

    void place_copy(unsigned number, const std::shared_ptr<const ObjectToWorld>& copy, const char* name) {
        const aiMesh& source = *scene_.mMeshes[number];
        std::optional<SharedMesh>& shared = shared_[number];
        if (!shared) {
            hold(source.mNumFaces, source.mNumVertices);
            TriangleMesh mesh = convert(source);
            any_ = any_ || !mesh.triangles.empty();
            mend(mesh, name);
            shared.emplace(std::move(mesh));
        }
        if (shared->mesh().triangles.empty()) return;
        Geometry geometry = shared->placed(copy);
        if (auto* moved = std::get_if<TriangleMesh>(&geometry)) {
            hold(moved->triangles.size(), moved->positions.size());
            mend(*moved, name);
            if (moved->triangles.empty()) return;
        }
        add(source, std::move(geometry), name);
    }

    /// What can't be mended is found in one of perhaps a thousand parts: which one is said.
    void mend(TriangleMesh& mesh, const std::string& name) const {
        mend_mesh(mesh, name.empty() ? path_ : fmt::format("{}: the mesh '{}'", path_, name));
    }

    void add(const aiMesh& source, Geometry geometry, const char* name) {
        const aiString material = scene_.mMaterials[source.mMaterialIndex]->GetName();
        parts_.push_back({std::move(geometry), colors_of(source), material.C_Str(), name});
    }

    static constexpr int kMostDepth = 256;

    const aiScene& scene_;
    const std::string& path_;
    std::vector<MeshPart> parts_;
    std::vector<std::size_t> copies_; ///< by mesh: nodes that have it
    std::vector<std::optional<SharedMesh>> shared_;
    std::size_t triangles_ = 0, positions_ = 0;
    bool any_ = false; ///< triangles, with an area or without
};

/// Assimp tries all of its readers on what the right one refuses, and some of them take minutes over junk.
void keep_readers_of(const std::string& extension, Assimp::Importer& importer) {
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        Assimp::BaseImporter* reader = importer.GetImporter(i);
        std::set<std::string> extensions;
        reader->GetExtensionList(extensions);
        if (extensions.contains(extension.substr(1))) continue;
        importer.UnregisterLoader(reader);
        delete reader; // who takes a reader away owns it
    }
}

/// One file whose content is here, and those that it refers to, which are read.
class WithContent : public Assimp::DefaultIOSystem {
  public:
    WithContent(std::string path, const std::string& content) : path_(std::move(path)), content_(content) {}
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        note_file_read(file);
        if (file != path_) return DefaultIOSystem::Open(file, mode);
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(content_.data()), content_.size());
    }

  private:
    std::string path_;
    const std::string& content_;
};

/// An OBJ file with a zero before each coordinate that begins with its point: Assimp's reader doesn't see those, and
/// drops the vertex.
std::string with_leading_zeros(const std::string& text) {
    std::string s;
    s.reserve(text.size());
    bool coordinates = false; // in a line of them
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char before = i > 0 ? text[i - 1] : '\n';
        if (before == '\n') coordinates = text[i] == 'v';
        if (coordinates && text[i] == '.' && (before == ' ' || before == '\t')) s += '0';
        s += text[i];
    }
    return s;
}

/// @param instances whether parts may be instances.
std::vector<MeshPart> read_parts(const std::string& path, const std::string& extension, const std::string* content,
                                 bool instances) {
    std::string text;
    if (extension == ".obj" && content == nullptr) {
        std::ifstream file(path, std::ios::binary);
        text = with_leading_zeros({std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
        content = &text;
    }
    Assimp::Importer importer;
    if (content != nullptr) importer.SetIOHandler(new WithContent(path, *content)); // which the importer will own
    keep_readers_of(extension, importer);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const auto checked = [&](const aiScene* scene) {
        if (scene == nullptr)
            fail(path, fmt::format("found a broken mesh ({}), expected a valid one", importer.GetErrorString()));
        return scene;
    };
    check_faces(*checked(importer.ReadFile(path, aiProcess_ValidateDataStructure)), path);
    const aiScene* scene = checked(
        importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType));
    if (scene->mRootNode == nullptr) fail(path, "found no triangles, expected at least one");
    return Collector(*scene, path, instances).collect();
}

} // namespace

std::vector<MeshPart> import_parts(const std::string& path, const std::string* content) {
    return read_parts(path, check_file(path), content, true);
}

TriangleMesh import_mesh(const std::string& path) {
    const std::string extension = check_file(path);
    if (extension == ".ply" || extension == ".ply.gz") return read_ply(path);
    const bool gltf = extension == ".gltf" || extension == ".glb";
    const std::string content = gltf ? importable_gltf(path) : "";
    TriangleMesh all;
    for (MeshPart& part : read_parts(path, extension, gltf ? &content : nullptr, false))
        append(all, std::move(std::get<TriangleMesh>(part.geometry)));
    return all;
}

} // namespace keyhole
