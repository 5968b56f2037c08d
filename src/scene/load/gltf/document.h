// The JSON of a glTF file and the bytes that belong to it.
#pragma once

#include "scene/load/input.h"
#include "scene/texture.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace keyhole::gltf {

using Json = nlohmann::json;

/// Lights are in photometric units; 1 W at the best wavelength is 683 lm, and exporters take that for white.
constexpr double kLumensPerWatt = 683;

class Document {
  public:
    /// Reads a .gltf file, or both parts of a .glb one. @throws InputError
    Document(const std::string& path, Warnings& warnings);
    ~Document();
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    const Json& root() const { return root_; }
    /// Entry `index` of one of the lists at the top. @throws InputError where there is none.
    const Json& entry(const char* list, std::size_t index) const;

    /// Whether it is a .glb.
    bool packed() const { return packed_; }
    /// The bytes of the file if its JSON were this.
    std::string with_root(const Json& root) const;

    std::size_t buffer_of_view(std::size_t view) const { return entry("bufferViews", view).at("buffer"); }
    std::string buffer_bytes(std::size_t index) const;
    /// The bytes of a view of a buffer. @throws InputError where that ends too early.
    std::string_view view_within(std::string_view buffer, std::size_t index) const;

    /// The path of a file with an image: its own, or one that lasts as long as this object.
    std::string image_file(std::size_t index);
    /// Fails for an image, of that file, that can't be read: `why` may name files that users don't know.
    [[noreturn]] void fail_of_image(std::size_t index, const std::string& file, std::string why) const;

    /// What one unit of emission is in W/(m^2 sr). By the specification it is 1 cd/m^2, as lamps are in candelas; but
    /// Blender writes watts, though lamps in lumens. Without lamps nothing depends on it, and it is 1.
    double emission_unit() const;
    /// A factor that the format has from 0 to 1: within these, with a warning where it isn't.
    double checked_share(double x, const char* key) const;
    /// An amount of light. @throws InputError where it can't be one.
    Rgb checked_light(const Rgb& light) const;

    [[noreturn]] void fail(const std::string& message) const { throw InputError({path_, 0, 0}, message); }
    /// Once for each message.
    void warn(const std::string& message) const { warnings_.add({path_, 0, 0}, message, message); }

  private:
    std::string bytes_of_view(std::size_t index) const;
    std::string uri_bytes(const std::string& uri) const;
    std::string uri_path(const std::string& uri) const;

    std::string path_;
    Warnings& warnings_;
    Json root_;
    bool packed_ = false;
    std::string binary_; ///< its second part
    std::filesystem::path scratch_;
    std::map<std::size_t, std::string> written_; ///< images
};

/// The value of a key that may be missing. nlohmann's own reports a value of another type.
template <class T> T value_or(const Json& object, const char* key, const T& otherwise) {
    const auto found = object.find(key);
    return found == object.end() ? otherwise : found->get<T>();
}

/// The object under a key; an empty one where there is none.
const Json& member(const Json& object, const char* key);

/// Whether an object has an extension, and what that says.
const Json* extension(const Json& object, const char* name);

/// A colour, or what stands for it if it is not given.
Rgb color_or(const Json& object, const char* key, const Rgb& otherwise);

} // namespace keyhole::gltf
