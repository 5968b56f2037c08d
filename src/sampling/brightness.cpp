#include "sampling/brightness.h"

#include "core/parallel.h"
#include "sampling/path_tracer.h"

#include <algorithm>

namespace keyhole {
namespace {

constexpr std::int64_t kBlock = 64 * StageOne::kGroup;

bool in_set(LightClass light, PathSet set) {
    return set == PathSet::all || light == LightClass::caustic || light == LightClass::indirect;
}

/// Image point of sample i: a rank-1 lattice (Roberts' R2), shifted by the seed, covers the window evenly at any count.
Vec2 image_point(std::uint64_t seed, std::int64_t i) {
    Rng shift(seed, StreamPurpose::brightness, ~0ULL);
    const auto k = static_cast<double>(i);
    const double x = shift.next() + k * 0.7548776662466927, y = shift.next() + k * 0.5698402909980532;
    return {std::min(static_cast<float>(x - std::floor(x)), 0x1.fffffep-1f),
            std::min(static_cast<float>(y - std::floor(y)), 0x1.fffffep-1f)};
}

void trace_sample(const Scene& scene, const StageOneSettings& settings, std::int64_t i, auto& sink) {
    Rng rng(settings.seed, StreamPurpose::brightness, static_cast<std::uint64_t>(i));
    sink.image = image_point(settings.seed, i);
    trace_path(scene, sink.image, settings.max_scatterings, rng, sink);
}

/// Adds up one sample and keeps its importons.
struct EstimateSink {
    PathSet set;
    bool keep_importons;
    Vec2 image{};
    double sum = 0, caustic = 0;
    std::vector<Importon> first{}, second{};

    bool arrival(const EyeWalk& walk, const Rgb& throughput, int finite) {
        const Vertex& v = walk.back();
        if (keep_importons && finite < 2 && v.bsdf.traits().finite) {
            const Vec3 to_eye = direction(v.point, walk[walk.size() - 2].point);
            (finite == 0 ? first : second).push_back({v.point, to_eye, throughput});
        }
        return true;
    }
    void contribution(const EyeWalk&, const Vertex&, const Rgb& value, LightClass light) {
        if (in_set(light, set)) sum += luminance(value);
        if (light == LightClass::caustic) caustic += luminance(value);
    }
};

/// Traces samples again until the running sum of their contributions passes a mark, and keeps the path that did it.
struct SeedSink {
    const Scene& scene;
    PathSet set;
    double left; // of the mark
    Vec2 image{};
    std::optional<Path> found{};

    bool arrival(const EyeWalk&, const Rgb&, int) const { return left >= 0 || !found; }
    void contribution(const EyeWalk& walk, const Vertex& x0, const Rgb& value, LightClass light) {
        const double y = luminance(value);
        if (!in_set(light, set) || !(y > 0) || (left < 0 && found)) return;
        left -= y;
        Path path = complete_path(scene, walk, x0, image);
        path.target = luminance(path.contribution);
        if (path.target > 0) found = path;
    }
};

struct Block {
    RunningStats brightness, caustic;
    std::vector<Importon> first, second;
    std::vector<double> groups;
};

Block run_block(const Scene& scene, const StageOneSettings& settings, Range samples, std::int64_t importon_stride) {
    Block block;
    EstimateSink sink{settings.set, false};
    for (std::int64_t i = samples.begin; i < samples.end; ++i) {
        sink.sum = sink.caustic = 0;
        sink.keep_importons = importon_stride > 0 && i % importon_stride == 0;
        trace_sample(scene, settings, i, sink);
        block.brightness.add(sink.sum);
        block.caustic.add(sink.caustic);
        if (i % StageOne::kGroup == 0) block.groups.push_back(0);
        block.groups.back() += sink.sum;
    }
    block.first = std::move(sink.first);
    block.second = std::move(sink.second);
    return block;
}

void append(std::vector<Importon>& to, const std::vector<Importon>& from) { to.insert(to.end(), from.begin(), from.end()); }

} // namespace

StageOne run_stage_one(const Scene& scene, const StageOneSettings& settings, const RunContext& context) {
    const std::int64_t blocks = (settings.samples + kBlock - 1) / kBlock;
    const std::int64_t stride = settings.importons > 0 ? std::max<std::int64_t>(1, settings.samples / settings.importons) : 0;
    std::vector<std::optional<Block>> done(static_cast<std::size_t>(blocks));
    context.begin("brightness", static_cast<std::uint64_t>(settings.samples), "paths");
    parallel_for(blocks, [&](std::int64_t b) {
        if (context.stopped()) return;
        const Range range{b * kBlock, std::min(settings.samples, (b + 1) * kBlock)};
        done[static_cast<std::size_t>(b)] = run_block(scene, settings, range, stride);
        context.advance(static_cast<std::uint64_t>(range.size()));
    });
    context.end();

    StageOne stage;
    for (auto& block : done) {
        if (!block) break; // after a stop, the leading blocks are a valid smaller run
        stage.brightness.merge(block->brightness);
        stage.caustic.merge(block->caustic);
        append(stage.first, block->first);
        append(stage.second, block->second);
        stage.groups.insert(stage.groups.end(), block->groups.begin(), block->groups.end());
        block.reset();
    }
    stage.samples = static_cast<std::int64_t>(stage.brightness.count());
    stage.importon_samples = stride > 0 ? (stage.samples + stride - 1) / stride : 0;
    return stage;
}

std::vector<Path> choose_seeds(const Scene& scene, const StageOneSettings& settings, const StageOne& stage,
                               std::int64_t count) {
    double total = 0;
    for (const double g : stage.groups) total += g;
    if (!(total > 0)) return {};

    // Systematic resampling: one mark in each of `count` equal parts of the running sum.
    struct Mark {
        std::int64_t group;
        double left;
    };
    std::vector<Mark> marks;
    const double shift = Rng(settings.seed, StreamPurpose::seed_choice, 0).next();
    double before = 0;
    for (std::size_t g = 0; g < stage.groups.size(); ++g) {
        while (static_cast<std::int64_t>(marks.size()) < count) {
            const double mark = (static_cast<double>(marks.size()) + shift) / static_cast<double>(count) * total;
            if (mark >= before + stage.groups[g]) break;
            marks.push_back({static_cast<std::int64_t>(g), mark - before});
        }
        before += stage.groups[g];
    }

    std::vector<std::optional<Path>> found(marks.size());
    parallel_for(static_cast<std::int64_t>(marks.size()), [&](std::int64_t k) {
        const Mark& mark = marks[static_cast<std::size_t>(k)];
        SeedSink sink{scene, settings.set, mark.left};
        const std::int64_t end = std::min(stage.samples, (mark.group + 1) * StageOne::kGroup);
        for (std::int64_t i = mark.group * StageOne::kGroup; i < end && sink.left >= 0; ++i)
            trace_sample(scene, settings, i, sink);
        found[static_cast<std::size_t>(k)] = std::move(sink.found);
    });
    std::vector<Path> seeds;
    for (auto& path : found)
        if (path) seeds.push_back(std::move(*path));
    return seeds;
}

} // namespace keyhole
