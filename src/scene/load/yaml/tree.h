// YAML text as a tree that knows where each of its nodes stands.
#pragma once

#include "core/error.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace keyhole {

struct YamlNode;
using YamlPtr = std::shared_ptr<const YamlNode>;

/// A node of a YAML document. Aliases share the node of their anchor, so that the tree is an acyclic graph.
struct YamlNode {
    enum class Kind { null, scalar, list, map };
    struct Entry {
        YamlPtr key, value; ///< the key is a scalar, unlike all others in its map
    };

    Kind kind = Kind::null;
    std::shared_ptr<const std::string> file;
    int line = 0, column = 0;   ///< from 1
    std::string text;           ///< of a scalar
    bool quoted = false;        ///< a scalar in quotes is never a number
    std::vector<YamlPtr> items; ///< of a list
    std::vector<Entry> entries; ///< of a map, in file order
    std::size_t size = 1;       ///< nodes in the tree below and including this one, aliases expanded
    int height = 1;             ///< levels below and including this one, aliases expanded

    FilePosition position() const { return {*file, line, column}; }
};

/// Limits that no honest scene meets: they stop documents made to exhaust memory or stack.
constexpr std::size_t kMaxYamlNodes = std::size_t{1} << 22;
constexpr int kMaxYamlHeight = 64;

/// Parses one document.
/// @param file name used in messages, and `what` it should hold.
/// @throws InputError with its position for broken syntax, binary data, a duplicate key, a key that is not a scalar,
/// several documents, an alias within its own anchor, and documents past the limits above.
YamlPtr parse_yaml(const std::string& text, const std::string& file, std::string_view what = "a scene");

} // namespace keyhole
