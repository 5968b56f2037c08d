// Rays by Embree.
#include "scene/accelerator.h"

#include "core/embree_device.h"
#include "scene/geometry.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>

namespace keyhole {
namespace {

/// Distances differ in their last bits between instruction sets; pinning one makes pictures portable (and avx2 is the
/// faster one for single rays).
const char* device_config() { return __builtin_cpu_supports("avx2") != 0 ? "isa=avx2" : ""; }

RTCRay make_ray(const Vec3& origin, const Vec3& direction, float nearest, float farthest) {
    RTCRay ray;
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tnear = nearest;
    ray.tfar = farthest;
    ray.time = 0;
    ray.mask = ~0u;
    ray.flags = 0;
    return ray;
}

/// A hit in a copy, whose geometries are numbered from the first of its shapes, which the copy has the number of. Of
/// the triangles of mirrored copies the second and the third corner change places.
RayHit hit_of_copy(const std::vector<Shape>& shapes, unsigned instance, const RayHit& hit) {
    const std::uint32_t shape = instance + hit.shape;
    const bool mirrored = std::get<MeshInstance>(shapes[shape].geometry).to_world->is_mirrored();
    return {shape, hit.primitive, mirrored ? hit.v : hit.u, mirrored ? hit.u : hit.v, hit.t};
}

/// Not in line: most hits are none of a copy, and the rest of what follows is.
[[gnu::noinline]] RayHit hit_of_copy(const std::vector<Shape>& shapes, const RTCRayHit& query) {
    const RTCHit& hit = query.hit;
    return hit_of_copy(shapes, hit.instID[0], {hit.geomID, hit.primID, hit.u, hit.v, query.ray.tfar});
}

/// Lets a ray pass where its shape has a hole.
void pass_holes(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] != -1) return;
    const auto& shapes = *static_cast<const std::vector<Shape>*>(arguments->geometryUserPtr);
    RTCRayN* ray = arguments->ray;
    RTCHitN* hit = arguments->hit;
    RayHit at{RTCHitN_geomID(hit, 1, 0), RTCHitN_primID(hit, 1, 0), RTCHitN_u(hit, 1, 0), RTCHitN_v(hit, 1, 0),
              RTCRayN_tfar(ray, 1, 0)};
    const unsigned copy = RTCHitN_instID(hit, 1, 0, 0);
    if (copy != RTC_INVALID_GEOMETRY_ID) at = hit_of_copy(shapes, copy, at);
    // Within a copy those of its object, which only spheres would need.
    const Vec3 origin(RTCRayN_org_x(ray, 1, 0), RTCRayN_org_y(ray, 1, 0), RTCRayN_org_z(ray, 1, 0));
    const Vec3 direction(RTCRayN_dir_x(ray, 1, 0), RTCRayN_dir_y(ray, 1, 0), RTCRayN_dir_z(ray, 1, 0));
    const Shape& shape = shapes[at.shape];
    if (!is_opaque(shape.alpha, hit_point(shape, at, origin, direction))) arguments->valid[0] = 0;
}

} // namespace

SurfacePoint hit_point(const Shape& shape, const RayHit& hit, const Vec3& origin, const Vec3& direction) {
    const bool parametrised = reads_parametrisation(shape);
    const auto point = [&]() -> SurfacePoint {
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry))
            return triangle_point(*mesh, hit.primitive, hit.u, hit.v, parametrised);
        if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
            return sphere_point(*sphere, (origin + direction * hit.t - sphere->center).normalized(), parametrised);
        return triangle_point(shape, hit.primitive, hit.u, hit.v, parametrised);
    };
    SurfacePoint s = point();
    s.shape = hit.shape;
    s.material = shape.material.get();
    return s;
}

struct Accelerator::Embree {
    const std::vector<Shape>& shapes;
    std::vector<std::vector<std::uint32_t>> copies{}; // of objects, by their shapes; until they are attached
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::atomic<std::ptrdiff_t> bytes{0};

