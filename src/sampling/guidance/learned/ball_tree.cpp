#include "sampling/guidance/learned/ball_tree.h"

#include "core/embree_device.h"

#include <Imath/ImathBox.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>

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
    /// Balls of a kind.
    struct Part {
        const Embree* whole;
        std::uint32_t kind;
        std::vector<std::uint32_t> members;
        RTCScene scene;
    };

    RTCDevice device;
    std::span<const Ball> balls;
    Ball around;             ///< them all
    std::vector<Part> parts; ///< by kind; they don't move once they are built
    std::atomic<std::int64_t> bytes{0};

    Embree(std::span<const Ball> these, std::span<const std::uint32_t> kinds)
        : device(new_device(nullptr)), balls(these), around(ball_around(these)) {
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
        std::map<std::uint32_t, std::vector<std::uint32_t>> members;
        for (std::uint32_t i = 0; i < balls.size(); ++i) members[kinds.empty() ? 0 : kinds[i]].push_back(i);
        for (auto& [kind, of] : members) parts.push_back({this, kind, std::move(of), rtcNewScene(device)});
        for (Part& part : parts) build(part);
    }
    ~Embree() {
        for (const Part& part : parts) rtcReleaseScene(part.scene);
        rtcReleaseDevice(device);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    const Part* part_of(std::uint32_t kind) const {
        const auto at = std::ranges::lower_bound(parts, kind, {}, &Part::kind);
        return at != parts.end() && at->kind == kind ? &*at : nullptr;
    }

  private:
    void build(Part& part) const {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(part.members.size()));
        rtcSetGeometryUserData(g, &part);
        rtcSetGeometryBoundsFunction(g, bound, nullptr);
        rtcSetGeometryIntersectFunction(g, note);
        rtcCommitGeometry(g);
        rtcAttachGeometry(part.scene, g);
        rtcReleaseGeometry(g);
        rtcCommitScene(part.scene);
    }
    static void bound(const RTCBoundsFunctionArguments* args) {
        const Part& part = *static_cast<const Part*>(args->geometryUserPtr);
        const Ball &ball = part.whole->balls[part.members[args->primID]], &all = part.whole->around;
        const Vec3& c = ball.center;
        const float r = ball.radius + kMargin * (all.center.length() + all.radius);
        *args->bounds_o = {c.x - r, c.y - r, c.z - r, 0, c.x + r, c.y + r, c.z + r, 0};
    }
    /// Notes the ball, and lets the ray pass.
    static void note(const RTCIntersectFunctionNArguments* args) {
        const Query& query = *reinterpret_cast<const Query*>(args->context);
        if (args->valid[0] == 0) return;
        const Part& part = *static_cast<const Part*>(args->geometryUserPtr);
        const std::uint32_t ball = part.members[args->primID];
        if (passes(part.whole->balls[ball], query.origin, query.w)) query.found->push_back(ball);
    }
};

BallTree::BallTree() = default;
BallTree::BallTree(std::vector<Ball> balls, std::span<const std::uint32_t> kinds) : balls_(std::move(balls)) {
    if (!balls_.empty()) embree_ = std::make_unique<Embree>(balls_, kinds);
}
BallTree::~BallTree() = default;
BallTree::BallTree(BallTree&&) noexcept = default;
BallTree& BallTree::operator=(BallTree&&) noexcept = default;

std::span<const std::uint32_t> BallTree::along(const Vec3& origin, const Vec3& w, std::uint32_t kind) const {
    thread_local std::vector<std::uint32_t> found;
    found.clear();
    const Embree::Part* part = embree_ ? embree_->part_of(kind) : nullptr;
    if (part == nullptr) return found;
    Query query{{}, origin, w, &found};
    rtcInitIntersectContext(&query.context);
    // Floats that begin far away would let it miss small balls.
    const Ball& all = embree_->around;
    const Vec3 start = origin + w * std::max(0.0f, (all.center - origin).dot(w) - all.radius);
    RTCRayHit ray{};
    ray.ray = {start.x, start.y, start.z, 0, w.x, w.y, w.z, 0, std::numeric_limits<float>::infinity(), ~0u, 0, 0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(part->scene, &query.context, &ray);
    // The order of the search is Embree's own, and sums are to be the same in every run.
    std::ranges::sort(found);
    return found;
}

std::size_t BallTree::bytes() const {
    return balls_.capacity() * sizeof(Ball) + (embree_ ? static_cast<std::size_t>(embree_->bytes.load()) : 0);
}

} // namespace keyhole
