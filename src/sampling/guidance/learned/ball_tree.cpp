#include "sampling/guidance/learned/ball_tree.h"

#include <Imath/ImathBox.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <stdexcept>

namespace keyhole {
namespace {

/// Boxes are so much wider than balls, over the extent of all: rays are traced in single precision.
constexpr float kMargin = 1e-5f;

/// A question on its way through Embree, which knows the first member only.
struct Query {
    RTCIntersectContext context;
    Vec3 origin, w;
    std::vector<std::uint32_t>* found;
};

bool count_bytes(void* counter, ssize_t bytes, bool /*post*/) {
    *static_cast<std::atomic<std::int64_t>*>(counter) += bytes;
    return true;
}

} // namespace

bool passes(const Ball& ball, const Vec3& origin, const Vec3& w) {
    // A ball may be so small beside its distance that it matters by how much the length of `w` isn't 1.
    const Imath::V3d to = Imath::V3d(ball.center) - Imath::V3d(origin), along(w);
    const double r2 = static_cast<double>(ball.radius) * ball.radius;
    return to.length2() <= r2 || (to.dot(along) > 0 && to.cross(along).length2() <= r2 * along.length2());
}

Ball ball_around(std::span<const Ball> balls) {
    Imath::Box3f box;
    for (const Ball& b : balls) {
        box.extendBy(b.center - Vec3(b.radius));
        box.extendBy(b.center + Vec3(b.radius));
    }
    return {box.center(), box.size().length() / 2};
}

struct BallTree::Embree {
    RTCDevice device;
    RTCScene scene = nullptr;
    std::span<const Ball> balls;
    Ball around; ///< them all
    std::atomic<std::int64_t> bytes{0};

    explicit Embree(std::span<const Ball> these)
        : device(rtcNewDevice(nullptr)), balls(these), around(ball_around(these)) {
        if (device == nullptr) throw std::runtime_error("Embree gave no device");
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
        scene = rtcNewScene(device);
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(balls.size()));
        rtcSetGeometryUserData(g, this);
        rtcSetGeometryBoundsFunction(g, bound, nullptr);
        rtcSetGeometryIntersectFunction(g, note);
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene, g);
        rtcReleaseGeometry(g);
        rtcCommitScene(scene);
    }
    ~Embree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    static void bound(const RTCBoundsFunctionArguments* args) {
        const Embree& self = *static_cast<const Embree*>(args->geometryUserPtr);
        const Ball& ball = self.balls[args->primID];
        const Vec3& c = ball.center;
        const float r = ball.radius + kMargin * (self.around.center.length() + self.around.radius);
        *args->bounds_o = {c.x - r, c.y - r, c.z - r, 0, c.x + r, c.y + r, c.z + r, 0};
    }
    /// Notes the ball, and lets the ray pass.
    static void note(const RTCIntersectFunctionNArguments* args) {
        const Query& query = *reinterpret_cast<const Query*>(args->context);
        if (args->valid[0] == 0) return;
        const Ball& ball = static_cast<const Embree*>(args->geometryUserPtr)->balls[args->primID];
        if (passes(ball, query.origin, query.w)) query.found->push_back(args->primID);
    }
};

BallTree::BallTree() = default;
BallTree::BallTree(std::vector<Ball> balls) : balls_(std::move(balls)) {
    if (!balls_.empty()) embree_ = std::make_unique<Embree>(balls_);
}
BallTree::~BallTree() = default;
BallTree::BallTree(BallTree&&) noexcept = default;
BallTree& BallTree::operator=(BallTree&&) noexcept = default;

std::span<const std::uint32_t> BallTree::along(const Vec3& origin, const Vec3& w) const {
    thread_local std::vector<std::uint32_t> found;
    found.clear();
    if (embree_ == nullptr) return found;
    Query query{{}, origin, w, &found};
    rtcInitIntersectContext(&query.context);
    // Floats that begin far away would let it miss small balls.
    const Ball& all = embree_->around;
    const Vec3 start = origin + w * std::max(0.0f, (all.center - origin).dot(w) - all.radius);
    RTCRayHit ray{};
    ray.ray = {start.x, start.y, start.z, 0, w.x, w.y, w.z, 0, std::numeric_limits<float>::infinity(), ~0u, 0, 0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->scene, &query.context, &ray);
    // The order of the search is Embree's own, and sums are to be the same in every run.
    std::ranges::sort(found);
    return found;
}

std::size_t BallTree::bytes() const {
    return balls_.capacity() * sizeof(Ball) + (embree_ ? static_cast<std::size_t>(embree_->bytes.load()) : 0);
}

} // namespace keyhole