    explicit Embree(const std::vector<Shape>& all) : shapes(all), device(new_device(device_config())) {
        const auto count = [](void* self, ssize_t change, bool /*before or after*/) {
            static_cast<Embree*>(self)->bytes.fetch_add(change, std::memory_order_relaxed);
            return true;
        };
        rtcSetDeviceMemoryMonitorFunction(device, count, this);
        scene = new_scene();
    }
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    RTCGeometry make(const TriangleMesh& mesh) const {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                      3 * sizeof(float), mesh.positions.size()));
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            for (int k = 0; k < 3; ++k) positions[3 * i + static_cast<std::size_t>(k)] = mesh.positions[i][k];
        auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
        for (const auto& t : mesh.triangles)
            for (const auto i : t) *indices++ = i;
        return g;
    }

    RTCGeometry make(const Sphere& sphere) const {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto* v = static_cast<float*>(
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1));
        for (int k = 0; k < 3; ++k) v[k] = sphere.center[k];
        v[3] = sphere.radius;
        return g;
    }

    RTCGeometry make(const MeshInstance& instance) const { return make(*instance.mesh); }

    void attach(RTCScene to, std::uint32_t number, const Shape& shape) const {
        RTCGeometry g = std::visit([&](const auto& geometry) { return make(geometry); }, shape.geometry);
        if (shape.alpha) {
            rtcSetGeometryUserData(g, const_cast<std::vector<Shape>*>(&shapes));
            rtcSetGeometryIntersectFilterFunction(g, pass_holes);
            rtcSetGeometryOccludedFilterFunction(g, pass_holes);
        }
        attach(to, number, g);
    }

    static void attach(RTCScene to, std::uint32_t number, RTCGeometry g) {
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(to, g, number);
        rtcReleaseGeometry(g);
    }

    RTCScene new_scene() const {
        RTCScene made = rtcNewScene(device);
        rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_HIGH);
        return made;
    }

    /// What copies whose object has one hierarchy have in common: of each shape its place after the first, its mesh,
    /// and whether it has holes.
    using Object = std::vector<std::tuple<std::uint32_t, const TriangleMesh*, bool>>;

    Object object_of(const std::vector<std::uint32_t>& copy) const {
        Object object;
        for (const std::uint32_t i : copy)
            object.emplace_back(i - copy[0], held_mesh(shapes[i]), shapes[i].alpha != nullptr);
        return object;
    }

    void attach_copies() {
        std::map<Object, RTCScene> objects;
        for (const auto& copy : copies) {
            const auto [object, fresh] = objects.try_emplace(object_of(copy));
            if (fresh) {
                object->second = new_scene();
                for (const std::uint32_t i : copy) attach(object->second, i - copy[0], shapes[i]);
                rtcCommitScene(object->second);
            }
            RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(g, object->second);
            const Imath::M44d& m = std::get<MeshInstance>(shapes[copy[0]].geometry).to_world->matrix();
            std::array<float, 12> columns;
            for (std::size_t i = 0; i < 12; ++i)
                columns[i] = static_cast<float>(m[static_cast<int>(i / 3)][static_cast<int>(i % 3)]);
            rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
            attach(scene, copy[0], g);
        }
        for (const auto& [object, made] : objects) rtcReleaseScene(made); // instances keep them
        copies = {};
    }

    RTCBounds bounds() const {
        RTCBounds b;
        rtcGetSceneBounds(scene, &b);
        return b;
    }
};

Accelerator::Accelerator(const std::vector<Shape>& shapes) : embree_(std::make_unique<Embree>(shapes)) {}
Accelerator::~Accelerator() = default;

void Accelerator::attach(std::uint32_t index) {
    const std::vector<Shape>& shapes = embree_->shapes;
    const auto* instance = std::get_if<MeshInstance>(&shapes[index].geometry);
    if (instance == nullptr) return embree_->attach(embree_->scene, index, shapes[index]);
    auto& copies = embree_->copies;
    const auto same = [&](std::uint32_t other) {
        return std::get<MeshInstance>(shapes[other].geometry).to_world == instance->to_world;
    };
    if (copies.empty() || !same(copies.back().front())) copies.emplace_back();
    copies.back().push_back(index);
}

void Accelerator::commit() {
    embree_->attach_copies();
    rtcCommitScene(embree_->scene);
}

std::optional<RayHit> Accelerator::intersect(const Vec3& origin, const Vec3& direction, float nearest) const {
    RTCRayHit query;
    query.ray = make_ray(origin, direction, nearest, std::numeric_limits<float>::infinity());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->scene, &context, &query);
    const RTCHit& hit = query.hit;
    if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    if (hit.instID[0] != RTC_INVALID_GEOMETRY_ID) return hit_of_copy(embree_->shapes, query);
    return RayHit{hit.geomID, hit.primID, hit.u, hit.v, query.ray.tfar};
}

bool Accelerator::occluded(const Vec3& origin, const Vec3& direction, float farthest) const {
    RTCRay ray = make_ray(origin, direction, 0, farthest);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(embree_->scene, &context, &ray);
    return ray.tfar < 0;
}

Vec3 Accelerator::lower() const {
    const RTCBounds b = embree_->bounds();
    return {b.lower_x, b.lower_y, b.lower_z};
}

Vec3 Accelerator::upper() const {
    const RTCBounds b = embree_->bounds();
    return {b.upper_x, b.upper_y, b.upper_z};
}

std::size_t Accelerator::bytes() const { return static_cast<std::size_t>(embree_->bytes.load()); }

} // namespace keyhole
