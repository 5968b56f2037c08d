// Typed reading of YAML nodes. Every function throws InputError with the node's position and
// "found ..., expected ..." when the node is of the wrong type or out of range.
#pragma once

#include "core/vec.h"
#include "scene/load/properties.h"
#include "scene/load/yaml/tree.h"

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

[[noreturn]] void fail(const YamlNode& node, const std::string& message);
/// Fails with "found <the node, in words>, expected <expected>".
[[noreturn]] void fail_expected(const YamlNode& node, std::string_view expected);

double read_number(const YamlNode& node, const NumberRange& range);
std::int64_t read_integer(const YamlNode& node, const NumberRange& range);
bool read_bool(const YamlNode& node);
/// A word or a string; `expected` says of what kind, as in "the name of a material".
std::string read_string(const YamlNode& node, std::string_view expected);
/// A word out of `choices`.
std::string read_choice(const YamlNode& node, std::string_view what, const std::vector<std::string_view>& choices);
/// A list of `count` numbers.
std::vector<double> read_numbers(const YamlNode& node, std::size_t count, const NumberRange& range);
Imath::V3d read_vec3(const YamlNode& node, const NumberRange& range);
/// Three numbers, or one that stands for grey.
Rgb read_color(const YamlNode& node, const NumberRange& range);
/// The items of a list; `what` it lists, as in "shapes".
const std::vector<YamlPtr>& read_list(const YamlNode& node, std::string_view what);
/// The entries of a map whose keys are names; `what` it maps, as in "materials".
const std::vector<YamlNode::Entry>& read_names(const YamlNode& node, std::string_view what);

/// A map with a fixed set of keys.
class MapReader {
  public:
    /// `what` the map describes, as in "a sphere". Fails for a node that is no map and for keys other than `keys`.
    MapReader(const YamlNode& node, std::string_view what, const std::vector<std::string_view>& keys);

    /// For a map whose keys were checked already.
    MapReader(const YamlNode& node, std::string_view what) : node_(node), what_(what) {}

    /// Null where the key is not given.
    const YamlNode* find(std::string_view key) const;
    /// Fails where the key is not given.
    const YamlNode& at(std::string_view key) const;

    double number(std::string_view key, const NumberRange& range, double otherwise) const {
        const YamlNode* value = find(key);
        return value != nullptr ? read_number(*value, range) : otherwise;
    }
    bool boolean(std::string_view key, bool otherwise) const {
        const YamlNode* value = find(key);
        return value != nullptr ? read_bool(*value) : otherwise;
    }
    Imath::V3d vec3(std::string_view key, const NumberRange& range, const Imath::V3d& otherwise) const {
        const YamlNode* value = find(key);
        return value != nullptr ? read_vec3(*value, range) : otherwise;
    }

  private:
    const YamlNode& node_;
    std::string what_;
};

/// The value of the key `type` of a map, one of `choices`: it decides which other keys a map may have.
std::string read_type(const YamlNode& node, std::string_view what, const std::vector<std::string_view>& choices);

} // namespace keyhole
