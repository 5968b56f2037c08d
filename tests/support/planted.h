// Proposals with a mistake in their densities, to see that the tests would notice.
#pragma once

#include "sampling/paths/path.h"
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"

#include <functional>
#include <utility>

namespace keyhole::test {

/// Which of the two densities in an acceptance is asked for.
enum class Sense { forward, reverse };

/// T(x -> y) with a mistake in it; `real` is the right one.
using Mistake = std::function<double(const Proposal<Path>& real, const Path& x, const Path& y, Sense sense)>;

/// Proposes what `real` does, and is wrong about the density.
class Planted final : public Proposal<Path> {
  public:
    Planted(PathProposal real, Mistake mistake) : real_(std::move(real)), mistake_(std::move(mistake)) {}

    std::string_view name() const override { return real_->name(); }
    double suitability(const Path& x) const override { return real_->suitability(x); }

    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override {
        auto y = real_->propose(x, rng, why);
        candidate() = y.value_or(Path{});
        return y;
    }

    double transition_density(const Path& x, const Path& y) const override {
        const bool forward = y.vertices() == candidate().vertices() && common_prefix(y, candidate()) == y.vertices();
        return mistake_(*real_, x, y, forward ? Sense::forward : Sense::reverse);
    }

  private:
    /// What this thread's chain is about to accept or reject.
    static Path& candidate() {
        static thread_local Path path;
        return path;
    }

    PathProposal real_;
    Mistake mistake_;
};

/// Half angle of the cone of make_fixed_cone() [rad].
constexpr double kConeAngle = 0.9;

/// The angle from the cone's axis to the direction in which light comes to d1 [rad].
double cone_angle(const Path& path, const Vec3& target);

/// A proposal that replaces the direction in which light comes to d1 by one in a cone about the direction to `target`,
/// angle and azimuth uniform, wherever the old one was. Its density does not cancel against the reverse one, as that of
/// a perturbation does which is symmetric in its angle.
PathProposal make_fixed_cone(const ProposalContext& context, const Vec3& target);

} // namespace keyhole::test
