// The JSON of a glTF file and the bytes that belong to it.
#pragma once

#include "scene/load/input.h"
#include "scene/texture.h"

#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace keyhole::gltf {

using Json = nlohmann::json;

/// Lights are in photometric units; 1 W at the best wavelength is 683 lm, and exporters take that for white.
constexpr double kLumensPerWatt = 683;

/// What a value is that the format doesn't have, and what was expected. Who knows the place makes an InputError of it.
class BadValue : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// In words what nlohmann says, or a BadValue.
std::string words_of(const std::exception& error);

/// "the material 3 'Oak'", without a name if the object has none.
std::string called(const char* what, std::size_t index, const Json& object);

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
    /// Whether a buffer is the second part of the file, which is `binary()`.
    bool is_binary(std::size_t buffer) const { return !entry("buffers", buffer).contains("uri"); }
    std::string_view binary() const { return binary_; }
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

    /// What `read` makes of a part of the file. Errors name that.
    template <class Read> auto within(const std::string& place, Read&& read) const;

    [[noreturn]] void fail(const std::string& message) const {
        throw InputError({path_, 0, 0}, place_.empty() ? message : place_ + ": " + message);
    }
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
    std::string binary_;        ///< its second part
    mutable std::string place_; ///< what is read; empty: nothing in particular
    std::filesystem::path scratch_;
    std::map<std::size_t, std::string> written_; ///< images
};

template <class Read> auto Document::within(const std::string& place, Read&& read) const {
    /// Puts back what was read before.
    struct Return {
        std::string& place;
        std::string before;
        ~Return() { place = std::move(before); }
    } const leaving{place_, std::exchange(place_, place)};
    try {
        return read();
    } catch (const Json::exception& e) {
        fail(words_of(e));
    } catch (const BadValue& e) {
        fail(words_of(e));
    }
}

/// What a value of the type is in words, such as "a number".
template <class T> constexpr const char* words_for() {
    if constexpr (std::is_same_v<T, bool>) return "true or false";
    if constexpr (std::is_arithmetic_v<T>) return "a number";
    if constexpr (std::is_same_v<T, std::string>) return "a string";
    return "a list";
}

[[noreturn]] void fail_of_value(const Json& found, const char* key, const std::string& expected);
/// @throws BadValue for what isn't a list of as many numbers.
void check_numbers(const Json& list, const char* key, std::size_t count);

/// @throws BadValue for one of another type, or of another length.
template <class T> T value_of(const Json& value, const char* key) {
    try {
        return value.get<T>();
    } catch (const Json::exception&) {
        fail_of_value(value, key, words_for<T>());
    }
}

/// The value of a key that may be missing. @throws BadValue as value_of().
template <class T> T value_or(const Json& object, const char* key, const T& otherwise) {
    const auto found = object.find(key);
    return found == object.end() ? otherwise : value_of<T>(*found, key);
}
template <std::size_t N>
std::array<double, N> value_or(const Json& object, const char* key, const std::array<double, N>& otherwise) {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    check_numbers(*found, key, N);
    return found->get<std::array<double, N>>();
}

/// The object under a key; an empty one where there is none.
const Json& member(const Json& object, const char* key);

/// Whether an object has an extension, and what that says.
const Json* extension(const Json& object, const char* name);

/// A colour, or what stands for it if it is not given. @param count of its numbers: 4 have an opacity behind them
/// @throws BadValue for others.
Rgb color_or(const Json& object, const char* key, const Rgb& otherwise, std::size_t count = 3);

} // namespace keyhole::gltf
