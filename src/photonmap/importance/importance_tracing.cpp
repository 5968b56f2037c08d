#include "photonmap/importance/importance_tracing.h"

#include "core/shared_work.h"
#include "sampling/paths/eye_path_head.h"
#include "sampling/paths/image_lattice.h"

#include <algorithm>

namespace keyhole {
namespace {

/// The importons of one eye path.
void trace_importons(const Scene& scene, const Vec2& image, const ImportanceTracing& options, SampleSource& source,
                     Importons& out) {
    const double weight = options.weight != nullptr ? (*options.weight)(image) : 1.0;
    const double share = weight / static_cast<double>(options.samples);
    trace_eye_path_head(scene, image, options.max_scatterings, source,
                        [&](const Vertex& v, const Vec3& to_eye, const Rgb& throughput, const EyePast& past) {
                            if (past.finite == 1 || options.at_d1)
                                (past.finite == 0 ? out.first : out.second)
                                    .emplace_back(v.point.p, v.point.ng, to_eye, throughput * share,
                                                  PhotonPast{.caustic = past.specular > 0, .spare = past.specular});
                        });
}

void append(std::vector<Photon>& from, std::vector<Photon>& to) {
    to.insert(to.end(), from.begin(), from.end());
    from.clear();
}

} // namespace

Importons trace_importance(const Scene& scene, const ImportanceTracing& options, const RunContext& context) {
    constexpr std::int64_t kBlock = 512, kBlocks = 64;
    std::vector<Importons> parts(kBlocks);
    Importons all;
    // A vertex with a finite and a specular part may leave several importons at its image's path: rare enough for the
    // vectors to grow then.
    all.second.reserve(static_cast<std::size_t>(options.samples));
    if (options.at_d1) all.first.reserve(static_cast<std::size_t>(options.samples));
    const ProgressStage progress(context, "importance", options.samples, "paths");
    for (std::int64_t begin = 0; begin < options.samples; begin += kBlock * kBlocks) {
        shared_for(parts, context, [&](std::int64_t b) {
            check_stop(context);
            const std::int64_t first = begin + b * kBlock, end = std::min(options.samples, first + kBlock);
            for (std::int64_t i = first; i < end; ++i) {
                Rng rng(options.seed, StreamPurpose::importance, static_cast<std::uint64_t>(i));
                trace_importons(scene, lattice_image_point(options.seed, StreamPurpose::importance, i), options, rng,
                                parts[static_cast<std::size_t>(b)]);
            }
        });
        for (Importons& part : parts) {
            append(part.first, all.first);
            append(part.second, all.second);
        }
        context.advance(std::min(kBlock * kBlocks, options.samples - begin));
    }
    return all;
}

} // namespace keyhole
