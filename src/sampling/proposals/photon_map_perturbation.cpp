// PM, photon map: d1 and everything on its camera sub-path stay; the direction in which light comes to d1 is perturbed,
// the chain to the next non-specular vertex is traced again and joined to the vertex after it. It moves the storage
// point of the global map and nothing else (Fan, Chenney, Lai 2005, section 5.3).
#include "sampling/proposals/eye_perturbation.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

constexpr DirectionStep kNeighbourStep(1e-3, kPi / 6);

class PhotonMapPerturbation final : public Proposal<Path> {
  public:
    explicit PhotonMapPerturbation(const ProposalContext& context) : scene_(*context.scene), set_(context.set) {}

    std::string_view name() const override { return "photon_map"; }
    double suitability(const Path& x) const override { return nth_finite_from_eye(x, 2) > 0 ? 1 : 0; }

    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override {
        const int d1 = nth_finite_from_eye(x, 1);
        SubPath eye;
        for (int i = x.vertices() - 1; i >= d1; --i) eye.push_back(x.x[i]);
        const Vec3 w = kNeighbourStep.sample(leaving_direction(x, d1, -1), rng);
        return perturb_from_eye(scene_, set_, x, pieces_from_eye(x, d1), eye, {w, x.image}, kNeighbourStep, rng, why);
    }

    double transition_density(const Path& x, const Path& y) const override {
        if (!same_events(x, y)) return 0;
        const int d1 = nth_finite_from_eye(x, 1);
        const double w = kNeighbourStep.density(leaving_direction(x, d1, -1), leaving_direction(y, d1, -1));
        const double first = solid_angle_to_area(w, y.x[d1].point, y.x[d1 - 1].point);
        return eye_perturbation_density(x, y, pieces_from_eye(x, d1), first, kNeighbourStep);
    }

  private:
    const Scene& scene_;
    PathSet set_;
};

} // namespace

constinit const ProposalKind proposals::photon_map{
    .weight = {"photon_map.weight", 0.2, 0, 1, "relative frequency of photon map perturbations"},
    .make = [](const ProposalContext& context) { return only(std::make_unique<PhotonMapPerturbation>(context)); }};

} // namespace keyhole
