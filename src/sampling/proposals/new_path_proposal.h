// Proposals of whole new paths, whatever the present one is.
#pragma once

#include "sampling/proposals/edit.h"

#include <utility>

namespace keyhole {

/// Proposes what `Paths` draws:
///   std::optional<Path> draw(Rng&, Failure& why) const: a path, evaluated; none where it can't be made;
///   double draw_density(const Path&) const: with which draw() makes a measured path, in the convention of measure.h.
template <class Paths> class NewPathProposal final : public Proposal<Path> {
  public:
    NewPathProposal(std::string_view name, const Scene& scene, Paths paths)
        : name_(name), scene_(scene), paths_(std::move(paths)) {}

    std::string_view name() const override { return name_; }
    double suitability(const Path& /*x*/) const override { return 1; }

    std::optional<Path> propose(const Path& /*x*/, Rng& rng, Failure& why) const override {
        auto y = paths_.draw(rng, why);
        // What rounding carried elsewhere can't be proposed, if it can't be found again.
        if (y && y->target > 0 && !(paths_.draw_density(*y) > 0)) return why = Failure::signature, std::nullopt;
        return y;
    }
    double transition_density(const Path& x, const Path& y) const override {
        return is_all_new(scene_, x, y) ? paths_.draw_density(y) : 0.0;
    }

  private:
    std::string_view name_;
    const Scene& scene_;
    Paths paths_;
};

} // namespace keyhole
