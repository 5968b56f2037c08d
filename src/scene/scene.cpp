#include "scene/scene.h"

#include "core/error.h"
#include "scene/emitters/emitters.h"
#include "scene/geometry.h"
#include "scene/ray_counter.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace keyhole {
namespace {

/// How far along a connecting edge blockers count. The end is offset from its surface by the error of its position;
/// what this leaves room for is the relative error of the distance itself.
constexpr float kEdgeEnd = 1 - 1e-5f;

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_mesh(const TriangleMesh& mesh) {
    const auto n = mesh.positions.size();
    if (mesh.triangles.empty()) throw InputError("a mesh has no triangles");
    if (!mesh.normals.empty() && mesh.normals.size() != n) throw InputError("a mesh needs one normal per position");
    if (!mesh.uvs.empty() && mesh.uvs.size() != n) throw InputError("a mesh needs one uv per position");
    for (const Vec3& p : mesh.positions)
        if (!is_finite(p)) throw InputError("a mesh has a position that is not finite");
    for (const auto& t : mesh.triangles)
        for (const auto i : t)
            if (i >= n)
                throw InputError("a mesh has a triangle with index " + std::to_string(i) + " of " + std::to_string(n));
}

void check_sphere(const Sphere& sphere) {
    if (!is_finite(sphere.center) || !(sphere.radius > 0) || !std::isfinite(sphere.radius))
        throw InputError("a sphere needs a finite centre and a positive radius");
}

void check_instance(const MeshInstance& instance) {
    if (instance.mesh == nullptr || instance.to_world == nullptr)
        throw InputError("an instance has no mesh or no transform");
    if (!instance.to_world->rounds_little())
        throw InputError("an instance needs a transform that can be inverted without loss");
}

/// Of an eye that sees nothing near.
bool begins_farther_on(const SurfacePoint& p) { return p.site == Site::point && p.offset > 0; }

/// Puts the sum of all environments, if there are several, in the place of the first.
void merge_environments(std::vector<std::unique_ptr<Emitter>>& emitters) {
    const auto environment = [](const auto& e) { return is_environment(*e); };
    if (std::ranges::count_if(emitters, environment) < 2) return;
    const auto first = std::ranges::find_if(emitters, environment) - emitters.begin();
    std::vector<std::unique_ptr<Emitter>> parts;
    for (auto& e : emitters)
        if (is_environment(*e)) parts.push_back(std::move(e));
    emitters[static_cast<std::size_t>(first)] = make_environment_sum(std::move(parts));
    std::erase(emitters, nullptr);
}

/// Shapes ready for rays: checked, without what no ray could tell from nothing.
std::vector<Shape> checked(std::vector<Shape> shapes) {
    std::set<const TriangleMesh*> meshes;
    for (Shape& shape : shapes) {
        if (is_invisible_light(shape)) shape.material = make_interface(); // where nothing scatters and no photon lies
        if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry)) {
            check_instance(*instance);
            if (meshes.insert(instance->mesh.get()).second) check_mesh(*instance->mesh);
            if (shape.emission)
                shape.geometry = flattened(*instance); // each light has its own triangles to choose from
        }
        if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
            check_mesh(*mesh);
            std::erase_if(mesh->triangles, [&](const auto& t) { return !has_area(*mesh, t); });
        } else if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
            check_sphere(*sphere);
        }
    }
    return shapes;
}

struct MeshTraits {
    float reach = 0; ///< distance of the farthest position from the origin
    bool flat_in_part = false;
};

/// Finds them once for each mesh, however many shapes hold it.
class MeshTraitsTable {
  public:
    const MeshTraits& of(const TriangleMesh& mesh) {
        const auto [known, fresh] = traits_.try_emplace(&mesh);
        if (fresh) {
            for (const Vec3& p : mesh.positions) known->second.reach = std::max(known->second.reach, p.length());
            known->second.flat_in_part = is_flat_in_part(mesh);
        }
        return known->second;
    }

  private:
    std::map<const TriangleMesh*, MeshTraits> traits_;
};

/// Whether light may go straight through `shape`, which has a material: a pane, or glass of which a triangle, at least,
/// is flat.
bool may_be_clear(const Shape& shape, MeshTraitsTable& meshes) {
    const ClearGlass glass = shape.material->traits().clear;
    if (glass != ClearGlass::face) return glass == ClearGlass::pane;
    const TriangleMesh* mesh = held_mesh(shape);
    return mesh != nullptr && meshes.of(*mesh).flat_in_part;
}

/// Stands for the bounds of a scene that is nothing but its surroundings: much goes by the size of the scene.
std::pair<Vec3, Vec3> box_around(const Vec3& eye) {
    const float half = std::max(1.0f, 1e-3f * eye.length()); // more than the last bits of a place far away
    return {eye - Vec3(half), eye + Vec3(half)};
}

} // namespace

Scene::Scene(SceneDescription description)
    : shapes_(checked(std::move(description.shapes))), media_(shapes_, std::move(description.medium)),
      emitters_(std::move(description.emitters)), camera_(description.camera, description.window),
      accelerator_(shapes_) {
    attach_shapes();
    prepare_emitters();
}

