// Primitives of glTF's meshes: which of their parts are triangles, and what those refer to.
#pragma once

#include "scene/load/gltf/accessors.h"

#include <map>
#include <set>
#include <string>

namespace keyhole::gltf {

/// Holds the indices of meshes against the positions that there are: Assimp drops triangles that refer to others.
class IndexCheck {
  public:
    IndexCheck(const Document& document, AccessorReader& reader) : document_(document), reader_(reader) {}

    /// @throws InputError for indices out of range, and for what isn't indices.
    void check(const Json& primitive);

  private:
    const Document& document_;
    AccessorReader& reader_;
    std::map<std::size_t, std::uint32_t> largest_; ///< by accessor
};

/// Warns of what a mesh has beside whole triangles. @throws InputError for an unknown mode.
class LeftOutParts {
  public:
    explicit LeftOutParts(const Document& document) : document_(document) {}

    /// Of a mesh that the scene holds. More than one of a kind are told of once.
    void note(std::size_t mesh);

  private:
    void note_primitive(const Json& primitive, const std::string& owner);
    void tell(const char* what, const std::string& of);

    const Document& document_;
    std::set<std::string> told_; ///< kinds
};

} // namespace keyhole::gltf
