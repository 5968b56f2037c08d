// CP, caustic perturbation: at a vertex before a specular chain the direction of light is perturbed, the chain is
// traced again, and the non-specular vertex where it ends is joined to the next one towards the eye. If that is the
// eye, the image point moves (Veach 1997, section 11.3.1.2); if it is another surface, a caustic that lights it moves.
//
// An infinite emitter's direction is its vertex, which stays: there the ray moves across its beam instead.
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"
#include "sampling/proposals/steps.h"

#include <algorithm>

namespace keyhole {
namespace {

constexpr DirectionStep kStep(1e-4, 0.2);
constexpr BeamStep kBeamStep(1e-5, 0.1);

class CausticPerturbation final : public Proposal<Path> {
  public:
    explicit CausticPerturbation(const ProposalContext& context) : scene_(*context.scene), set_(context.set) {}

    std::string_view name() const override { return "caustic_perturbation"; }
    double suitability(const Path& x) const override { return chains(x).empty() ? 0 : 1; }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override;
    double transition_density(const Path& x, const Path& y) const override;

  private:
    /// Vertices a with a specular chain after them that ends in a vertex whose next neighbour is not specular.
    using Starts = InlineVector<int, kMaxScatterings + 2>;
    static Starts chains(const Path& x) {
        Starts starts;
        for (int a = 0; a + 3 < x.vertices(); ++a) {
            if (x.x[a].specular() || !x.x[a + 1].specular()) continue;
            const int b = next_finite(x, a, +1);
            if (b + 1 < x.vertices() && !x.x[b + 1].specular()) starts.push_back(a);
        }
        return starts;
    }

    /// A perturbed ray from x[a].
    struct Ray {
        SurfacePoint origin;
        Vec3 w;
    };
    Ray perturbed_ray(const Path& x, int a, Rng& rng) const;
    /// Density with which y[a+1] is met by it.
    double ray_density(const Path& x, const Path& y, int a) const;

    const Scene& scene_;
    PathSet set_;
};

CausticPerturbation::Ray CausticPerturbation::perturbed_ray(const Path& x, int a, Rng& rng) const {
    const SurfacePoint& start = x.x[a].point;
    const Vec3 w = leaving_direction(x, a, +1);
    if (start.site != Site::infinite) return {start, kStep.sample(w, rng)};
    const float radius = scene_.bounding_sphere().radius;
    Ray ray{{}, w};
    ray.origin.site = Site::point;
    ray.origin.p = x.x[a + 1].point.p - w * (2 * radius) + kBeamStep.sample(w, radius, rng);
    return ray;
}

double CausticPerturbation::ray_density(const Path& x, const Path& y, int a) const {
    const SurfacePoint &start = y.x[a].point, &to = y.x[a + 1].point;
    const Vec3 w = leaving_direction(x, a, +1);
    const double density = start.site == Site::infinite
                               ? kBeamStep.density(to.p - x.x[a + 1].point.p, w, scene_.bounding_sphere().radius)
                               : kStep.density(w, leaving_direction(y, a, +1));
    return solid_angle_to_area(density, start, to);
}

std::optional<Path> CausticPerturbation::propose(const Path& x, Rng& rng, Failure& why) const {
    const Starts starts = chains(x);
    const int a = starts[rng.below(static_cast<std::uint32_t>(starts.size()))], b = next_finite(x, a, +1);
    SubPath light, eye;
    for (int i = 0; i <= a; ++i) light.push_back(x.x[i]);
    const Ray ray = perturbed_ray(x, a, rng);
    if (!retrace_specular_chain(scene_, light, ray.origin, ray.w, x, a + 1, b, why)) return std::nullopt;
    for (int i = x.vertices() - 1; i > b; --i) eye.push_back(x.x[i]);
    return join(scene_, set_, light, eye, x.image, why);
}

double CausticPerturbation::transition_density(const Path& x, const Path& y) const {
    if (!same_events(x, y)) return 0;
    // The start of the chain that was traced again is the last vertex that both share from the light on.
    const Starts starts = chains(x);
    const int a = common_prefix(x, y) - 1;
    if (std::find(starts.begin(), starts.end(), a) == starts.end()) return 0;
    return specular_chain_density(y, ray_density(x, y, a), a + 1, next_finite(y, a, +1)) /
           static_cast<double>(starts.size());
}

} // namespace

constinit const ProposalKind proposals::caustic_perturbation{
    .weight = {"caustic_perturbation.weight", 0.2, 0, 1, "relative frequency of caustic perturbations"},
    .needs_specular = true,
    .make = [](const ProposalContext& context) { return only(std::make_unique<CausticPerturbation>(context)); }};

} // namespace keyhole
