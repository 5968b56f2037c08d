// From what a file says of its shapes to the shapes of a scene.
#pragma once

#include "scene/load/input.h"
#include "scene/load/load_mesh.h"
#include "scene/load/pbrt/properties.h"
#include "scene/load/pbrt/shapes.h"
#include "scene/shape.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace keyhole::pbrt {

/// A `Shape` directive with the state it stood in.
struct ShapeRecord {
    Directive directive; ///< for messages; its parameters are left out
    ShapeSource source;
    Transform to_world; ///< or to the space of the object that it belongs to
    bool reversed = false;
    MaterialEntry material;
    std::string material_name; ///< looked up at the end if not empty: a name may be used before it is made
    std::shared_ptr<const Directive> named_by; ///< what used that name, for messages
    std::optional<AreaLight> light;
    FloatTexture alpha;                            ///< may be null
    std::shared_ptr<const Medium> inside, outside; ///< null: vacuum
};

/// Whether shapes of two directives differ in their geometry alone, so that one mesh may hold both. Area lights are
/// always apart.
bool look_alike(const ShapeRecord& a, const ShapeRecord& b);

/// A record where it stands in the world.
struct Placement {
    std::size_t record;
    Transform to_world;   ///< after the record's own
    std::size_t copy = 0; ///< of an object, from 1 in the order of placements; 0: none
};

/// Reads the mesh files, each once and several at a time, and puts all shapes into world space. `records` are used up.
/// Broken meshes, singular transforms, unknown materials, and too much of everything become `mistakes`, in the order of
/// `records` or `placements`. Where there are any, nothing is put anywhere, and no shapes are returned.
std::vector<Shape> build_shapes(std::vector<ShapeRecord> records, const std::vector<Placement>& placements,
                                const Library& library, Warnings& warnings, Mistakes& mistakes);

} // namespace keyhole::pbrt
