// A new kind of proposal, for the test of what it takes to add one: whole lens sub-paths, by another name.
#include "sampling/proposals/registry.h"

namespace keyhole {
namespace {

class Extension final : public Proposal<Path> {
  public:
    explicit Extension(PathProposal real) : real_(std::move(real)) {}
    std::string_view name() const override { return "extension"; }
    double suitability(const Path& x) const override { return real_->suitability(x); }
    std::optional<Path> propose(const Path& x, Rng& rng, Failure& why) const override {
        return real_->propose(x, rng, why);
    }
    double transition_density(const Path& x, const Path& y) const override { return real_->transition_density(x, y); }

  private:
    PathProposal real_;
};

ProposalList make(const ProposalContext& context) {
    ProposalList real = proposals::lens_subpath.make(context);
    return only(std::make_unique<Extension>(std::move(real.front().proposal)));
}

} // namespace

constinit const ProposalKind proposals::extension{
    .weight = {"extension.weight", 0.1, 0, 1, "relative frequency of the proposals of a test"}, .make = make};

} // namespace keyhole
