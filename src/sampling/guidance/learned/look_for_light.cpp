#include "sampling/guidance/learned/look_for_light.h"

#include "core/shared_work.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/independent_paths.h"
#include "sampling/paths/measure.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace keyhole {
namespace {

/// Light that `v` scatters from the vertex before it to the one behind it; none where that is a choice without a
/// density, or one among such.
std::optional<SeenScattering> scattering_at(const Path& path, int i, double weight) {
    const Vertex& v = path.x[i];
    if (v.specular() || v.bsdf.traits().delta) return std::nullopt;
    const Vec3 to_light = direction(v.point, path.x[i - 1].point), towards = direction(v.point, path.x[i + 1].point);
    const double pdf = scatter(v.point, v.bsdf, Event::finite, to_light, towards).pdf_to_eye;
    if (!(pdf > 0)) return std::nullopt;
    return SeenScattering{{v.point.p, facing(v.point.ng, to_light)}, towards, pdf, weight};
}

/// Keeps what paths from the eye met whose light is for photon maps.
struct Eye {
    FoundLightPaths& found;
    SampleSource& source;

    template <class MakePath> void contribution(const Rgb& value, PhotonKind kind, const MakePath& make_path) {
        const double y = luminance(value);
        if (kind == PhotonKind::none || !(y > 0) || !std::isfinite(y)) return;
        const Path path = make_path();
        const SurfacePoint &x0 = path.x[0].point, &x1 = path.x[1].point;
        const Vec3 towards = direction(x1, x0);
        found.ends.push_back({x0.emitter, {x1.p, facing(x1.ng, towards)}, towards, y});
        // Any of the vertices before that which stores; all together would fill the memory with what is alike.
        const int before = storage_point(diffuse_vertices(path), kind).vertex - 1;
        if (before < 1) return;
        const auto i = 1 + std::min(static_cast<int>(source.next() * before), before - 1);
        if (const auto seen = scattering_at(path, i, y * before)) found.scatterings.push_back(*seen);
    }
};

} // namespace

FoundLightPaths look_for_light(const Scene& scene, const LightSearch& search, const RunContext& context) {
    constexpr std::int64_t kBlock = 256;
    const auto blocks = static_cast<std::size_t>((search.paths + kBlock - 1) / kBlock);
    const std::size_t most =
        search.most_bytes / (sizeof(SeenLight) + sizeof(SeenScattering)) / std::max<std::size_t>(blocks, 1);
    const ProgressStage progress(context, "emission", search.paths, "paths");
    const auto look = [&](Range paths) {
        FoundLightPaths found;
        for (std::int64_t i = paths.begin; i < paths.end && found.ends.size() < most; ++i) {
            Rng rng(search.seed, StreamPurpose::learned_emission, static_cast<std::uint64_t>(i));
            Eye eye{found, rng};
            const Vec2 image = lattice_image_point(search.seed, StreamPurpose::learned_emission, i);
            trace_independent(Technique::path, scene, image, {search.max_scatterings, search.set}, rng, eye);
        }
        context.advance(paths.size());
        return found;
    };
    FoundLightPaths all;
    for (const FoundLightPaths& part : make_blocks({0, search.paths}, kBlock, context, look)) {
        all.ends.insert(all.ends.end(), part.ends.begin(), part.ends.end());
        all.scatterings.insert(all.scatterings.end(), part.scatterings.begin(), part.scatterings.end());
    }
    return all;
}

} // namespace keyhole
