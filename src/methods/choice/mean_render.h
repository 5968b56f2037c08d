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

  private:
    std::optional<RenderResult> result_;
    double weight_ = 0, most_ = 0;
    StageStats others_{.stage = &stages::others};
    std::optional<std::string> unsaved_;
};

} // namespace keyhole
