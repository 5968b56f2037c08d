// Materials of pbrt's format, and v3's under their v4 equivalents.
#pragma once

#include "scene/material.h"
#include "scene/pbrt/parameters.h"
#include "scene/pbrt/textures.h"

#include <functional>
#include <map>
#include <string>

namespace keyhole::pbrt {

struct MaterialEntry {
    MaterialPtr material;
    bool is_interface = false; ///< no surface at all
    bool is_textured = false;  ///< looks at texture coordinates
};

/// The named materials of a scene.
class MaterialTable {
  public:
    /// Reads the parameters of a material of kind `type`.
    /// @throws InputError for materials that we have no likeness of.
    MaterialEntry read(const std::string& type, Parameters& parameters, const TextureTable& textures) const;

    /// A `MakeNamedMaterial` directive, whose type is a parameter. A name may be given anew.
    void define(Parameters& parameters, const TextureTable& textures);

    /// @throws InputError with the position of `user` for an unknown name.
    const MaterialEntry& look_up(const std::string& name, const Directive& user) const;

  private:
    std::map<std::string, MaterialEntry> named_;
};

} // namespace keyhole::pbrt
