#include "methods/learned_direct_light_scope.h"

#include "core/kronecker.h"
#include "core/shared_work.h"
#include "film/image_error.h"
#include "methods/method.h"
#include "methods/pixel_sink.h"
#include "sampling/guidance/learned/look_for_direct_light.h"
#include "sampling/paths/direct_light.h"
#include "scene/ray_counter.h"
#include "session/stage_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace keyhole {
namespace {

constexpr std::int64_t kPlaces = 256; // of the picture
constexpr std::int64_t kSamples = 8;  // of each of two halves, as a pixel has them
/// Renders shorter than this [s], or with fewer samples, have no time for a trial.
constexpr double kLeastSeconds = 4, kLeastSamples = 32.0 * 4 * kSamples * kPlaces;
/// Of the time that is left, at most: what takes longer isn't worth knowing.
constexpr double kMostTime = 0.05;
/// What noise and work together have to come down to. The trial is a small one.
constexpr double kPays = 0.75;
/// Of places, those with the largest noise, which are left out: seldom samples of what is bright.
constexpr double kTrimmed = 0.03;
/// What a path costs besides its rays, in what it costs by rays.
constexpr double kBesidesRays = 1;

bool is_too_short(const Settings& settings, const ImageWindow& window, const RunContext& context) {
    const double left = context.seconds_left();
    if (std::isfinite(left)) return left < kLeastSeconds;
    return window.size() * static_cast<double>(settings.spp) < kLeastSamples;
}

/// Puts the scene's way of taking emitters back.
class Restore {
  public:
    explicit Restore(Scene& scene) : scene_(scene), before_(scene.takes_each_emitter()) {}
    ~Restore() { scene_.set_takes_each_emitter(before_); }
    Restore(const Restore&) = delete;
    Restore& operator=(const Restore&) = delete;

  private:
    Scene& scene_;
    bool before_;
};

struct Trial {
    std::array<std::vector<double>, 2> halves; ///< luminance of places
    double rays = 0;
};

Trial try_emitters(Scene& scene, const Settings& settings, bool each, const RunContext& context) {
    scene.set_takes_each_emitter(each);
    Trial trial;
    for (auto& half : trial.halves) half.assign(static_cast<std::size_t>(kPlaces), 0);
    const ImageWindow& window = scene.camera().window();
    const auto depth = static_cast<int>(settings.max_depth);
    const std::uint64_t before = rays_traced();
    parallel_blocks(2 * kPlaces, 16, context, [&](std::int64_t i) {
        const std::int64_t number = i / 2;
        const auto place = static_cast<double>(number);
        const Vec2 pixel(static_cast<float>(window.width * kronecker(0.5, place, kR2[0])),
                         static_cast<float>(window.height * kronecker(0.5, place, kR2[1])));
        const auto stream = static_cast<std::uint64_t>(i);
        double sum = 0;
        for (std::uint64_t n = 0; n < static_cast<std::uint64_t>(kSamples); ++n) {
            LatticeSource source(
                Rng(settings.seed, StreamPurpose::each_emitter, stream), n,
                Rng(settings.seed, StreamPurpose::each_emitter, ~(static_cast<std::uint64_t>(kSamples) * stream + n)));
            source.take<2>(); // the place in a pixel
            PixelSink sink{};
            trace_path(scene, window.to_window(pixel), depth, source, sink);
            const double l = luminance(sink.pixel.direct + sink.pixel.indirect + sink.pixel.caustic);
            if (std::isfinite(l)) sum += l / static_cast<double>(kSamples);
        }
        trial.halves[static_cast<std::size_t>(i % 2)][static_cast<std::size_t>(number)] = sum;
    });
    trial.rays = static_cast<double>(rays_traced() - before);
    return trial;
}

/// Of places, relative to their `picture`, whose mean is `typical`; the sum of most.
double noise(const Trial& trial, const std::vector<double>& picture, double typical) {
    std::vector<double> squares;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const double difference = trial.halves[0][i] - trial.halves[1][i];
        squares.push_back(difference * difference / error_unit(picture[i], typical));
    }
    std::ranges::sort(squares);
    const auto most = static_cast<std::ptrdiff_t>((1 - kTrimmed) * static_cast<double>(squares.size()));
    return std::accumulate(squares.begin(), squares.begin() + most, 0.0);
}

