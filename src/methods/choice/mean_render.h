// The mean of several renders of one picture.
#pragma once

#include "methods/render.h"

#include <optional>

namespace keyhole {

/// The mean of independent renders with weights that were fixed before their samples were drawn: without bias, whatever
/// the weights follow from. What is told of it is what is to be told of the render with most weight.
class MeanRender {
  public:
    bool empty() const { return !result_; }
    /// A render without weight stands until another takes its place.
    void add(RenderResult&& result, double weight);
    const Picture& picture() const { return result_->picture; }
    /// A render that gave no picture took time, too.
    void add_time_of(const RenderStats& stats);
    RenderResult take();

  private:
    std::optional<RenderResult> result_;
    double weight_ = 0, most_ = 0;
    StageStats others_{.stage = &stages::others};
};

} // namespace keyhole
