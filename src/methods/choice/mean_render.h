// The mean of several renders of one picture.
#pragma once

#include "methods/render.h"

#include <optional>
#include <string>

namespace keyhole {

/// The mean of independent renders with weights that were fixed before their samples were drawn: without bias, whatever
/// the weights follow from. What is told of it is what is to be told of the render with most weight.
class MeanRender {
  public:
    bool empty() const { return !result_; }
    /// A render without weight stands until another takes its place.
    void add(RenderResult&& result, double weight);
    const Picture& picture() const { return result_->picture; }
    /// Takes in what counts of a render whose other statistics aren't told, with a picture or without one: time that it
    /// took, and that its photons weren't kept.
    void leave_out(const RenderStats& stats);
    RenderResult take();
    /// What became of photons that any of them was to keep.
    const RenderStats& of_map() const { return of_map_; }

  private:
    std::optional<RenderResult> result_;
    double weight_ = 0, most_ = 0;
    StageStats others_{.stage = &stages::others};
    RenderStats of_map_;
};

} // namespace keyhole
