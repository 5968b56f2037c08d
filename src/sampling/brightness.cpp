#include "sampling/brightness.h"

#include "core/shared_work.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/proposals/mirrored_light_paths.h"
#include "scene/ray_counter.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace keyhole {
namespace {

constexpr std::int64_t kBlock = 64 * StageOne::kGroup;

/// All techniques of stage one: path tracing alone, or bidirectional tracing beside what finds what it misses, user
/// paths where there are some and light in flat mirrors, each by the balance heuristic.
class Techniques {
  public:
    Techniques(const Scene& scene, const StageOneSettings& settings)
        : scene_(scene), settings_(settings), guides_(settings.guides) {
        if (!scene.traits().delta) return;
        mirrors_.emplace(ProposalContext{&scene, settings.set, settings.max_scatterings});
        if (mirrors_->empty()) mirrors_.reset();
    }

    const StageOneSettings& settings() const { return settings_; }
    /// Whether path tracing is out of the question.
    bool need_light_paths() const;

    void trace_sample(Technique technique, std::int64_t i, auto& sink) const {
        Rng rng(settings_.seed, StreamPurpose::brightness, static_cast<std::uint64_t>(i));
        const Vec2 image = lattice_image_point(settings_.seed, StreamPurpose::brightness, i);
        const ConnectionRule wanted{settings_.max_scatterings, settings_.set};
        if (technique == Technique::path || (guides_ == nullptr && !mirrors_))
            return trace_independent(technique, scene_, image, wanted, rng, sink);
        BesideOthers<std::remove_reference_t<decltype(sink)>> rest{*this, sink};
        trace_independent(technique, scene_, image, wanted, rng, rest);
        const auto found = [&](const Path& path) {
            const double others = density(path);
            if (!(others > 0)) return; // rounding carried it out of cones or openings, or off a mirror
            sink.contribution(path.contribution / (others + bidirectional_density(path)), path.storage.kind,
                              [&]() -> const Path& { return path; });
        };
        if (guides_ != nullptr) guides_->sample(image, rng, found);
        if (!mirrors_) return;
        Failure why{};
        const auto mirrored = mirrors_->draw(rng, why);
        if (mirrored && mirrored->target > 0) found(*mirrored);
    }

  private:
    /// Takes from the contributions of bidirectional tracing what belongs to the others.
    template <class Sink> struct BesideOthers {
        const Techniques& techniques;
        Sink& sink;

        void contribution(const Rgb& value, PhotonKind kind, auto&& make_path) {
            const Path path = make_path();
            const double others = techniques.density(path);
            const double own = others > 0 ? bidirectional_density(path) : 1;
            sink.contribution(value * (own / (own + others)), kind, [&]() -> const Path& { return path; });
        }
    };

    /// Number density of a measured path among those that the others make.
    double density(const Path& path) const {
        return (guides_ != nullptr ? guides_->density(path) : 0) + (mirrors_ ? mirrors_->draw_density(path) : 0);
    }

    const Scene& scene_;
    const StageOneSettings& settings_;
    const GuidedPaths* guides_;
    std::optional<MirroredLightPaths> mirrors_;
};

/// What a contribution counts for. A connection to the lens may have led it to another pixel than its sample began at.
double target(const PathSet& set, const Rgb& value, auto&& make_path) {
    return set.weight == nullptr ? luminance(value) : set.target(value, make_path().image);
}

/// Adds up one sample.
struct EstimateSink {
    const PathSet& set;
    double sum = 0, caustic = 0;

    void contribution(const Rgb& value, PhotonKind kind, auto&& make_path) {
        const double found = target(set, value, make_path);
        sum += found;
        if (kind == PhotonKind::caustic) caustic += found;
    }
};

/// Adds up contributions until the running sum passes a mark, and keeps the path that did it.
struct SeedSink {
    const PathSet& set;
    double left; // of the mark
    std::optional<Path> found{};

    void contribution(const Rgb& value, PhotonKind, auto&& make_path) {
        if (left < 0 && found) return;
        left -= target(set, value, make_path);
        if (left >= 0 && found) return; // any path will do should rounding leave the mark unreached
        Path path = make_path();
        path.target = set.target(path.contribution, path.image);
        if (!(path.target > 0)) return;
        set.find_storage(path);
        found = path;
    }
};

struct Block {
    RunningStats brightness, caustic;
    std::vector<double> groups;

