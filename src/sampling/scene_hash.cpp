#include "sampling/scene_hash.h"

#include "core/bytes.h"
#include "sampling/paths/light_tracer.h"
#include "scene/geometry.h"

#include <map>

namespace keyhole {
namespace {

/// Of copies the mesh once.
void add_geometry(const Shape& shape, std::map<const TriangleMesh*, std::size_t>& meshes, Hash& hash) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
        hash.add(sphere->center);
        hash.add(sphere->radius);
        return;
    }
    const TriangleMesh& mesh = *held_mesh(shape);
    if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry)) {
        const auto [known, fresh] = meshes.try_emplace(&mesh, meshes.size());
        hash.add(instance->to_world->matrix());
        hash.add(known->second);
        if (!fresh) return;
    }
    hash.add(mesh.positions);
    hash.add(mesh.normals);
    hash.add(mesh.triangles);
}

void add_camera(const Camera& camera, Hash& hash) {
    const CameraParameters& c = camera.parameters();
    for (const Vec3& v : {c.origin, c.right, c.up, c.forward}) hash.add(v);
    for (const float f : {c.fov_degrees, c.lens_radius, c.focus_distance, c.near}) hash.add(f);
    for (const double d : {c.shift.x, c.shift.y}) hash.add(d);
    if (!c.sees_surroundings) hash.add(c.sees_surroundings);
}

/// What light does here.
struct Probe {
    Hash& hash;
    bool arrival(const Vertex& v, const Vec3&, const Rgb& power, const LightPast&) {
        hash.add(v.point.p);
        hash.add(power);
        return true;
    }
};

} // namespace

std::uint64_t scene_hash(const Scene& scene) {
    Hash hash;
    std::map<const TriangleMesh*, std::size_t> meshes;
    for (const Shape& shape : scene.shapes()) add_geometry(shape, meshes, hash);
    add_camera(scene.camera(), hash);
    Probe probe{hash};
    for (std::uint64_t i = 0; i < 4096; ++i) {
        Rng rng(0, StreamPurpose::emission, i);
        trace_light_path(scene, 8, rng, probe);
    }
    return hash.value();
}

} // namespace keyhole
