// Materials, lights, textures and media of pbrt's format, and v3's under their v4 equivalents.
#pragma once

#include "scene/load/load_mesh.h"
#include "scene/load/pbrt/syntax/parameters.h"
#include "scene/load/properties.h"
#include "scene/media/medium.h"

#include <map>
#include <memory>
#include <string>

namespace keyhole::pbrt {

struct MaterialEntry {
    MaterialPtr material;
    bool is_interface = false; ///< no surface at all
    bool is_textured = false;  ///< looks at texture coordinates
};

/// A medium that we have no likeness of is refused only where something is put into it.
struct MediumEntry {
    std::shared_ptr<const Medium> medium; ///< the same object for the same name, so that shapes can tell media apart
    std::string refusal;                  ///< why it can't be rendered; empty: it can
};

/// What a file gives names to. A name may be given anew.
struct Library {
    std::map<std::string, ColorTexture> colors;
    std::map<std::string, FloatTexture> numbers; ///< textures too, with names of their own
    std::map<std::string, MaterialEntry> materials;
    std::map<std::string, MediumEntry> media;
};

// All throw InputError for kinds that we have no likeness of, and for files that can't be read. Parameters that nothing
// reads are warned of.

/// A `Texture` directive.
void define_texture(Parameters& parameters, Library& library, const Transform& to_world);
/// A `MakeNamedMaterial` directive, whose type is a parameter.
void define_material(Parameters& parameters, Library& library);
/// A `MakeNamedMedium` directive; media.cpp.
void define_medium(Parameters& parameters, Library& library, const Transform& to_world);

MaterialEntry read_material(const std::string& type, Parameters& parameters, const Library& library);
/// A `LightSource` directive. Null for a black light.
/// @param exposure factor on all light.
EmitterPtr read_light(Parameters& parameters, const Library& library, const Transform& to_world, double exposure);
/// An `AreaLightSource` directive.
AreaLight read_area_light(Parameters& parameters, const Library& library, double exposure);
/// A parameter that is a number, within `range`, or names a texture; null where it is not given.
FloatTexture find_number_texture(Parameters& parameters, const Library& library, const char* name,
                                 const NumberRange& range);

/// Null for the vacuum, whose name is empty.
/// @throws InputError with the position of `user` for an unknown name, and for media that are refused.
std::shared_ptr<const Medium> find_medium(const Library& library, const std::string& name, const Directive& user);

} // namespace keyhole::pbrt
