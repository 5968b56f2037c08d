// Copies of meshes, as instances and as meshes of their own.
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace keyhole::test {

/// A dented ball of 2 * columns * rows triangles about the origin, not in its middle, closed, with smooth normals and
/// texture coordinates.
TriangleMesh dented_ball(std::uint32_t columns, std::uint32_t rows);

/// Reproducible by `seed`: turned, sheared, scaled by factors that differ, and mirrored or not.
Imath::M44d random_transform(std::uint64_t seed, bool mirrored);

/// The transform, and then a scale and a way to go.
Imath::M44d moved(const Imath::M44d& transform, double scale, const Imath::V3d& by);

/// A shape that stands there as an instance.
Shape instance_of(const std::shared_ptr<const TriangleMesh>& mesh, const std::shared_ptr<const ObjectToWorld>& to_world,
                  std::shared_ptr<const Material> material);

/// Of nothing but these.
std::unique_ptr<Scene> scene_of(std::vector<Shape> shapes);

/// The same shapes with meshes in the place of their instances.
std::vector<Shape> without_instances(const std::vector<Shape>& shapes);

/// The mesh as an OBJ file.
std::string obj_text(const TriangleMesh& mesh);

} // namespace keyhole::test
