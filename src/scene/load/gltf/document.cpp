#include "scene/load/gltf/document.h"

#include "core/base64.h"
#include "core/files_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace keyhole::gltf {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

/// Whoever copies or writes JSON goes down it.
constexpr int kMostNested = 512;

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

std::string bytes_of_word(std::size_t word) {
    const auto small = static_cast<std::uint32_t>(word);
    std::string bytes(sizeof small, '\0');
    std::memcpy(bytes.data(), &small, sizeof small);
    return bytes;
}

/// A chunk of a .glb, whose size is a multiple of four.
std::string chunk(std::uint32_t kind, std::string bytes, char padding) {
    bytes.resize((bytes.size() + 3) / 4 * 4, padding);
    return bytes_of_word(bytes.size()) + bytes_of_word(kind) + bytes;
}

std::string read_bytes(const std::string& path, const char* what) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError({path, 0, 0}, fmt::format("found {}, expected {}", found_in_place_of_file(path), what));
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) throw InputError({path, 0, 0}, "found a file that can't be read, expected a readable one");
    return text.str();
}

/// An URI's %20 and the like.
std::string unescaped(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escaped = uri[i] == '%' && i + 2 < uri.size() &&
                             std::isxdigit(static_cast<unsigned char>(uri[i + 1])) != 0 &&
                             std::isxdigit(static_cast<unsigned char>(uri[i + 2])) != 0;
        text += escaped ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
        if (escaped) i += 2;
    }
    return text;
}

bool is_data(const std::string& uri) { return uri.starts_with("data:"); }

/// The ending that tells readers what a picture is; empty for what they don't read.
std::string ending_of(const std::string& bytes) {
    if (bytes.starts_with("RIFF") && bytes.find("WEBP") == 8) return ".webp";
    if (bytes.starts_with("\xFF\xD8")) return ".jpg";
    return bytes.starts_with("\x89PNG") ? ".png" : "";
}

/// What nlohmann says, without its "[json.exception.out_of_range.403] ".
std::string without_id(std::string said) {
    if (const auto end = said.find("] "); said.starts_with('[') && end != std::string::npos) said.erase(0, end + 2);
    return said;
}

std::string replaced(std::string text, const std::string& old, const std::string& with) {
    for (auto at = text.find(old); at != std::string::npos; at = text.find(old, at + with.size()))
        text.replace(at, old.size(), with);
    return text;
}

} // namespace

Document::Document(const std::string& path, Warnings& warnings) : path_(path), warnings_(warnings) {
    std::string text = read_bytes(path, "a scene file");
    if (text.starts_with("glTF")) {
        packed_ = true;
        constexpr std::size_t kStart = 20; // of its JSON
        if (text.size() < kStart)
            fail(fmt::format("found a broken GLB file of {} bytes, expected more than {}", text.size(), kStart));
        if (const std::uint32_t version = word_at(text, 4); version != kVersion)
            fail(fmt::format("found version {} of GLB, expected {}", version, kVersion));
        const std::size_t json = word_at(text, 12);
        if (word_at(text, 16) != kJsonChunk) fail("found a broken GLB file, expected JSON as its first part");
        if (json > text.size() - kStart)
            fail(fmt::format("found a broken GLB file of {} bytes, expected {} at least for its JSON", text.size(),
                             kStart + json));
        const std::size_t second = kStart + json;
        if (second + 8 <= text.size() && word_at(text, second + 4) == kBinaryChunk)
            binary_ = text.substr(second + 8, word_at(text, second));
        text = text.substr(kStart, json);
    }
    try {
        root_ = Json::parse(text, [this](int depth, Json::parse_event_t, const Json&) {
            if (depth > kMostNested) fail(fmt::format("found values nested more than {} deep", kMostNested));
            return true;
        });
    } catch (const Json::exception& e) {
        fail(fmt::format("found broken JSON ({}), expected a glTF file", without_id(e.what())));
    }
    const std::string version = root_.is_object() ? member(root_, "asset").value("version", "") : "";
    if (!version.starts_with("2.")) fail(fmt::format("found the glTF version '{}', expected 2.0", version));
}

Document::~Document() {
    std::error_code ignored;
    if (!scratch_.empty()) std::filesystem::remove_all(scratch_, ignored);
}

std::string Document::with_root(const Json& root) const {
    std::string json = root.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (!packed_) return json;
    std::string chunks = chunk(kJsonChunk, json, ' ');
    if (!binary_.empty()) chunks += chunk(kBinaryChunk, binary_, '\0');
    return bytes_of_word(kMagic) + bytes_of_word(kVersion) + bytes_of_word(12 + chunks.size()) + chunks;
}

const Json& Document::entry(const char* list, std::size_t index) const {
    const auto found = root_.find(list);
    if (found == root_.end() || !found->is_array() || index >= found->size())
        fail(fmt::format("found no entry {} of '{}', which is referred to", index, list));
    return (*found)[index];
}

double Document::emission_unit() const {
    const Json* lamps = extension(root_, "KHR_lights_punctual");
    const bool any = lamps != nullptr && !member(*lamps, "lights").empty();
    const bool blender = member(root_, "asset").value("generator", "").find("Blender") != std::string::npos;
    return any && !blender ? 1 / kLumensPerWatt : 1;
}

double Document::checked_share(double x, const char* key) const {
    const double share = std::clamp(x, 0.0, 1.0);
    if (share != x) warn(fmt::format("found {} as '{}', expected 0 to 1: it counts as {}", x, key, share));
    return share;
}

