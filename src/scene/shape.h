// Geometry, as plain data.
#pragma once

#include "core/vec.h"
#include "scene/emitters/emission_profile.h"
#include "scene/material.h"
#include "scene/media/medium.h"
#include "scene/object_to_world.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace keyhole {

/// Indexed triangles in world space, but for those of a MeshInstance. The outside of a triangle is where its corners
/// run anticlockwise.
struct TriangleMesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals; ///< unit, one per position; or empty: flat
    std::vector<Vec2> uvs;     ///< one per position; or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<bool> flat{}; ///< of triangles whether they are flat in spite of `normals`; empty: none is
};

/// A sphere in world space. The outside is away from the centre, or towards it if `inward`.
struct Sphere {
    Vec3 center{0, 0, 0};
    float radius = 1;
    bool inward = false;
};

/// A copy of a mesh that is held once. Its triangles have the numbers that they have in the mesh.
struct MeshInstance {
    std::shared_ptr<const TriangleMesh> mesh;      ///< in the space of an object
    std::shared_ptr<const ObjectToWorld> to_world; ///< the same one for all shapes of one copy of the object
};

using Geometry = std::variant<TriangleMesh, Sphere, MeshInstance>;

/// What a surface emits, for shapes that are area lights.
struct SurfaceEmission {
    Rgb radiance{0.0};      ///< W/(m^2 sr), along the normal
    bool two_sided = false; ///< otherwise on the outside only
    ColorTexture picture{}; ///< factor on the radiance, not negative; null: 1
    EmissionProfile profile{};
};

/// Geometry with its material and, for area lights, its emission.
struct Shape {
    Geometry geometry;                        ///< of area lights within a Scene no MeshInstance
    std::shared_ptr<const Material> material; ///< null: black; of a boundary of media: nothing that light would notice
    std::unique_ptr<SurfaceEmission> emission;
    FloatTexture alpha{}; ///< opacity, as is_opaque() reads it; null: opaque. Of an area light 0: see below
    std::shared_ptr<const Medium> inside{}, outside{}; ///< null: vacuum; both the same: whatever is around
    std::string name{}, material_name{};               ///< what people call them; empty: nothing
};

/// Whether one medium ends at the surface of `shape` and another begins.
inline bool bounds_media(const Shape& shape) { return shape.inside != shape.outside; }

/// Whether what happens at the points of `shape` depends on its parametrisation.
inline bool reads_parametrisation(const Shape& shape) {
    return shape.alpha != nullptr || (shape.emission != nullptr && shape.emission->picture != nullptr) ||
           (shape.material != nullptr && shape.material->reads_parametrisation());
}

/// Whether `shape` shines and is not there otherwise: an area light of opacity 0 everywhere. No ray meets it and it has
/// no shadow, but its points are sampled like those of other lights.
bool is_invisible_light(const Shape& shape);

/// Finds the triangles whose corners have the normal of the face, to rounding: there the shading normal is that of the
/// face, exactly. Drops the normals of a mesh where all are. From then on triangles have to keep their numbers.
void mark_flat_triangles(TriangleMesh& mesh);

/// Whether rays and light pass `shape` as if it weren't there, but for the media that it parts.
bool is_interface(const Shape& shape);

} // namespace keyhole