void Scene::attach_shapes() {
    emitter_of_shape_.assign(shapes_.size(), SurfacePoint::kNone);
    merge_environments(emitters_);
    MeshTraitsTable meshes;
    for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
        Shape& shape = shapes_[i];
        if (is_interface(shape)) continue;
        auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
        if (mesh != nullptr && shape.material && shape.material->traits().clear == ClearGlass::face)
            mark_flat_triangles(*mesh);
        if (shape.emission && surface_area(shape) > 0) {
            emitter_of_shape_[i] = static_cast<std::uint32_t>(emitters_.size());
            emitters_.push_back(make_area_emitter(shape, i));
        }
        if (is_invisible_light(shape)) continue;
        if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry))
            rounding_.add(*instance->to_world, meshes.of(*instance->mesh).reach);
        accelerator_.attach(i);
        if (!shape.material) continue;
        traits_ = traits_ | shape.material->traits();
        if (!may_be_clear(shape, meshes)) continue;
        if (!clear_glass_) clear_glass_ = std::make_unique<Accelerator>(shapes_);
        clear_glass_->attach(i);
    }
    accelerator_.commit();
    if (clear_glass_) clear_glass_->commit();
    // Beams of light are as wide as what they may meet.
    Imath::Box3f box = media_.bounds_of_scattering();
    box.extendBy(Imath::Box3f(accelerator_.lower(), accelerator_.upper()));
    lower_ = box.min;
    upper_ = box.max;
    if (!box.isEmpty()) return;
    if (std::ranges::none_of(emitters_, [](const auto& e) { return is_environment(*e); }))
        throw InputError("the scene is empty: nothing that a ray could meet, and no environment");
    std::tie(lower_, upper_) = box_around(camera_.parameters().origin);
}

void Scene::prepare_emitters() {
    std::vector<double> powers;
    powers.reserve(emitters_.size());
    for (std::uint32_t i = 0; i < emitters_.size(); ++i) {
        emitters_[i]->enclose(bounding_sphere());
        powers.push_back(emitters_[i]->power());
        if (is_environment(*emitters_[i])) environment_ = i;
    }
    // By power, with a floor: a strong light must not starve weak ones, which may stand nearer.
    double total = 0, shining = 0;
    for (const double p : powers) {
        total += p;
        shining += p > 0 ? 1 : 0;
    }
    for (double& p : powers) p += p > 0 ? 0.1 * total / shining : 0.0;
    emitter_distribution_ = EmitterDistribution(powers);
    light_tree_ = LightTree(emitters_, emitter_distribution_, bounding_sphere());
}

bool Scene::trace(const SurfacePoint& from, const Vec3& w, SurfacePoint& found) const {
    count_ray();
    const Vec3 o = from.ray_origin(w);
    const auto hit = accelerator_.intersect(o, w);
    if (!hit) {
        if (environment_ == SurfacePoint::kNone || hides_surroundings(from)) return false;
        found = infinite_point(w);
        found.emitter = environment_;
        return true;
    }
    found = hit_point(shapes_[hit->shape], *hit, o, w);
    found.emitter = emitter_of_shape_[hit->shape];
    return true;
}

std::optional<SurfacePoint> Scene::trace(const SurfacePoint& from, const Vec3& w) const {
    std::optional<SurfacePoint> found(std::in_place);
    if (!trace(from, w, *found)) found.reset();
    return found;
}

bool Scene::visible(const SurfacePoint& a, const SurfacePoint& b, const Vec3& a_to_b) const {
    count_ray();
    const bool turned = a.site == Site::infinite;
    const SurfacePoint &from = turned ? b : a, &to = turned ? a : b;
    const Vec3 w = turned ? -a_to_b : a_to_b, o = from.ray_origin(w);
    if (to.site == Site::infinite && hides_surroundings(from)) return false;
    if (to.site == Site::infinite) return !accelerator_.occluded(o, w, std::numeric_limits<float>::infinity());
    const Vec3 edge = to.ray_origin(-w) - o;
    if ((begins_farther_on(from) || begins_farther_on(to)) && edge.dot(w) < 0) return false; // before the view begins
    return !accelerator_.occluded(o, edge, kEdgeEnd);
}

bool Scene::meets_clear_glass(const SurfacePoint& from, const Vec3& w) const {
    return clear_glass_ && clear_glass_->occluded(from.ray_origin(w), w, std::numeric_limits<float>::infinity());
}

bool Scene::visible(const Vec3& a, const Vec3& b) const {
    count_ray();
    return !accelerator_.occluded(a, b - a, kEdgeEnd);
}

void Scene::InstanceRounding::add(const ObjectToWorld& to_world, float reach) {
    const float own = to_world.relative_rounding();
    const Imath::M44d& m = to_world.matrix();
    double stretch = 0; // squared: no direction becomes longer
    for (int i = 0; i < 3; ++i) stretch += row_of(m, i).length2();
    relative = std::max(relative, own);
    origins = std::max(origins, own * static_cast<float>(m.translation().length()));
    reaches = std::max(reaches, own * static_cast<float>(std::sqrt(stretch)) * reach);
}

float Scene::instance_rounding(const Vec3& p) const {
    // A copy's own origin may be much farther from the world's than its points are; but those are near one another
    // where it isn't the object's own coordinates that are large.
    const float of_point = rounding_.relative * p.length();
    return of_point + std::min(rounding_.origins, of_point + rounding_.reaches);
}

float Scene::rounding_along(const Vec3& n, const Vec3& p) const {
    return keyhole::rounding_along(n, p) + instance_rounding(p);
}

std::size_t Scene::triangle_count() const {
    std::size_t n = 0;
    for (const Shape& s : shapes_) n += keyhole::triangle_count(s);
    return n;
}

} // namespace keyhole
