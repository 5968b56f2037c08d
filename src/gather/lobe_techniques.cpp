#include "gather/lobe_techniques.h"

#include "core/shared_work.h"
#include "gather/visible_point.h"
#include "sampling/paths/image_lattice.h"

#include <optional>

namespace keyhole {
namespace {

/// Rays that look for lobes; no more than so many for a pixel, for small pictures, which methods are chosen by, would
/// spend most of their time on it.
constexpr std::int64_t kRays = 16'384;
constexpr double kRaysOfPixel = 8;
/// Lobes of a shape that are measured, at least and at most: what is small is met seldom, but rays may be aimed at it
/// later.
constexpr int kLeastLobes = 8, kMostLobes = 32;
constexpr std::int64_t kBlock = 64;
/// Samples that share the error of a photon: it lights all pixels around, while each of their samples sends rays of its
/// own, whose errors average out.
constexpr double kSamplesOfPhoton = 64;

/// Where a gather ray ends on a surface without a diffuse part.
struct End {
    Vertex v;
    Vec3 back; // unit
    int scatterings;
};

/// Looked for by rays that are told apart by their numbers: one that ends on what is to be measured is sent again.
class Search {
  public:
    Search(const GatherRays& rays, std::uint64_t seed) : rays_(rays), seed_(seed) {}

    Rng stream(std::int64_t ray) const {
        return {seed_, StreamPurpose::lobe_techniques, static_cast<std::uint64_t>(ray)};
    }

    std::optional<End> end(std::int64_t ray, Rng& rng) const {
        const Vec2 image = lattice_image_point(seed_, StreamPurpose::lobe_techniques, ray);
        const auto first = first_gather_ray(rays_, image, rng);
        if (!first) return std::nullopt;
        const auto point = rays_.scene().trace(first->from.vertex.point, first->w);
        if (!point || point->site != Site::surface) return std::nullopt;
        End end{make_vertex(*point), -first->w, first->from.scatterings};
        const BsdfTraits traits = end.v.bsdf.traits();
        return traits.glossy && !traits.diffuse ? std::optional(end) : std::nullopt;
    }

  private:
    const GatherRays& rays_;
    std::uint64_t seed_;
};

/// Of the rays that met each shape, the first ones.
std::vector<std::int64_t> choose(const std::vector<std::uint32_t>& met, std::size_t shapes) {
    std::vector<int> lobes(shapes);
    std::vector<std::int64_t> chosen;
    for (std::size_t i = 0; i < met.size(); ++i)
        if (met[i] != SurfacePoint::kNone && lobes[met[i]]++ < kMostLobes)
            chosen.push_back(static_cast<std::int64_t>(i));
    return chosen;
}

} // namespace

LobeTechniques::LobeTechniques(const GatherRays& rays, std::uint64_t seed, const RunContext& context) {
    const Search search(rays, seed);
    const auto of_pixels = static_cast<std::int64_t>(kRaysOfPixel * rays.scene().camera().window().size());
    std::vector<std::uint32_t> met(static_cast<std::size_t>(std::min(kRays, of_pixels)), SurfacePoint::kNone);
    parallel_blocks(std::ssize(met), kBlock, context, [&](std::int64_t i) {
        Rng rng = search.stream(i);
        if (const auto end = search.end(i, rng)) met[static_cast<std::size_t>(i)] = end->v.point.shape;
    });

    const std::size_t shapes = rays.scene().shapes().size();
    const auto chosen = choose(met, shapes);
    std::vector<std::optional<LobeNoise>> noise(chosen.size());
    parallel_blocks(static_cast<std::int64_t>(chosen.size()), kBlock, context, [&](std::int64_t i) {
        const std::int64_t ray = chosen[static_cast<std::size_t>(i)];
        Rng rng = search.stream(ray);
        const auto end = search.end(ray, rng);
        noise[static_cast<std::size_t>(i)] = rays.lobe_noise(end->v, end->back, end->scatterings, rng);
    });

    struct Sum {
        int lobes = 0;
        LobeNoise noise{};
    };
    std::vector<Sum> sums(shapes);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (!noise[i]) continue;
        Sum& sum = sums[met[static_cast<std::size_t>(chosen[i])]];
        ++sum.lobes;
        sum.noise.photons += noise[i]->photons;
        sum.noise.direct += noise[i]->direct;
        sum.noise.traced += noise[i]->traced;
    }
    for (const auto& [lobes, n] : sums)
        by_photons_.push_back(lobes >= kLeastLobes && kSamplesOfPhoton * n.photons + n.direct < n.traced);
}

} // namespace keyhole