constexpr Stage kLearning{"direct light, learned"};

/// Of the time, and of the samples of pixels where there is no limit to the time.
constexpr double kTimeShare = 0.04, kSampleShare = 1.0 / 16;
/// Paths at most, and fewer than which are not worth their while.
constexpr std::int64_t kMostPaths = std::int64_t{1} << 18, kLeastPaths = 1024;
/// What is learned may take this share of the memory for photons.
constexpr std::int64_t kMemoryShare = 10;

DirectLightLearning learning(const Settings& settings, const ImageWindow& window, const RunContext& context) {
    DirectLightLearning l{.paths = kMostPaths,
                          .max_scatterings = static_cast<int>(settings.max_depth),
                          .seed = settings.seed,
                          .most_bytes = static_cast<std::size_t>(settings.photon_memory / kMemoryShare)};
    const double left = context.seconds_left();
    if (std::isfinite(left)) {
        l.seconds = kTimeShare * left;
    } else {
        const double samples = window.size() * static_cast<double>(settings.spp) *
                               static_cast<double>(std::max<std::int64_t>(1, settings.passes));
        l.paths = static_cast<std::int64_t>(std::min(static_cast<double>(kMostPaths), kSampleShare * samples));
        if (l.paths < kLeastPaths) l.paths = 0;
    }
    return l;
}

} // namespace

bool each_emitter_pays(Scene& scene, const Settings& settings, const RunContext& context) {
    if (!has_few_emitters(scene) || is_too_short(settings, scene.camera().window(), context)) return false;
    const Restore restore(scene);
    const RunContext limited = context.with_reserve(1 - kMostTime);
    Trial one, each;
    try {
        one = try_emitters(scene, settings, false, limited);
        each = try_emitters(scene, settings, true, limited);
    } catch (const Interrupted&) {
        check_stop(context);
        return false;
    }
    std::vector<double> picture(static_cast<std::size_t>(kPlaces), 0);
    for (const Trial* trial : {&one, &each})
        for (const auto& half : trial->halves)
            std::ranges::transform(picture, half, picture.begin(), [](double sum, double l) { return sum + l / 4; });
    const double typical = std::accumulate(picture.begin(), picture.end(), 0.0) / static_cast<double>(kPlaces);
    if (!(typical > 0)) return false;
    const double work = (kBesidesRays + each.rays / one.rays) / (kBesidesRays + 1);
    return work * noise(each, picture, typical) < kPays * noise(one, picture, typical);
}

LearnedDirectLightScope::LearnedDirectLightScope(Scene& scene) : scene_(scene) {
    scene.set_direct_light(nullptr);
    scene.set_takes_each_emitter(false);
}

LearnedDirectLightScope::LearnedDirectLightScope(Scene& scene, const Settings& settings, const RunContext& context)
    : LearnedDirectLightScope(scene) {
    // Methods with photon maps trace no such paths; what `auto` stands for may.
    const bool traces_paths = settings.method == &methods::automatic || !settings.method->keeps_photons;
    const bool may_take_each = traces_paths && has_few_emitters(scene);
    if (!settings.method->asks_for_direct_light || !(may_take_each || has_choice_of_direct_light(scene))) return;
    const StageClock clock(own_, kLearning);
    learn(settings, context);
    if (!may_take_each || !each_emitter_pays(scene, settings, context)) return;
    scene.set_takes_each_emitter(true);
    own_.remarks.emplace_back("direct light: paths have a sample of each emitter at what is seen first");
}

void LearnedDirectLightScope::learn(const Settings& settings, const RunContext& context) {
    if (!has_choice_of_direct_light(scene_)) return;
    learned_ = learn_direct_light(scene_, learning(settings, scene_.camera().window(), context), context);
    if (!learned_) return;
    own_.values["direct_light_second_moment"] = learned_->second_moment_ratio();
    own_.values["direct_light_bytes"] = static_cast<double>(learned_->bytes());
    own_.remarks.push_back(fmt::format("direct light: learned in {} cells, {:.2g} times fewer shadow rays for the same "
                                       "second moment",
                                       learned_->cells(), 1 / learned_->second_moment_ratio()));
    scene_.set_direct_light(learned_);
}

} // namespace keyhole
