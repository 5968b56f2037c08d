#include "methods/enclosure.h"

#include "scene/load/load_mesh.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

using Box = Imath::Box3d;

/// Whether the triangles go once around p: their signed solid angles (Van Oosterom and Strackee 1983) are the whole
/// sphere's then. From outside they add up to nothing.
bool goes_around(const TriangleMesh& mesh, const Imath::V3d& p) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Imath::V3d a = Imath::V3d(mesh.positions[t[0]]) - p, b = Imath::V3d(mesh.positions[t[1]]) - p,
                         c = Imath::V3d(mesh.positions[t[2]]) - p;
        const double la = a.length(), lb = b.length(), lc = c.length();
        sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return std::abs(sum) > 3 * kPi; // on the surface itself it is 2 pi
}

/// Whether neither light nor what scatters goes through a shape, nor any comes from it.
bool is_opaque_wall(const Shape& shape) {
    if (shape.material == nullptr || shape.emission != nullptr || shape.alpha != nullptr) return false;
    const BsdfTraits traits = shape.material->traits();
    return traits.finite && !traits.delta && !traits.through;
}

bool may_stand_in(const Emitter& emitter, const Box& box) {
    if (emitter.site() == Site::infinite) return false;
    const auto bounds = emitter.bounds();
    return !bounds || box.intersects(Box(Imath::V3d(bounds->lower), Imath::V3d(bounds->upper)));
}

} // namespace

const Shape* dark_enclosure(const Scene& scene) {
    if (scene.camera().has_lens()) return nullptr;
    const Imath::V3d eye(scene.camera().eye(0.5, 0.5).p);
    for (const Shape& shape : scene.shapes()) {
        const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
        if (mesh == nullptr || !is_opaque_wall(shape)) continue;
        const Box box = box_of(*mesh);
        if (!box.intersects(eye)) continue;
        // A large mesh takes longer to look through than a short trial lasts, and this is asked after each.
        const auto stands_in = [&](const auto& emitter) { return may_stand_in(*emitter, box); };
        if (std::ranges::any_of(scene.emitters(), stands_in)) continue;
        if (goes_around(*mesh, eye) && is_closed(*mesh)) return &shape;
    }
    return nullptr;
}

} // namespace keyhole
