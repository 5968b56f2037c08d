// Rays by Embree.
#include "scene/accelerator.h"

#include "core/embree_device.h"
#include "scene/geometry.h"

#include <atomic>
#include <cstddef>
#include <limits>

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

/// Lets a ray pass where its shape has a hole.
void pass_holes(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] != -1) return;
    const auto& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
    RTCRayN* ray = arguments->ray;
    RTCHitN* hit = arguments->hit;
    const RayHit at{RTCHitN_geomID(hit, 1, 0), RTCHitN_primID(hit, 1, 0), RTCHitN_u(hit, 1, 0), RTCHitN_v(hit, 1, 0),
                    RTCRayN_tfar(ray, 1, 0)};
    const Vec3 origin(RTCRayN_org_x(ray, 1, 0), RTCRayN_org_y(ray, 1, 0), RTCRayN_org_z(ray, 1, 0));
    const Vec3 direction(RTCRayN_dir_x(ray, 1, 0), RTCRayN_dir_y(ray, 1, 0), RTCRayN_dir_z(ray, 1, 0));
    if (!is_opaque(shape.alpha, hit_point(shape, at, origin, direction))) arguments->valid[0] = 0;
}

} // namespace

SurfacePoint hit_point(const Shape& shape, const RayHit& hit, const Vec3& origin, const Vec3& direction) {
    const bool parametrised = reads_parametrisation(shape);
    const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
    const auto outward = [&](const Sphere& sphere) {
        return (origin + direction * hit.t - sphere.center).normalized();
    };
    SurfacePoint s = mesh != nullptr ? triangle_point(*mesh, hit.primitive, hit.u, hit.v, parametrised)
                                     : sphere_point(*std::get_if<Sphere>(&shape.geometry),
                                                    outward(*std::get_if<Sphere>(&shape.geometry)), parametrised);
    s.shape = hit.shape;
    s.material = shape.material.get();
    return s;
}

struct Accelerator::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::atomic<std::ptrdiff_t> bytes{0};

    Embree() : device(new_device(device_config())) {
        const auto count = [](void* self, ssize_t change, bool /*before or after*/) {
            static_cast<Embree*>(self)->bytes.fetch_add(change, std::memory_order_relaxed);
            return true;
        };
        rtcSetDeviceMemoryMonitorFunction(device, count, this);
        scene = rtcNewScene(device);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
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

    RTCBounds bounds() const {
        RTCBounds b;
        rtcGetSceneBounds(scene, &b);
        return b;
    }
};

Accelerator::Accelerator() : embree_(std::make_unique<Embree>()) {}
Accelerator::~Accelerator() = default;

void Accelerator::attach(const Shape& shape, std::uint32_t index) {
    RTCGeometry g = std::visit([&](const auto& geometry) { return embree_->make(geometry); }, shape.geometry);
    if (shape.alpha) {
        rtcSetGeometryUserData(g, const_cast<Shape*>(&shape));
        rtcSetGeometryIntersectFilterFunction(g, pass_holes);
        rtcSetGeometryOccludedFilterFunction(g, pass_holes);
    }
    rtcCommitGeometry(g);
    rtcAttachGeometryByID(embree_->scene, g, index);
    rtcReleaseGeometry(g);
}

void Accelerator::commit() { rtcCommitScene(embree_->scene); }

std::optional<RayHit> Accelerator::intersect(const Vec3& origin, const Vec3& direction, float nearest) const {
    RTCRayHit query;
    query.ray = make_ray(origin, direction, nearest, std::numeric_limits<float>::infinity());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->scene, &context, &query);
    const RTCHit& hit = query.hit;
    if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
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
