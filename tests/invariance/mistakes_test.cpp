// The invariance test notices wrong densities: each mistake that people make, planted around the real proposals.
#include "sampling/proposals/registry.h"
#include "support/invariance.h"
#include "support/planted.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::Mistake;
using test::Sense;

const Vec3 kTarget(0, 1.2f, -1); // on the rear wall

double right(const Proposal<Path>& real, const Path& x, const Path& y, Sense /*sense*/) {
    return real.transition_density(x, y);
}

/// Leaves out that the vertices between what x and y share may come from the eye but for one. As these scenes have
/// neither specular surfaces nor a lens, every vertex can be kept or joined, except that the eye never stays alone.
double without_one_split(const Proposal<Path>& real, const Path& x, const Path& y, Sense /*sense*/) {
    const int first = common_prefix(x, y), suffix = common_suffix(x, y, first);
    const int end = suffix <= 1 ? y.vertices() : y.vertices() - suffix;
    const int most = end == y.vertices() ? end - first - 1 : end - first;
    double all = 0, one = 0;
    for (int s = 0; s <= most; ++s) {
        double density = 1;
        for (int i = first; i < end; ++i) {
            const Vertex& v = y.x[static_cast<std::size_t>(i)];
            density *= i < first + s ? v.pdf_from_light : v.pdf_from_eye;
        }
        all += density;
        if (s == 1) one = density;
    }
    return real.transition_density(x, y) * (1 - one / all);
}

double without_sine(const Proposal<Path>& real, const Path& x, const Path& y, Sense /*sense*/) {
    return real.transition_density(x, y) * std::sin(test::cone_angle(y, kTarget));
}

/// A cone of twice the angle has half the density where the angle is uniform.
double twice_the_cone_in_reverse(const Proposal<Path>& real, const Path& x, const Path& y, Sense sense) {
    return real.transition_density(x, y) * (sense == Sense::reverse ? 0.5 : 1.0);
}

double swapped(const Proposal<Path>& real, const Path& x, const Path& y, Sense /*sense*/) {
    return real.transition_density(y, x);
}

/// The proposal of a kind that has one.
template <const ProposalKind& kind> PathProposal only_of(const ProposalContext& context) {
    return std::move(kind.make(context).front().proposal);
}

PathProposal fixed_cone(const ProposalContext& context) { return test::make_fixed_cone(context, kTarget); }

struct MistakeCase {
    const char* name;
    PathProposal (*kind)(const ProposalContext&);
    double (*mistake)(const Proposal<Path>&, const Path&, const Path&, Sense);
    bool noticed;
};

class Invariance_NoticesAMistake : public testing::TestWithParam<MistakeCase> {
  protected:
    test::Invariance measure(const Mixture<Path>& mixture) const {
        return test::measure_invariance(*scene_, mixture, PathSet::stored, 120'000, 17);
    }
    static void judge(const test::Invariance& result, bool noticed) {
        EXPECT_GT(result.ledger.at(0).accepted, 500u);
        RecordProperty("worst", std::to_string(result.worst()));
        if (noticed) {
            EXPECT_GT(result.worst(), test::Invariance::bound()) << result.report();
        } else {
            EXPECT_LE(result.worst(), test::Invariance::bound()) << result.report();
        }
    }

    std::unique_ptr<Scene> scene_ = test::diffuse_box();
    ProposalContext context_{scene_.get(), PathSet::stored, 8};
};

TEST_P(Invariance_NoticesAMistake, InADensity) {
    Mixture<Path> mixture;
    mixture.add(std::make_unique<test::Planted>(GetParam().kind(context_), GetParam().mistake), 1);
    judge(measure(mixture), GetParam().noticed);
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, Invariance_NoticesAMistake,
    testing::Values(MistakeCase{"NoneInBidirectional", only_of<proposals::bidirectional>, right, false},
                    MistakeCase{"NoneInFixedCone", fixed_cone, right, false},
                    MistakeCase{"SineLeftOut", fixed_cone, without_sine, true},
                    MistakeCase{"SplitLeftOut", only_of<proposals::bidirectional>, without_one_split, true},
                    MistakeCase{"TwiceTheConeInReverse", fixed_cone, twice_the_cone_in_reverse, true},
                    MistakeCase{"SwappedInBidirectional", only_of<proposals::bidirectional>, swapped, true},
                    MistakeCase{"SwappedInLensSubpath", only_of<proposals::lens_subpath>, swapped, true},
                    MistakeCase{"SwappedInPhotonMap", only_of<proposals::photon_map>, swapped, true}),
    [](const auto& info) { return std::string(info.param.name); });

/// Moves paths with three scattering vertices only, the fewest in this set.
class ShortPathsOnly final : public Proposal<Path> {
  public:
    explicit ShortPathsOnly(PathProposal real) : real_(std::move(real)) {}
    std::string_view name() const override { return real_->name(); }
    double suitability(const Path& x) const override { return x.scatterings() == 3 ? 1 : 0; }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override {
        return real_->propose(x, rng, why);
    }
    double transition_density(const Path& x, const Path& y) const override { return real_->transition_density(x, y); }

  private:
    PathProposal real_;
};

/// Bidirectional proposals beside a kind that does not suit every path, so that how often they are chosen depends on
/// the path; `forgets`: the reverse takes over the probability of the forward choice.
Mixture<Path> uneven_mixture(const ProposalContext& context, bool forgets) {
    constexpr double weight = 4;
    Mixture<Path> mixture;
    const auto choice = [](const Path& x) { return 1 / (1 + (x.scatterings() == 3 ? weight : 0.0)); };
    mixture.add(std::make_unique<test::Planted>(
                    only_of<proposals::bidirectional>(context),
                    [=](const Proposal<Path>& real, const Path& x, const Path& y, Sense sense) {
                        const double density = real.transition_density(x, y);
                        return forgets && sense == Sense::reverse ? density * choice(y) / choice(x) : density;
                    }),
                1);
    mixture.add(std::make_unique<ShortPathsOnly>(only_of<proposals::lens_perturbation>(context)), weight);
    return mixture;
}

class Invariance_NoticesAForgottenChoice : public Invariance_NoticesAMistake {};

TEST_P(Invariance_NoticesAForgottenChoice, InTheReverse) {
    judge(measure(uneven_mixture(context_, GetParam().noticed)), GetParam().noticed);
}

INSTANTIATE_TEST_SUITE_P(Mistakes, Invariance_NoticesAForgottenChoice,
                         testing::Values(MistakeCase{"None", nullptr, nullptr, false},
                                         MistakeCase{"SuitabilityInReverse", nullptr, nullptr, true}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace keyhole
