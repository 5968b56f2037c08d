#include "support/planted.h"

#include "sampling/proposals/eye_perturbation.h"

namespace keyhole::test {
namespace {

constexpr DirectionStep kLaterSteps(1e-3, 0.3);

class FixedCone final : public Proposal<Path> {
  public:
    FixedCone(const ProposalContext& context, const Vec3& target)
        : scene_(*context.scene), set_(context.set), target_(target) {}

    std::string_view name() const override { return "fixed_cone"; }
    double suitability(const Path& x) const override {
        return nth_finite_from_eye(x, 2) > 0 && cone_angle(x, target_) < kConeAngle ? 1 : 0;
    }

    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override {
        const int d1 = nth_finite_from_eye(x, 1);
        SubPath eye;
        for (int i = x.vertices() - 1; i >= d1; --i) eye.push_back(x.x[static_cast<std::size_t>(i)]);
        const double theta = kConeAngle * rng.next(), phi = 2 * kPi * rng.next();
        const Vec3 local(static_cast<float>(std::sin(theta) * std::cos(phi)),
                         static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta)));
        const Vec3 w = Frame((target_ - eye.back().point.p).normalized()).to_world(local).normalized();
        return perturb_from_eye(scene_, set_, x, pieces_from_eye(x, d1), eye, {w, x.image}, kLaterSteps, rng, why);
    }

    double transition_density(const Path& x, const Path& y) const override {
        const double theta = cone_angle(y, target_);
        if (!same_events(x, y) || theta >= kConeAngle) return 0;
        const int d1 = nth_finite_from_eye(x, 1);
        const auto i = static_cast<std::size_t>(d1);
        const double w = 1 / (2 * kPi * kConeAngle * std::sin(theta));
        const double first = solid_angle_to_area(w, y.x[i].point, y.x[i - 1].point);
        return eye_perturbation_density(x, y, pieces_from_eye(x, d1), first, kLaterSteps);
    }

  private:
    const Scene& scene_;
    PathSet set_;
    Vec3 target_;
};

} // namespace

double cone_angle(const Path& path, const Vec3& target) {
    const int d1 = nth_finite_from_eye(path, 1);
    const Vec3 axis = (target - path.x[static_cast<std::size_t>(d1)].point.p).normalized();
    return std::acos(std::clamp(static_cast<double>(axis.dot(leaving_direction(path, d1, -1))), -1.0, 1.0));
}

PathProposal make_fixed_cone(const ProposalContext& context, const Vec3& target) {
    return std::make_unique<FixedCone>(context, target);
}

} // namespace keyhole::test