    auto parts() { return std::tie(brightness, caustic, groups); }
};

Block run_block(const Techniques& techniques, Technique technique, Range samples) {
    Block block;
    for (std::int64_t i = samples.begin; i < samples.end; ++i) {
        EstimateSink sink{techniques.settings().set};
        techniques.trace_sample(technique, i, sink);
        block.brightness.add(sink.sum);
        block.caustic.add(sink.caustic);
        if (i % StageOne::kGroup == 0) block.groups.push_back(0);
        block.groups.back() += sink.sum;
    }
    return block;
}

/// First sample of trials: they are not among those of B.
constexpr std::int64_t kTrial = std::int64_t{1} << 41;

struct Trial {
    RunningStats brightness;
    double rays; ///< for all of it
};

/// A trial of a technique takes no more than what follows.
Trial try_technique(const Techniques& techniques, Technique technique, const RunContext& context) {
    const std::int64_t blocks = std::clamp<std::int64_t>(techniques.settings().samples / kBlock / 2, 1, 16);
    const std::uint64_t rays = rays_traced();
    const auto parts = make_blocks({kTrial, kTrial + blocks * kBlock}, kBlock, context,
                                   [&](Range range) { return run_block(techniques, technique, range).brightness; });
    Trial trial{{}, static_cast<double>(rays_traced() - rays)};
    for (const RunningStats& part : parts) trial.brightness.merge(part);
    return trial;
}

bool Techniques::need_light_paths() const {
    // Who gives user paths says that light is hard to find, and so do mirrors. What these leave out a trial would see
    // too little of.
    if (guides_ != nullptr || mirrors_) return true;
    // Caustics of emitters that no ray can hit are found from the light alone; a trial couldn't know what it missed.
    const auto is_delta = [](const auto& emitter) { return emitter->is_delta(); };
    return scene_.traits().delta && std::any_of(scene_.emitters().begin(), scene_.emitters().end(), is_delta);
}

/// The technique that needs fewer rays for the same error, tried. Rays and not seconds, so that the choice is the same
/// on every machine; a connection costs about as much again as its ray.
Technique choose_technique(const Trial& path, const Trial& bidirectional) {
    // One that never meets a small lamp behind glass seems precise: it is the one that found less light. To take
    // bidirectional tracing in vain costs some rays, path tracing that misses a caustic costs the light.
    const double more = bidirectional.brightness.mean() - path.brightness.mean();
    const double error = std::hypot(path.brightness.standard_error(), bidirectional.brightness.standard_error());
    if (more > 2 * error) return Technique::bidirectional;
    if (-more > 4 * error) return Technique::path;
    const auto cost = [](const Trial& t, double connections) {
        // Nothing found is no reason to trust a technique.
        const double infinity = std::numeric_limits<double>::infinity();
        return (t.brightness.mean() > 0 ? t.brightness.variance() : infinity) * t.rays * connections;
    };
    return cost(path, 1) <= cost(bidirectional, 2) ? Technique::path : Technique::bidirectional;
}

/// Samples that should bring B to the error asked for, by a trial of the technique.
std::int64_t enough_samples(const StageOneSettings& settings, const RunningStats& trial) {
    if (!(settings.error > 0 && trial.mean() > 0)) return settings.samples;
    const double samples = trial.variance() / (trial.mean() * trial.mean()) / (settings.error * settings.error);
    const auto most = static_cast<double>(settings.samples) * static_cast<double>(StageOne::kMostTimes);
    return std::max(settings.samples, static_cast<std::int64_t>(std::min(samples, most)));
}

double sum(const std::vector<double>& of, Range some) {
    double total = 0;
    for (std::int64_t i = some.begin; i < some.end; ++i) total += of[static_cast<std::size_t>(i)];
    return total;
}

} // namespace

double StageOne::brightness_of(Range some) const {
    const std::int64_t count = std::min(samples, some.end * kGroup) - some.begin * kGroup;
    return count > 0 ? sum(groups, some) / static_cast<double>(count) : 0.0;
}

StageOne run_stage_one(const Scene& scene, const StageOneSettings& settings, const RunContext& context) {
    const Techniques techniques(scene, settings);
    StageOne stage;
    stage.technique = Technique::bidirectional;
    stage.wanted = settings.samples;
    const bool choice = !techniques.need_light_paths();
    Trial bidirectional{};
    if (choice || settings.error > 0) { // else there is nothing to find out
        bidirectional = try_technique(techniques, Technique::bidirectional, context);
        stage.wanted = enough_samples(settings, bidirectional.brightness);
    }
    if (choice) {
        const Trial path = try_technique(techniques, Technique::path, context);
        stage.technique = choose_technique(path, bidirectional);
        if (stage.technique == Technique::path) stage.wanted = enough_samples(settings, path.brightness);
    }
    const Technique technique = stage.technique;
    const ProgressStage progress(context, "brightness", stage.wanted, "paths");
    leading_blocks(
        stage.wanted, kBlock, context, [&](Range range) { return run_block(techniques, technique, range); },
        [&](const Block& block) {
            stage.brightness.merge(block.brightness);
            stage.caustic.merge(block.caustic);
            stage.groups.insert(stage.groups.end(), block.groups.begin(), block.groups.end());
        });
    stage.samples = static_cast<std::int64_t>(stage.brightness.count());
    return stage;
}

std::vector<Path> choose_seeds(const Scene& scene, const StageOneSettings& settings, const StageOne& stage,
                               Range groups, std::int64_t count) {
    const double total = sum(stage.groups, groups);
    if (!(total > 0)) return {};

    // Systematic resampling: one mark in each of `count` equal parts of the running sum.
    struct Mark {
        std::int64_t group;
        double left;
    };
    std::vector<Mark> marks;
    const double shift =
        Rng(settings.seed, StreamPurpose::seed_choice, static_cast<std::uint64_t>(groups.begin)).next();
    double before = 0;
    for (std::int64_t g = groups.begin; g < groups.end; ++g) {
        const double here = stage.groups[static_cast<std::size_t>(g)];
        while (static_cast<std::int64_t>(marks.size()) < count) {
            const double mark = (static_cast<double>(marks.size()) + shift) / static_cast<double>(count) * total;
            if (mark >= before + here) break;
            marks.push_back({g, mark - before});
        }
        before += here;
    }

    const Techniques techniques(scene, settings);
    std::vector<std::optional<Path>> found(marks.size());
    parallel_for(static_cast<std::int64_t>(marks.size()), [&](std::int64_t k) {
        const Mark& mark = marks[static_cast<std::size_t>(k)];
        SeedSink sink{settings.set, mark.left};
        const std::int64_t end = std::min(stage.samples, (mark.group + 1) * StageOne::kGroup);
        for (std::int64_t i = mark.group * StageOne::kGroup; i < end && sink.left >= 0; ++i)
            techniques.trace_sample(stage.technique, i, sink);
        found[static_cast<std::size_t>(k)] = std::move(sink.found);
    });
    std::vector<Path> seeds;
    for (auto& path : found)
        if (path) seeds.push_back(std::move(*path));
    return seeds;
}

} // namespace keyhole
