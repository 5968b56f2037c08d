// LP, lens perturbation: the image point moves a little, the same specular events are traced again, and the first
// non-specular vertex is joined to the kept rest (Veach 1997, section 11.3.1.1).
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

/// Steps in the image, in pixels: radius log-uniform between two bounds, angle uniform.
struct ImageStep {
    static constexpr double kNear = 0.1, kFar = 40;

    static Vec2 sample(Rng& rng) {
        const double r = kNear * std::pow(kFar / kNear, rng.next()), phi = 2 * kPi * rng.next();
        return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi))};
    }
    /// Per square pixel.
    static double density(const Vec2& step) {
        const double r = std::hypot(step.x, step.y);
        return r < kNear || r > kFar ? 0.0 : 1 / (2 * kPi * r * r * std::log(kFar / kNear));
    }
};

class LensPerturbation final : public Proposal<Path> {
  public:
    explicit LensPerturbation(const ProposalContext& context) : scene_(*context.scene), set_(context.set) {}

    std::string_view name() const override { return "lens_perturbation"; }
    double suitability(const Path& x) const override { return lens_subpath_start(x) > 0 ? 1 : 0; }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override;
    double transition_density(const Path& x, const Path& y) const override;

  private:
    const Scene& scene_;
    PathSet set_;
};

std::optional<Path> LensPerturbation::propose(const Path& x, Rng& rng, Failure& why) const {
    const int d1 = lens_subpath_start(x);
    const ImageWindow& window = scene_.camera().window();
    const Vec2 image = window.to_window(window.to_pixel(x.image) + ImageStep::sample(rng));
    if (!(image.x >= 0 && image.x < 1 && image.y >= 0 && image.y < 1))
        return why = Failure::outside_image, std::nullopt;

    SubPath light, eye;
    for (int i = 0; i < d1; ++i) light.push_back(x.x[static_cast<std::size_t>(i)]);
    eye.push_back(x.x.back());
    if (!retrace(scene_, eye, scene_.camera().ray_direction(eye[0].point, image), x, x.vertices() - 2, d1, why))
        return std::nullopt;
    return join(scene_, set_, light, eye, image, why);
}

double LensPerturbation::transition_density(const Path& x, const Path& y) const {
    const int d1 = lens_subpath_start(y);
    if (d1 == 0 || d1 != lens_subpath_start(x) || !same_events(x, y)) return 0;
    const ImageWindow& window = scene_.camera().window();
    const Vec2 step = window.to_pixel(y.image) - window.to_pixel(x.image);
    return ImageStep::density(step) * window.pixels() * retrace_density_from_eye(y, y.vertices() - 2, d1);
}

} // namespace

PathProposal make_lens_perturbation(const ProposalContext& context) {
    return std::make_unique<LensPerturbation>(context);
}

} // namespace keyhole
