// What directives change for the shapes and lights that follow, until their block ends.
#pragma once

#include "scene/load/geometry_transform.h"
#include "scene/pbrt/lights.h"
#include "scene/pbrt/materials.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace keyhole::pbrt {

struct GraphicsState {
    Transform to_world; ///< the current transformation matrix: from the space of what is named next
    bool reversed = false;
    MaterialEntry material;
    std::string material_name; ///< of a named material; empty: the one above
    std::optional<AreaLight> area_light;
    std::string inside_medium, outside_medium;
    std::map<std::string, std::vector<Parameter>> attributes; ///< defaults by what they are for: "shape", "light" ...
};

/// A directive that changes the transform: `Identity`, `Translate`, `Scale`, `Rotate`, `LookAt`, `Transform` or
/// `ConcatTransform`. @returns whether it is one.
/// @throws InputError for axes without length and singular matrices.
bool apply_transform(const Directive& directive, Transform& to_world);

} // namespace keyhole::pbrt