Rgb Document::checked_light(const Rgb& light) const {
    for (const double x : {light.x, light.y, light.z})
        if (!(x >= 0 && x <= 1e30))
            fail(fmt::format("found {} as an amount of light, expected at least 0 and at most 1e+30", x));
    return light;
}

std::string Document::uri_path(const std::string& uri) const {
    return (std::filesystem::path(path_).parent_path() / unescaped(uri)).string();
}

std::string Document::uri_bytes(const std::string& uri) const {
    if (!is_data(uri)) {
        try {
            return read_bytes(uri_path(uri), "one that glTF names");
        } catch (const InputError& e) {
            fail(e.what()); // whose file that is
        }
    }
    const auto comma = uri.find(',');
    if (comma == std::string::npos) fail("found a data URI without data");
    return from_base64(std::string_view(uri).substr(comma + 1));
}

std::string Document::buffer_bytes(std::size_t index) const {
    const Json& buffer = entry("buffers", index);
    return buffer.contains("uri") ? uri_bytes(buffer["uri"].get<std::string>()) : binary_;
}

std::string Document::bytes_of_view(std::size_t index) const {
    return std::string(view_within(buffer_bytes(buffer_of_view(index)), index));
}

std::string_view Document::view_within(std::string_view buffer, std::size_t index) const {
    const Json& view = entry("bufferViews", index);
    const auto offset = value_or<std::size_t>(view, "byteOffset", 0), length = view.at("byteLength").get<std::size_t>();
    if (offset > buffer.size() || length > buffer.size() - offset)
        fail(fmt::format("found buffer view {} beyond its buffer of {} bytes", index, buffer.size()));
    return buffer.substr(offset, length);
}

std::string Document::image_file(std::size_t index) {
    if (const auto known = written_.find(index); known != written_.end()) return known->second;
    const Json& image = entry("images", index);
    const auto uri = value_or<std::string>(image, "uri", "");
    if (!uri.empty() && !is_data(uri)) return uri_path(uri);
    const std::string bytes = uri.empty() ? bytes_of_view(image.at("bufferView")) : uri_bytes(uri);
    const std::string ending = ending_of(bytes);
    if (ending.empty())
        fail_of_image(index, {},
                      fmt::format("found {} bytes of no known picture, expected PNG, JPEG or WebP", bytes.size()));
    if (scratch_.empty()) {
        std::string name = (std::filesystem::temp_directory_path() / "keyhole-gltf-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) fail("found no room for the images in the file");
        scratch_ = name;
    }
    const std::string file = (scratch_ / ("image-" + std::to_string(index) + ending)).string();
    if (!std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size())))
        fail("found no room for the images in the file");
    name_image(file, fmt::format("{}, image {}", path_, index));
    return written_[index] = file;
}

void Document::fail_of_image(std::size_t index, const std::string& file, std::string why) const {
    const Json& image = entry("images", index);
    const auto name = image.find("name");
    const bool named = name != image.end() && name->is_string();
    if (written_.contains(index)) { // somewhere, for this process
        if (why.starts_with(file + ": ")) why = why.substr(file.size() + 2);
        why = replaced(why, file, "it");
    }
    const std::string image_name = named ? fmt::format(" '{}'", name->get<std::string>()) : "";
    throw InputError({path_, 0, 0}, fmt::format("image {}{}: {}", index, image_name, why));
}

const Json& member(const Json& object, const char* key) {
    static const Json empty = Json::object();
    const auto found = object.find(key);
    return found == object.end() ? empty : *found;
}

const Json* extension(const Json& object, const char* name) {
    const Json& all = member(object, "extensions");
    const auto found = all.find(name);
    return found == all.end() ? nullptr : &*found;
}

Rgb color_or(const Json& object, const char* key, const Rgb& otherwise, std::size_t count) {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    check_numbers(*found, key, count);
    return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
}

std::string words_of(const std::exception& error) {
    const auto* json = dynamic_cast<const Json::exception*>(&error);
    if (json == nullptr) return error.what();
    const std::string said = without_id(error.what());
    constexpr int kMissingKey = 403; // key 'count' not found
    const auto first = said.find('\''), last = said.rfind('\'');
    if (json->id == kMissingKey && first < last)
        return fmt::format("found no {}, expected one", said.substr(first, last + 1 - first));
    return fmt::format("found what glTF doesn't have at that place: {}", said);
}

std::string called(const char* what, std::size_t index, const Json& object) {
    const auto name = object.is_object() ? object.find("name") : object.end();
    const bool named = name != object.end() && name->is_string() && !name->get_ref<const std::string&>().empty();
    return fmt::format("the {} {}{}", what, index,
                       named ? fmt::format(" '{}'", name->get_ref<const std::string&>()) : "");
}

void fail_of_value(const Json& found, const char* key, const std::string& expected) {
    const std::string type = found.type_name();
    const bool vowel = type == "array" || type == "object";
    throw BadValue(fmt::format("found {}{} in '{}', expected {}",
                               found.is_null() ? ""
                               : vowel         ? "an "
                                               : "a ",
                               type, key, expected));
}

void check_numbers(const Json& list, const char* key, std::size_t count) {
    if (!list.is_array()) fail_of_value(list, key, fmt::format("{} numbers", count));
    for (const Json& x : list)
        if (!x.is_number()) fail_of_value(x, key, "numbers alone");
    if (list.size() != count)
        throw BadValue(fmt::format("found {} numbers in '{}', expected {}", list.size(), key, count));
}

} // namespace keyhole::gltf
