// The only file that knows Embree.
#include "scene/scene.h"

#include "core/error.h"
#include "scene/emitters/area.h"
#include "scene/emitters/environment.h"
#include "scene/geometry.h"
#include "scene/ray_counter.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>

namespace keyhole {
namespace {

/// How far along a connecting edge blockers count. The end is offset from its surface by the error of its position;
/// what this leaves room for is the relative error of the distance itself.
constexpr float kEdgeEnd = 1 - 1e-5f;

/// Distances differ in their last bits between instruction sets; pinning one makes pictures portable (and avx2 is the
/// faster one for single rays).
const char* device_config() { return __builtin_cpu_supports("avx2") != 0 ? "isa=avx2" : ""; }

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

/// Degenerate triangles have no normal; nothing may hit or sample them.
void remove_degenerate_triangles(TriangleMesh& mesh) {
    std::erase_if(mesh.triangles, [&](const auto& t) {
        const Vec3& a = mesh.positions[t[0]];
        const Vec3 n = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
        return !(n.length2() > std::numeric_limits<float>::min());
    });
}

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

} // namespace

struct Scene::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    Embree() : device(rtcNewDevice(device_config())) {
        if (device == nullptr) throw std::runtime_error("Embree gave no device");
        scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    }
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    void attach(const TriangleMesh& mesh, unsigned id) {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                      3 * sizeof(float), mesh.positions.size()));
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            for (int k = 0; k < 3; ++k) positions[3 * i + static_cast<std::size_t>(k)] = mesh.positions[i][k];
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
        for (const auto& t : mesh.triangles)
            for (const auto i : t) *indices++ = i;
        commit(g, id);
    }

    void attach(const Sphere& sphere, unsigned id) {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto* v = static_cast<float*>(
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1));
        for (int k = 0; k < 3; ++k) v[k] = sphere.center[k];
        v[3] = sphere.radius;
        commit(g, id);
    }

  private:
    void commit(RTCGeometry g, unsigned id) {
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(scene, g, id);
        rtcReleaseGeometry(g);
    }
};

Scene::Scene(SceneDescription description)
    : shapes_(std::move(description.shapes)), emitters_(std::move(description.emitters)),
      camera_(description.camera, description.window), embree_(std::make_unique<Embree>()) {
    if (shapes_.empty()) throw InputError("the scene is empty: no shapes");
    constexpr float inf = std::numeric_limits<float>::infinity();
    lower_ = Vec3(inf);
    upper_ = Vec3(-inf);
    merge_environments(emitters_);
    emitter_of_shape_.assign(shapes_.size(), SurfacePoint::kNone);
    for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
        Shape& shape = shapes_[i];
        if (auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
            check_mesh(*mesh);
            remove_degenerate_triangles(*mesh);
        } else {
            check_sphere(std::get<Sphere>(shape.geometry));
        }
        std::visit([&](const auto& geometry) { embree_->attach(geometry, i); }, shape.geometry);
        if (shape.emission && surface_area(shape) > 0) {
            emitter_of_shape_[i] = static_cast<std::uint32_t>(emitters_.size());
            emitters_.push_back(make_area_emitter(shape, i));
        }
        const BsdfTraits t = shape.material->traits();
        traits_.finite |= t.finite;
        traits_.delta |= t.delta;
        traits_.near_lambertian |= t.near_lambertian;
    }
    rtcCommitScene(embree_->scene);
    RTCBounds bounds;
    rtcGetSceneBounds(embree_->scene, &bounds);
    lower_ = Vec3(bounds.lower_x, bounds.lower_y, bounds.lower_z);
    upper_ = Vec3(bounds.upper_x, bounds.upper_y, bounds.upper_z);

    std::vector<double> powers;
    powers.reserve(emitters_.size());
    for (std::uint32_t i = 0; i < emitters_.size(); ++i) {
        emitters_[i]->enclose(bounding_sphere());
        powers.push_back(emitters_[i]->power());
        if (is_environment(*emitters_[i])) environment_ = i;
    }
    emitter_distribution_ = EmitterDistribution(powers);
}

Scene::~Scene() = default;

std::optional<SurfacePoint> Scene::trace(const SurfacePoint& from, const Vec3& w) const {
    count_ray();
    const Vec3 o = from.ray_origin(w);
    RTCRayHit query;
    query.ray.org_x = o.x;
    query.ray.org_y = o.y;
    query.ray.org_z = o.z;
    query.ray.dir_x = w.x;
    query.ray.dir_y = w.y;
    query.ray.dir_z = w.z;
    query.ray.tnear = 0;
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.time = 0;
    query.ray.mask = ~0u;
    query.ray.flags = 0;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->scene, &context, &query);
    const auto& hit = query.hit;
    SurfacePoint s;
    if (hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        if (environment_ == SurfacePoint::kNone) return std::nullopt;
        s = infinite_point(w);
        s.emitter = environment_;
        return s;
    }

    const Shape& shape = shapes_[hit.geomID];
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
        s = triangle_point(*mesh, hit.primID, hit.u, hit.v);
    } else {
        const auto& sphere = std::get<Sphere>(shape.geometry);
        s = sphere_point(sphere, (o + w * query.ray.tfar - sphere.center).normalized());
    }
    s.shape = hit.geomID;
    s.emitter = emitter_of_shape_[hit.geomID];
    s.material = shape.material.get();
    return s;
}

bool Scene::visible(const SurfacePoint& a, const SurfacePoint& b) const {
    count_ray();
    const SurfacePoint &from = a.site == Site::infinite ? b : a, &to = a.site == Site::infinite ? a : b;
    const Vec3 w = direction(from, to);
    const Vec3 o = from.ray_origin(w);
    const bool bounded = to.site != Site::infinite;
    const Vec3 d = bounded ? to.ray_origin(-w) - o : w;
    RTCRay ray;
    ray.org_x = o.x;
    ray.org_y = o.y;
    ray.org_z = o.z;
    ray.dir_x = d.x;
    ray.dir_y = d.y;
    ray.dir_z = d.z;
    ray.tnear = 0;
    ray.tfar = bounded ? kEdgeEnd : std::numeric_limits<float>::infinity();
    ray.time = 0;
    ray.mask = ~0u;
    ray.flags = 0;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(embree_->scene, &context, &ray);
    return ray.tfar >= 0;
}

std::size_t Scene::triangle_count() const {
    std::size_t n = 0;
    for (const Shape& s : shapes_)
        if (const auto* mesh = std::get_if<TriangleMesh>(&s.geometry)) n += mesh->triangles.size();
    return n;
}

} // namespace keyhole
