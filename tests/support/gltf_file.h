// glTF files for tests, put together from lists of numbers.
#pragma once

#include "core/error.h"
#include "scene/load/load.h"
#include "scene/scene.h"
#include "support/scratch_directory.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

namespace keyhole::test {

/// A scene with one node and one mesh of one triangle, with attributes to be added. Its buffer is a file beside it, or
/// the second part of a .glb.
class GltfFile {
  public:
    nlohmann::json root = {{"asset", {{"version", "2.0"}}},
                           {"scene", 0},
                           {"scenes", {{{"nodes", {0}}}}},
                           {"nodes", {{{"mesh", 0}}}},
                           {"materials", {nlohmann::json::object()}}};

    GltfFile() {
        root["meshes"] = nlohmann::json::array(
            {{{"primitives", nlohmann::json::array({{{"attributes", nlohmann::json::object()}, {"material", 0}}})}}});
    }

    nlohmann::json& primitive() { return root["meshes"][0]["primitives"][0]; }

    /// A view of bytes that are added to the buffer.
    template <class T> std::size_t view(const std::vector<T>& numbers) {
        buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
        const std::size_t bytes = numbers.size() * sizeof(T);
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}});
        buffer_.append(reinterpret_cast<const char*>(numbers.data()), bytes);
        return root["bufferViews"].size() - 1;
    }

    /// @param stride of rows in bytes; 0: tight
    template <class T>
    std::size_t accessor(const std::vector<T>& numbers, std::size_t width, bool normalized = false,
                         std::size_t stride = 0) {
        static const char* const kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        const std::size_t row = stride > 0 ? stride / sizeof(T) : width;
        nlohmann::json entry = {{"bufferView", view(numbers)},
                                {"componentType", component<T>()},
                                {"count", (numbers.size() + row - width) / row},
                                {"type", kTypes[width]}};
        if (normalized) entry["normalized"] = true;
        if (stride > 0) root["bufferViews"].back()["byteStride"] = stride;
        root["accessors"].push_back(entry);
        return root["accessors"].size() - 1;
    }

    void attribute(const char* name, std::size_t accessor) { primitive()["attributes"][name] = accessor; }

    /// The right angle at the origin whose legs are 1 m long along x and y.
    void plain_triangle() { attribute("POSITION", accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)); }

    std::string write(bool packed = false) {
        nlohmann::json whole = root;
        if (!buffer_.empty() && !whole.contains("buffers"))
            whole["buffers"] = nlohmann::json::array({{{"byteLength", buffer_.size()}}});
        const std::string path = folder_.path(packed ? "scene.glb" : "scene.gltf");
        if (packed) {
            std::ofstream(path, std::ios::binary) << glb(whole.dump());
            return path;
        }
        if (whole.contains("buffers")) whole["buffers"][0]["uri"] = "numbers.bin";
        std::ofstream(folder_.path("numbers.bin"), std::ios::binary) << buffer_;
        std::ofstream(path) << whole.dump();
        return path;
    }

    LoadedScene read(bool packed = false) {
        warnings.clear();
        return load(write(packed), {}, &warnings);
    }

    std::string error() {
        try {
            read();
        } catch (const InputError& e) {
            return e.what();
        }
        return "no error";
    }

    const ScratchDirectory& folder() const { return folder_; }

    std::vector<std::string> warnings;

  private:
    template <class T> static int component() {
        if (std::is_same_v<T, float>) return 5126;
        const int size = sizeof(T) == 1 ? 5120 : sizeof(T) == 2 ? 5122 : 5124;
        return size + (std::is_unsigned_v<T> ? 1 : 0);
    }

    static std::string word(std::size_t n) {
        std::string w(4, '\0');
        for (std::size_t i = 0; i < 4; ++i) w[i] = static_cast<char>(n >> 8 * i);
        return w;
    }

    std::string glb(std::string json) const {
        json.append((4 - json.size() % 4) % 4, ' ');
        std::string bytes = buffer_;
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        return "glTF" + word(2) + word(28 + json.size() + bytes.size()) + word(json.size()) + "JSON" + json +
               word(bytes.size()) + std::string("BIN\0", 4) + bytes;
    }

    ScratchDirectory folder_;
    std::string buffer_;
};

/// The mesh of a shape.
inline const TriangleMesh& mesh_of(const LoadedScene& scene, std::size_t shape = 0) {
    return std::get<TriangleMesh>(scene.description.shapes.at(shape).geometry);
}

} // namespace keyhole::test
