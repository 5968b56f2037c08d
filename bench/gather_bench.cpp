// How well stage three uses its rays: renders a scene, records every ray that stage three gives to Embree, and traces
// the same rays in the same order alone.
//
// usage: gather_bench SCENE [KEY=VALUE ...]      on one thread
#include "core/parallel.h"
#include "methods/render.h"
#include "scene/load/load.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

// The linker sends the library's calls here (--wrap), so that it needs no hook for this.
extern "C" {
void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);
void __wrap_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __wrap_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);
}

namespace {

struct RecordedRay {
    Imath::V3f origin, direction;
    float nearest, farthest;
    bool shadow;
};

bool g_recording = false;
RTCScene g_scene = nullptr;
std::vector<RecordedRay> g_rays;

void record(RTCScene scene, const RTCRay& r, bool shadow) {
    if (!g_recording) return;
    g_scene = scene;
    g_rays.push_back({{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tnear, r.tfar, shadow});
}

/// Records during the parts of stage three, the first of which is called "irradiance".
class StageWatcher final : public keyhole::Progress {
  public:
    explicit StageWatcher(bool record) : record_(record) {}
    void begin(std::string_view stage, std::uint64_t, std::string_view) override {
        if (stage == "irradiance") g_recording = record_;
    }
    void advance(std::uint64_t) override {}
    void end() override {}

  private:
    bool record_;
};

/// CPU seconds of stage three.
double render_once(keyhole::Scene& scene, const keyhole::Settings& settings, bool record) {
    StageWatcher watcher(record);
    const auto result = keyhole::render(scene, settings, {nullptr, &watcher});
    g_recording = false;
    double seconds = 0;
    for (const auto& stage : result.stats.stages)
        if (stage.stage->work == keyhole::Stage::Work::gather) seconds += stage.cpu_seconds;
    return seconds;
}

/// Seconds that Embree takes for the recorded rays.
double replay() {
    const std::clock_t start = std::clock();
    RTCIntersectContext context;
    for (const RecordedRay& r : g_rays) {
        RTCRayHit query{};
        query.ray = {r.origin.x, r.origin.y, r.origin.z, r.nearest, r.direction.x, r.direction.y, r.direction.z, 0,
                     r.farthest, ~0u,        0,          0};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcInitIntersectContext(&context);
        if (r.shadow)
            __real_rtcOccluded1(g_scene, &context, &query.ray);
        else
            __real_rtcIntersect1(g_scene, &context, &query);
    }
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

} // namespace

void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* query) {
    record(scene, query->ray, false);
    __real_rtcIntersect1(scene, context, query);
}

void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
    record(scene, *ray, true);
    __real_rtcOccluded1(scene, context, ray);
}

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: gather_bench SCENE [KEY=VALUE ...]\n");
        return 2;
    }
    keyhole::LoadedScene loaded = keyhole::load(argv[1], {argv + 2, argv + argc});
    keyhole::with_threads(1, [&] {
        keyhole::Scene scene(std::move(loaded.description));
        render_once(scene, loaded.settings, true);
        const double stage = render_once(scene, loaded.settings, false), bare = replay();
        const auto rays = static_cast<double>(g_rays.size());
        const auto shadow = std::count_if(g_rays.begin(), g_rays.end(), [](const auto& r) { return r.shadow; });
        fmt::print("{:.2f} M rays, {:.0f} % of them shadow rays; stage three {:.2f} s, {:.2f} Mray/s; Embree alone "
                   "{:.2f} s, {:.2f} Mray/s: {:.0f} %\n",
                   rays / 1e6, 100 * static_cast<double>(shadow) / rays, stage, rays / stage / 1e6, bare,
                   rays / bare / 1e6, 100 * bare / stage);
    });
}
