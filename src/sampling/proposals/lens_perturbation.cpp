// LP, lens perturbation: the image point moves a little, the same specular events are traced again, and the first
// non-specular vertex is joined to the kept rest (Veach 1997, section 11.3.1.1).
//
// MC, multi-chain perturbation: the same where that vertex can't be joined, because light comes to it through specular
// vertices: these are traced again as well, from a perturbed direction, until a connection is possible or the light is
// hit (Veach 1997, section 11.3.2). It moves caustics, and caustics seen in mirrors.
#include "sampling/proposals/eye_perturbation.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

constexpr ImageStep kImageStep(0.1, 40);
constexpr DirectionStep kDirectionStep(1e-4, 0.1);

enum class Chains { one, many };

class EyePerturbation final : public Proposal<Path> {
  public:
    EyePerturbation(const ProposalContext& context, Chains chains)
        : scene_(*context.scene), set_(context.set), chains_(chains) {}

    std::string_view name() const override {
        return chains_ == Chains::one ? "lens_perturbation" : "multi_chain_perturbation";
    }
    double suitability(const Path& x) const override {
        const int d1 = nth_finite_from_eye(x, 1);
        const bool joinable_at_d1 = d1 > 0 && !x.x[d1 - 1].specular();
        return d1 > 0 && joinable_at_d1 == (chains_ == Chains::one) ? 1 : 0;
    }

    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override {
        const ImageWindow& window = scene_.camera().window();
        const Vec2 image = window.to_window(window.to_pixel(x.image) + kImageStep.sample(rng));
        if (!(image.x >= 0 && image.x < 1 && image.y >= 0 && image.y < 1))
            return why = Failure::outside_image, std::nullopt;
        SubPath eye;
        eye.push_back(x.x.back());
        const Vec3 w = scene_.camera().ray_direction(eye[0].point, image);
        return perturb_from_eye(scene_, set_, x, pieces_from_eye(x, x.vertices() - 1), eye, {w, image}, kDirectionStep,
                                rng, why);
    }

    double transition_density(const Path& x, const Path& y) const override {
        if (!same_events(x, y) || suitability(y) == 0) return 0;
        const ImageWindow& window = scene_.camera().window();
        const double image = kImageStep.density(window.to_pixel(y.image) - window.to_pixel(x.image)) * window.pixels();
        const double first = image * y.x[y.x.size() - 2].pdf_from_eye; // that of a uniform image point
        return eye_perturbation_density(x, y, pieces_from_eye(x, x.vertices() - 1), first, kDirectionStep);
    }

  private:
    const Scene& scene_;
    PathSet set_;
    Chains chains_;
};

} // namespace

constinit const ProposalKind proposals::lens_perturbation{
    .weight = {"lens_perturbation.weight", 0.4, 0, 1, "relative frequency of lens perturbations"},
    .make = [](const ProposalContext& context) {
        return only(std::make_unique<EyePerturbation>(context, Chains::one));
    }};

constinit const ProposalKind proposals::multi_chain_perturbation{
    .weight = {"multi_chain_perturbation.weight", 0.2, 0, 1, "relative frequency of multi-chain perturbations"},
    .needs_specular = true,
    .make = [](const ProposalContext& context) {
        return only(std::make_unique<EyePerturbation>(context, Chains::many));
    }};

} // namespace keyhole
